#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>

#include "conformance/kit/check.hpp"
#include "conformance/kit/shader_run.hpp"

/// Compute shaders whose workgroups answer each for itself.
namespace tandem::conformance {

/// A kernel around a body of GLSL, which may use `group`, the workgroup's number; `i`, gl_LocalInvocationIndex; and
/// `first`, from where on answers[] is the workgroup's.
struct WorkgroupKernel {
  std::string label;
  std::string extensions = {};
  std::string declarations = {};
  std::string body;
  std::array<std::uint32_t, 3> local_size = {64, 1, 1};
  std::array<std::uint32_t, 3> workgroup_count = {2, 1, 1};
  std::uint32_t answers = 0;  ///< of a workgroup; 0: one of each invocation
  std::uint32_t bytes = 4;    ///< of shared memory, where that may be more than the 16384 that every device has
  ComputeOptions options = {};
};

/// Runs it and throws Failure, naming the first answer that is another; Unsupported where the device has not so much
/// shared memory.
void check_workgroups(Context& context, const WorkgroupKernel& kernel,
                      const std::function<std::uint32_t(std::uint32_t group, std::uint32_t index)>& expected);

/// Throws Unsupported where the device has less shared memory.
void require_workgroup_memory(Context& context, std::uint32_t bytes);

}  // namespace tandem::conformance
