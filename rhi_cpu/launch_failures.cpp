#include "rhi_cpu/launch_failures.hpp"

#include <string>

#include <fmt/format.h>

#include "rhi/error.hpp"

namespace tandem::cpu {
namespace {

std::string sentence(LaunchFailure failure, std::uint32_t value, const rhi::ShaderTable& table,
                     std::span<const rhi::ShaderModuleHandle> shaders) {
  const auto beyond = [&](const char* kind, const rhi::ShaderRecords& records) {
    return fmt::format("a ray asks for {} record {} of the trace, beyond the {} of the shader table '{}'", kind, value,
                       records.records.size(), table.label());
  };
  switch (failure) {
    case LaunchFailure::miss_record:
      return beyond("miss", table.desc().miss);
    case LaunchFailure::hit_record:
      return beyond("hit", table.desc().hit);
    case LaunchFailure::callable_record:
      return fmt::format("a shader calls callable record {} of the trace, beyond the {} of the shader table '{}'",
                         value, table.desc().callable.records.size(), table.label());
    case LaunchFailure::payload:
      return fmt::format("the shader '{}' was called with a payload or callable data smaller than its own",
                         shaders[value]->label());
    case LaunchFailure::recursion:
      return fmt::format("more rays are in flight than the pipeline's max_recursion_depth of {}",
                         table.desc().pipeline->desc().max_recursion_depth);
    case LaunchFailure::callable_depth:
      return fmt::format("callable shaders call each other more than {} deep", rhi::max_callable_depth);
  }
  return "unknown failure";
}

}  // namespace

void LaunchFailures::check(const rhi::ShaderTable& table, std::span<const rhi::ShaderModuleHandle> shaders) const {
  const std::uint64_t code = lowest_.load(std::memory_order_relaxed);
  if (code == none) return;
  throw rhi::Error(rhi::ErrorCode::invalid_argument, table.desc().pipeline->label(),
                   sentence(static_cast<LaunchFailure>(code >> 32), static_cast<std::uint32_t>(code), table, shaders));
}

}  // namespace tandem::cpu
