#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "rhi_cpu/bind_group.hpp"
#include "rhi_cpu/device_state.hpp"
#include "rhi_cpu/kernel/shader_call.hpp"
#include "rhi_cpu/launch_failures.hpp"
#include "rhi_cpu/shader_table.hpp"

namespace tandem::cpu {

/// A shader of the pipeline with its resources.
struct BoundShader {
  void (*call)(kernel::ShaderCall& call) = nullptr;
  const kernel::Resource* resources = nullptr;
  std::uint32_t payload_size = 0;
};

/// Where the table's records of a trace_rays begin; see rhi::TraceRaysDesc.
struct FirstRecords {
  std::uint32_t ray_generation = 0;
  std::uint32_t miss = 0;
  std::uint32_t hit = 0;
  std::uint32_t callable = 0;
};

/// One trace_rays, as all its invocations share it.
struct RayLaunch {
  const ShaderTable& table;
  std::span<const BoundShader> shaders;  ///< by their position in the pipeline
  FirstRecords first;
  std::uint32_t max_recursion_depth = 0;
  LaunchFailures& failures;
  const kernel::Watch* watch = nullptr;
};

/// Runs the ray generation shader for every invocation of `size`. Throws Error for a top level that is not built, and
/// for what LaunchFailures collects.
void trace_rays(const ShaderTable& table, const FirstRecords& first, std::span<const std::shared_ptr<BindGroup>> groups,
                std::span<const std::byte> push_constants, const std::array<std::uint32_t, 3>& size,
                DeviceState& device);

}  // namespace tandem::cpu
