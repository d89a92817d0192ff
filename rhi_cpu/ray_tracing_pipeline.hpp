#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "rhi/ray_tracing_pipeline.hpp"
#include "rhi_cpu/cache/kernel_store.hpp"
#include "rhi_cpu/device_state.hpp"

namespace tandem::cpu {

/// The kernels of ray tracing shaders, loaded.
class RayTracingPipeline final : public rhi::RayTracingPipeline {
 public:
  /// Throws what KernelStore::kernel does.
  RayTracingPipeline(DeviceStateHandle device, const rhi::RayTracingPipelineDesc& desc);

  const DeviceState& device() const noexcept { return *device_; }
  /// Every module of the pipeline, once.
  std::span<const rhi::ShaderModuleHandle> shaders() const noexcept { return shaders_; }
  /// Of each of shaders().
  std::span<const Kernel> kernels() const noexcept { return kernels_; }
  /// The position of a module in shaders(); rhi::no_shader when it is null.
  std::uint32_t position_of(const rhi::ShaderModuleHandle& shader) const;

 private:
  DeviceStateHandle device_;
  std::vector<rhi::ShaderModuleHandle> shaders_;
  std::vector<Kernel> kernels_;
};

}  // namespace tandem::cpu
