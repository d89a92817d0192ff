#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "conformance/kit/check.hpp"
#include "conformance/kit/shader_run.hpp"

/// Compute shaders that report where in which subgroup each invocation runs, and what it computed there. Which
/// invocation has which place is the device's business: what is expected follows from the places that it reports.
namespace tandem::conformance {

/// A kernel around a body of GLSL, which answers with `answers[at + k] = ...` for k below `columns`, and may use `i`, a
/// number that each invocation of the launch has for itself.
struct SubgroupKernel {
  std::string label;
  std::vector<std::string> extensions = {};  ///< of GLSL, beside GL_KHR_shader_subgroup_basic
  std::string declarations = {};             ///< functions and constants that the body uses
  std::string body;
  std::uint32_t columns = 1;
  std::string main_attributes = {};  ///< of main(), such as [[subgroup_uniform_control_flow]]
  std::array<std::uint32_t, 3> local_size = {100, 1, 1};
  std::array<std::uint32_t, 3> workgroup_count = {2, 1, 1};
  ComputeOptions options = {};
};

struct Invocation {
  std::uint32_t index = 0;     ///< `i`
  std::uint32_t subgroup = 0;  ///< gl_SubgroupID
  std::uint32_t lane = 0;      ///< gl_SubgroupInvocationID
  std::span<const std::uint32_t> answers;
};

struct Subgroup {
  std::uint32_t size = 0;                ///< gl_SubgroupSize
  std::uint32_t workgroup = 0;           ///< the workgroup's number in the launch
  std::uint32_t id = 0;                  ///< gl_SubgroupID
  std::uint32_t count = 0;               ///< gl_NumSubgroups
  std::vector<const Invocation*> lanes;  ///< by gl_SubgroupInvocationID; null where there is no invocation
};

/// What a launch of a kernel answered. It may be moved, not copied: subgroups point to invocations.
struct SubgroupAnswers {
  Words words;
  std::vector<Invocation> invocations;  ///< by index
  std::vector<Subgroup> subgroups;

  SubgroupAnswers() = default;
  SubgroupAnswers(SubgroupAnswers&&) = default;
  SubgroupAnswers(const SubgroupAnswers&) = delete;
  SubgroupAnswers& operator=(SubgroupAnswers&&) = delete;
  SubgroupAnswers& operator=(const SubgroupAnswers&) = delete;
};

/// Runs the kernel. Throws Failure unless the places are such as Vulkan allows: each invocation has one of its own, and
/// the invocations of a workgroup agree about the number of their subgroups, those of a subgroup about its size.
SubgroupAnswers run_subgroups(Context& context, const SubgroupKernel& kernel);

/// The value that a column holds from `first` on, in as many words as put_function() of the type writes. A float16_t is
/// written as a float.
template <typename T>
T value_at(const Invocation& invocation, std::uint32_t first) {
  if constexpr (sizeof(T) == 8)
    return std::bit_cast<T>(std::uint64_t{invocation.answers[first + 1]} << 32 | invocation.answers[first]);
  else if constexpr (sizeof(T) == 4)
    return std::bit_cast<T>(invocation.answers[first]);
  else
    return static_cast<T>(invocation.answers[first]);
}

/// A GLSL function `void put(uint at, TYPE x)` that writes an answer, and its words: bool, integers and floats of 16 to
/// 64 bits.
std::string put_function(const std::string& type);
std::uint32_t words_of(const std::string& type);

/// What an invocation in this lane must answer; nothing where any answer will do.
template <typename T>
using ExpectedValue = std::function<std::optional<T>(const Subgroup& subgroup, std::uint32_t lane)>;

/// Throws Failure, naming the first invocation whose value from column `first` on is another.
template <typename T>
void check_values(const SubgroupAnswers& seen, std::uint32_t first, std::string_view what,
                  const ExpectedValue<T>& expected) {
  for (const Subgroup& subgroup : seen.subgroups)
    for (std::uint32_t lane = 0; lane < subgroup.lanes.size(); ++lane) {
      if (subgroup.lanes[lane] == nullptr) continue;
      const std::optional<T> wanted = expected(subgroup, lane);
      const T value = value_at<T>(*subgroup.lanes[lane], first);
      if (wanted && !(value == *wanted))
        throw Failure(fmt::format("{} in lane {} of subgroup {} of workgroup {} ({} lanes) is {}, expected {}", what,
                                  lane, subgroup.id, subgroup.workgroup, subgroup.size, value, *wanted));
    }
}

/// The lanes that have invocations, ascending.
std::vector<std::uint32_t> lanes_of(const Subgroup& subgroup);

/// Throws Unsupported unless a workgroup of the device may have this size.
void require_local_size(Context& context, const std::array<std::uint32_t, 3>& size);

}  // namespace tandem::conformance
