#include "tests/pathtracer/render/device_without_queries.hpp"

#include <memory>
#include <utility>

namespace tandem::test {
namespace {

rhi::DeviceInfo without_queries(rhi::DeviceInfo info) {
  info.capabilities.ray_query = false;
  return info;
}

class DeviceWithoutQueries final : public rhi::Device {
 public:
  explicit DeviceWithoutQueries(rhi::Device& device) : Device(without_queries(device.info())), device_(device) {}

  rhi::BufferHandle create_buffer(const rhi::BufferDesc& desc) override { return device_.create_buffer(desc); }
  rhi::AccelerationStructureHandle create_bottom_level(const rhi::BottomLevelDesc& desc) override {
    return device_.create_bottom_level(desc);
  }
  rhi::AccelerationStructureHandle create_top_level(const rhi::TopLevelDesc& desc) override {
    return device_.create_top_level(desc);
  }
  rhi::AccelerationStructureHandle create_compacted(const rhi::AccelerationStructureHandle& source,
                                                    std::string label) override {
    return device_.create_compacted(source, std::move(label));
  }
  rhi::TextureHandle create_texture(const rhi::TextureDesc& desc) override { return device_.create_texture(desc); }
  rhi::ShaderModuleHandle create_shader_module(const rhi::ShaderModuleDesc& desc) override {
    return device_.create_shader_module(desc);
  }
  rhi::SamplerHandle create_sampler(const rhi::SamplerDesc& desc) override { return device_.create_sampler(desc); }
  std::vector<std::string> refusals(const rhi::ShaderModuleHandle& shader) const override {
    return device_.refusals(shader);
  }
  rhi::ComputePipelineHandle create_compute_pipeline(const rhi::ComputePipelineDesc& desc) override {
    throw rhi::Error(rhi::ErrorCode::unsupported, desc.label, "this device has no ray queries");
  }
  rhi::RayTracingPipelineHandle create_ray_tracing_pipeline(const rhi::RayTracingPipelineDesc& desc) override {
    return device_.create_ray_tracing_pipeline(desc);
  }
  rhi::ShaderTableHandle create_shader_table(const rhi::ShaderTableDesc& desc) override {
    return device_.create_shader_table(desc);
  }
  rhi::BindGroupHandle create_bind_group(const rhi::BindGroupDesc& desc) override {
    return device_.create_bind_group(desc);
  }
  rhi::QueryPoolHandle create_query_pool(const rhi::QueryPoolDesc& desc) override {
    return device_.create_query_pool(desc);
  }
  rhi::CommandListHandle create_command_list(std::string label) override {
    return device_.create_command_list(std::move(label));
  }
  rhi::FenceHandle submit(const rhi::CommandListHandle& list) override { return device_.submit(list); }
  void wait_idle() override { device_.wait_idle(); }
  void download(const rhi::BufferHandle& buffer, std::uint64_t offset, std::span<std::byte> bytes) override {
    device_.download(buffer, offset, bytes);
  }

 private:
  rhi::Device& device_;
};

}  // namespace

rhi::DeviceHandle device_without_queries(rhi::Device& device) { return std::make_shared<DeviceWithoutQueries>(device); }

}  // namespace tandem::test
