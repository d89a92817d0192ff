#include "docs/internals/porting/skeleton.hpp"

#include <algorithm>
#include <cstring>
#include <functional>
#include <utility>

#include "rhi/validation.hpp"

namespace skeleton {
namespace {

namespace rhi = tandem::rhi;
namespace validation = tandem::rhi::validation;

/// What every function that is still to be written does: it names the object and itself.
[[noreturn]] void refuse(const std::string& label, const char* what) {
  throw rhi::Error(rhi::ErrorCode::unsupported, label, std::string("the skeleton has no ") + what);
}

class Buffer final : public rhi::Buffer {
 public:
  explicit Buffer(const rhi::BufferDesc& desc) : rhi::Buffer(desc), bytes_(desc.size) {}

  std::uint64_t device_address() const override { refuse(desc().label, "device addresses"); }
  std::byte* data() noexcept { return bytes_.data(); }

 private:
  std::vector<std::byte> bytes_;
};

/// The backend's own object behind a handle that this device made.
Buffer& own(const rhi::BufferHandle& buffer) { return static_cast<Buffer&>(*buffer); }

class ShaderModule final : public rhi::ShaderModule {
 public:
  explicit ShaderModule(const rhi::ShaderModuleDesc& desc) : rhi::ShaderModule(desc) {}
};

/// Everything has executed when submit returns.
class Fence final : public rhi::Fence {
 public:
  bool wait_for(std::chrono::nanoseconds) override { return true; }
  void wait() override {}
};

/// Commands as functions, which keep what they name alive.
class CommandList final : public rhi::CommandList {
 public:
  explicit CommandList(std::string label) : rhi::CommandList(std::move(label)) {}

  void upload(const rhi::BufferHandle& buffer, std::uint64_t offset, std::span<const std::byte> bytes) override {
    validation::check_upload(*this, buffer, offset, bytes.size());
    record([=, copy = std::vector<std::byte>(bytes.begin(), bytes.end())] {
      std::copy(copy.begin(), copy.end(), own(buffer).data() + offset);
    });
  }
  void copy(const rhi::BufferRange& source, const rhi::BufferRange& destination) override {
    validation::check_copy(*this, source, destination);
    record([=] {
      std::memcpy(own(destination.buffer).data() + destination.offset, own(source.buffer).data() + source.offset,
                  source.resolved_size());
    });
  }
  void fill(const rhi::BufferRange& range, std::uint32_t value) override {
    validation::check_fill(*this, range);
    record([=] {
      for (std::uint64_t at = 0; at < range.resolved_size(); at += sizeof(value))
        std::memcpy(own(range.buffer).data() + range.offset + at, &value, sizeof(value));
    });
  }

  void copy_to_texture(const rhi::BufferRange&, const rhi::TextureHandle&) override { refuse(label(), "textures"); }
  void copy_from_texture(const rhi::TextureHandle&, const rhi::BufferRange&) override { refuse(label(), "textures"); }
  void build_bottom_level(const rhi::AccelerationStructureHandle&, const rhi::BottomLevelDesc& desc) override {
    refuse(desc.label, "bottom levels");
  }
  void build_top_level(const rhi::AccelerationStructureHandle&, const rhi::TopLevelDesc& desc) override {
    refuse(desc.label, "top levels");
  }
  void update_bottom_level(const rhi::AccelerationStructureHandle&, const rhi::BottomLevelDesc& desc) override {
    refuse(desc.label, "bottom levels");
  }
  void update_top_level(const rhi::AccelerationStructureHandle&, const rhi::TopLevelDesc& desc) override {
    refuse(desc.label, "top levels");
  }
  void dispatch(const rhi::DispatchDesc&) override { refuse(label(), "compute pipelines"); }
  void trace_rays(const rhi::TraceRaysDesc&) override { refuse(label(), "ray tracing pipelines"); }
  void write_timestamp(const rhi::QueryPoolHandle&, std::uint32_t) override { refuse(label(), "timestamps"); }

  /// Runs the commands, once.
  void execute() {
    submitted_ = true;
    for (const std::function<void()>& command : commands_) command();
  }

 private:
  void record(std::function<void()> command) {
    if (submitted_)
      throw rhi::Error(rhi::ErrorCode::invalid_argument, label(), "a command is recorded after the list was submitted");
    commands_.push_back(std::move(command));
  }

  std::vector<std::function<void()>> commands_;
  bool submitted_ = false;
};

class Device final : public rhi::Device {
 public:
  Device() : rhi::Device(device_info()) {}

  rhi::BufferHandle create_buffer(const rhi::BufferDesc& desc) override {
    validation::check(desc);
    return std::make_shared<Buffer>(desc);
  }
  rhi::ShaderModuleHandle create_shader_module(const rhi::ShaderModuleDesc& desc) override {
    return std::make_shared<ShaderModule>(desc);
  }
  rhi::CommandListHandle create_command_list(std::string label) override {
    return std::make_shared<CommandList>(std::move(label));
  }
  rhi::FenceHandle submit(const rhi::CommandListHandle& list) override {
    static_cast<CommandList&>(*list).execute();
    return std::make_shared<Fence>();
  }
  void wait_idle() override {}
  void download(const rhi::BufferHandle& buffer, std::uint64_t offset, std::span<std::byte> bytes) override {
    validation::check_download(buffer, offset, bytes.size());
    std::memcpy(bytes.data(), own(buffer).data() + offset, bytes.size());
  }

  rhi::AccelerationStructureHandle create_bottom_level(const rhi::BottomLevelDesc& desc) override {
    refuse(desc.label, "bottom levels");
  }
  rhi::AccelerationStructureHandle create_top_level(const rhi::TopLevelDesc& desc) override {
    refuse(desc.label, "top levels");
  }
  rhi::AccelerationStructureHandle create_compacted(const rhi::AccelerationStructureHandle&,
                                                    std::string label) override {
    refuse(label, "compaction");
  }
  rhi::TextureHandle create_texture(const rhi::TextureDesc& desc) override { refuse(desc.label, "textures"); }
  rhi::SamplerHandle create_sampler(const rhi::SamplerDesc& desc) override { refuse(desc.label, "samplers"); }
  std::vector<std::string> refusals(const rhi::ShaderModuleHandle&) const override {
    return {"the skeleton runs no shaders"};
  }
  rhi::ComputePipelineHandle create_compute_pipeline(const rhi::ComputePipelineDesc& desc) override {
    refuse(desc.label, "compute pipelines");
  }
  rhi::RayTracingPipelineHandle create_ray_tracing_pipeline(const rhi::RayTracingPipelineDesc& desc) override {
    refuse(desc.label, "ray tracing pipelines");
  }
  rhi::ShaderTableHandle create_shader_table(const rhi::ShaderTableDesc& desc) override {
    refuse(desc.label, "shader tables");
  }
  rhi::BindGroupHandle create_bind_group(const rhi::BindGroupDesc& desc) override { refuse(desc.label, "bind groups"); }
  rhi::QueryPoolHandle create_query_pool(const rhi::QueryPoolDesc& desc) override { refuse(desc.label, "timestamps"); }
};

}  // namespace

rhi::DeviceInfo device_info() {
  rhi::DeviceInfo info;  // no capability, and limits of nothing
  info.name = "skeleton";
  info.backend = "skeleton";
  info.description = "the processor's memory";
  info.driver = "skeleton 1";
  return info;
}

rhi::DeviceHandle create_device() { return std::make_shared<Device>(); }

}  // namespace skeleton
