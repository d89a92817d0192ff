#pragma once

#include <atomic>
#include <cstdint>
#include <span>

#include "rhi/shader_table.hpp"

namespace tandem::cpu {

/// Mistakes that only a running shader can make, and that Vulkan leaves undefined.
enum class LaunchFailure : std::uint32_t {
  miss_record,      ///< a record that the table does not have
  hit_record,       ///< likewise
  callable_record,  ///< likewise
  payload,          ///< smaller than that of the shader it was given to
  recursion,        ///< more rays in flight than the pipeline allows
  callable_depth    ///< more callable shaders in flight than rhi::max_callable_depth
};

/// Collects what goes wrong in one trace_rays: shaders must not throw, for Embree's frames may lie between.
/// Thread-safe, and the failure that is reported does not depend on the order in which invocations run.
class LaunchFailures {
 public:
  /// @param value the record's index; of `payload`, the shader's position in the pipeline
  void note(LaunchFailure failure, std::uint32_t value) noexcept {
    const std::uint64_t code = std::uint64_t{static_cast<std::uint32_t>(failure)} << 32 | value;
    std::uint64_t lowest = lowest_.load(std::memory_order_relaxed);
    while (code < lowest && !lowest_.compare_exchange_weak(lowest, code, std::memory_order_relaxed)) {
    }
  }

  /// Throws Error(invalid_argument) in the name of the pipeline when something was noted.
  /// @param shaders of the pipeline, by their position
  void check(const rhi::ShaderTable& table, std::span<const rhi::ShaderModuleHandle> shaders) const;

 private:
  static constexpr std::uint64_t none = ~std::uint64_t{0};
  std::atomic<std::uint64_t> lowest_ = none;
};

}  // namespace tandem::cpu
