#include "rhi_cpu/ray_tracing_pipeline.hpp"

#include <algorithm>

#include "rhi/shader_table.hpp"

namespace tandem::cpu {

RayTracingPipeline::RayTracingPipeline(DeviceStateHandle device, const rhi::RayTracingPipelineDesc& desc)
    : rhi::RayTracingPipeline(desc), device_(std::move(device)), shaders_(rhi::shaders_of(desc)) {
  kernels_.resize(shaders_.size());
  // The system's compiler takes half a second for each.
  device_->workers.for_each_range(shaders_.size(), [&](std::uint64_t first, std::uint64_t end) {
    for (std::uint64_t i = first; i < end; ++i)
      kernels_[i] = device_->kernels.kernel(*shaders_[i], desc.specialization, desc.label);
  });
}

std::uint32_t RayTracingPipeline::position_of(const rhi::ShaderModuleHandle& shader) const {
  if (shader == nullptr) return rhi::no_shader;
  return static_cast<std::uint32_t>(std::find(shaders_.begin(), shaders_.end(), shader) - shaders_.begin());
}

}  // namespace tandem::cpu
