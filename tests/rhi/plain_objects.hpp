#pragma once

#include <cstdint>
#include <string>

#include "rhi/device.hpp"

/// Objects of the rhi that belong to no device: what reflection and the rules say of them needs none.
namespace tandem::test {

/// GLSL without its #version and extension lines, with every ray tracing extension enabled.
rhi::ShaderModuleHandle plain_shader(rhi::ShaderStage stage, const std::string& glsl);
rhi::BufferHandle plain_buffer(std::uint64_t size, rhi::BufferUsage usage);
rhi::SamplerHandle plain_sampler(const rhi::SamplerDesc& desc);
rhi::TextureHandle plain_texture(const rhi::TextureDesc& desc);
rhi::AccelerationStructureHandle plain_structure(rhi::AccelerationStructure::Level level);
rhi::RayTracingPipelineHandle plain_pipeline(const rhi::RayTracingPipelineDesc& desc);
rhi::ShaderTableHandle plain_table(const rhi::ShaderTableDesc& desc);
rhi::BindGroupHandle plain_bind_group(const rhi::BindGroupDesc& desc);

/// A device that can do everything, with limits as small as Vulkan lets them be.
rhi::DeviceInfo able_device();

}  // namespace tandem::test
