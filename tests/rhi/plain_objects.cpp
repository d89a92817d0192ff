#include "tests/rhi/plain_objects.hpp"

#include <memory>

#include "rhi/glsl/compile.hpp"

namespace tandem::test {
namespace {

const std::string preamble = R"(#version 460
#extension GL_EXT_ray_tracing : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_shader_image_load_formatted : require
#extension GL_EXT_nonuniform_qualifier : require
)";

class PlainShader final : public rhi::ShaderModule {
 public:
  explicit PlainShader(const rhi::ShaderModuleDesc& desc) : ShaderModule(desc) {}
};

class PlainBuffer final : public rhi::Buffer {
 public:
  explicit PlainBuffer(const rhi::BufferDesc& desc) : Buffer(desc) {}
  std::uint64_t device_address() const override { return 256; }
};

class PlainTexture final : public rhi::Texture {
 public:
  explicit PlainTexture(const rhi::TextureDesc& desc) : Texture(desc) {}
};

class PlainSampler final : public rhi::Sampler {
 public:
  explicit PlainSampler(const rhi::SamplerDesc& desc) : Sampler(desc) {}
};

class PlainStructure final : public rhi::AccelerationStructure {
 public:
  explicit PlainStructure(Level level) : AccelerationStructure(level, "plain structure") {}
  std::uint64_t device_address() const override { return 256; }
  rhi::AccelerationStructureSizes sizes() const override { return {}; }
};

class PlainPipeline final : public rhi::RayTracingPipeline {
 public:
  explicit PlainPipeline(const rhi::RayTracingPipelineDesc& desc) : RayTracingPipeline(desc) {}
};

class PlainTable final : public rhi::ShaderTable {
 public:
  explicit PlainTable(const rhi::ShaderTableDesc& desc) : ShaderTable(desc) {}
};

class PlainBindGroup final : public rhi::BindGroup {
 public:
  explicit PlainBindGroup(const rhi::BindGroupDesc& desc) : BindGroup(desc) {}
};

}  // namespace

rhi::ShaderModuleHandle plain_shader(rhi::ShaderStage stage, const std::string& glsl) {
  const std::vector<std::uint32_t> spirv = glsl::compile(preamble + glsl, stage, "plain shader");
  return std::make_shared<PlainShader>(rhi::ShaderModuleDesc{.spirv = spirv, .label = "plain shader"});
}

rhi::BufferHandle plain_buffer(std::uint64_t size, rhi::BufferUsage usage) {
  return std::make_shared<PlainBuffer>(rhi::BufferDesc{.size = size, .usage = usage, .label = "plain buffer"});
}

rhi::TextureHandle plain_texture(const rhi::TextureDesc& desc) { return std::make_shared<PlainTexture>(desc); }

rhi::SamplerHandle plain_sampler(const rhi::SamplerDesc& desc) { return std::make_shared<PlainSampler>(desc); }

rhi::AccelerationStructureHandle plain_structure(rhi::AccelerationStructure::Level level) {
  return std::make_shared<PlainStructure>(level);
}

rhi::RayTracingPipelineHandle plain_pipeline(const rhi::RayTracingPipelineDesc& desc) {
  return std::make_shared<PlainPipeline>(desc);
}

rhi::ShaderTableHandle plain_table(const rhi::ShaderTableDesc& desc) { return std::make_shared<PlainTable>(desc); }

rhi::BindGroupHandle plain_bind_group(const rhi::BindGroupDesc& desc) { return std::make_shared<PlainBindGroup>(desc); }

rhi::DeviceInfo able_device() {
  rhi::DeviceInfo device = {.name = "able",
                            .backend = "none",
                            .description = "",
                            .driver = "",
                            .api = "",
                            .capabilities = {.ray_query = true,
                                             .ray_tracing_pipeline = true,
                                             .position_fetch = true,
                                             .trace_rays_indirect = true,
                                             .primitive_culling = true,
                                             .null_acceleration_structure = true,
                                             .buffer_references = true,
                                             .non_uniform_indexing = true,
                                             .unsized_arrays = true,
                                             .partially_bound = true,
                                             .scalar_block_layout = true,
                                             .shader_int64 = true,
                                             .shader_float64 = true,
                                             .timestamps = true,
                                             .required_subgroup_size = true,
                                             .full_subgroups = true},
                            .limits = {.workgroup_memory_size = 16384,
                                       .subgroup_size = 16,
                                       .min_subgroup_size = 8,
                                       .max_subgroup_size = 32,
                                       .max_workgroup_subgroups = 4,
                                       .max_geometry_count = 16,
                                       .max_primitive_count = 100,
                                       .max_instance_count = 10,
                                       .max_ray_recursion_depth = 1,
                                       .max_ray_invocations = 1u << 30,
                                       .shader_record_alignment = 32,
                                       .max_shader_record_stride = 4096,
                                       .shader_handle_size = 32,
                                       .max_hit_attribute_size = 32,
                                       .max_texture_size = {4096, 4096, 256, 4096, 4096, 4096, 4096},
                                       .max_texture_layers = 256}};
  const rhi::FormatSupport all = {.storage = true,
                                  .storage_atomic = true,
                                  .sampled = true,
                                  .filtered = true,
                                  .uniform_texel_buffer = true,
                                  .storage_texel_buffer = true};
  device.formats.fill(all);
  return device;
}

}  // namespace tandem::test
