#include "rhi_vulkan/device.hpp"

#include <algorithm>
#include <charconv>
#include <cstring>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "rhi/validation.hpp"
#include "rhi_vulkan/acceleration_structure.hpp"
#include "rhi_vulkan/bind_group.hpp"
#include "rhi_vulkan/buffer.hpp"
#include "rhi_vulkan/command_buffer.hpp"
#include "rhi_vulkan/command_list.hpp"
#include "rhi_vulkan/compute_pipeline.hpp"
#include "rhi_vulkan/context.hpp"
#include "rhi_vulkan/fence.hpp"
#include "rhi_vulkan/make_device.hpp"
#include "rhi_vulkan/query_pool.hpp"
#include "rhi_vulkan/ray_tracing_pipeline.hpp"
#include "rhi_vulkan/sampler.hpp"
#include "rhi_vulkan/shader_capabilities.hpp"
#include "rhi_vulkan/shader_module.hpp"
#include "rhi_vulkan/shader_table.hpp"
#include "rhi_vulkan/texture.hpp"

namespace tandem::vulkan {
namespace {

/// Downloads go in pieces of this size, so that staging never needs one allocation as large as the buffer.
constexpr std::uint64_t download_piece = 32ull << 20;

class Device final : public rhi::Device {
 public:
  explicit Device(ContextHandle context) : rhi::Device(context->physical.info), context_(std::move(context)) {}
  // What is in flight holds objects that hold the context that holds what is in flight: somebody has to wait.
  ~Device() override { context_->queue.drain(); }

  rhi::BufferHandle create_buffer(const rhi::BufferDesc& desc) override {
    rhi::validation::check(desc);
    return std::make_shared<Buffer>(context_, desc);
  }

  rhi::AccelerationStructureHandle create_bottom_level(const rhi::BottomLevelDesc& desc) override {
    rhi::validation::check(desc, info());
    return std::make_shared<AccelerationStructure>(context_, desc);
  }

  rhi::AccelerationStructureHandle create_top_level(const rhi::TopLevelDesc& desc) override {
    rhi::validation::check(desc, info());
    return std::make_shared<AccelerationStructure>(context_, desc);
  }

  rhi::ShaderModuleHandle create_shader_module(const rhi::ShaderModuleDesc& desc) override {
    return std::make_shared<ShaderModule>(context_, desc);
  }

  rhi::ComputePipelineHandle create_compute_pipeline(const rhi::ComputePipelineDesc& desc) override {
    rhi::validation::check(desc, info());
    return std::make_shared<ComputePipeline>(context_, desc);
  }

  rhi::AccelerationStructureHandle create_compacted(const rhi::AccelerationStructureHandle& source,
                                                    std::string label) override {
    if (source == nullptr) rhi::validation::check_compaction(source, rhi::BuildFlags::none, label);
    const auto& original = own<AccelerationStructure>(source, context_, label, "acceleration structure");
    rhi::validation::check_compaction(source, original.flags(), label);
    return make_compacted(source, original, label);
  }

  rhi::TextureHandle create_texture(const rhi::TextureDesc& desc) override {
    rhi::validation::check(desc, info());
    return std::make_shared<Texture>(context_, desc);
  }

  rhi::SamplerHandle create_sampler(const rhi::SamplerDesc& desc) override {
    rhi::validation::check(desc);
    return std::make_shared<Sampler>(context_, desc);
  }

  std::vector<std::string> refusals(const rhi::ShaderModuleHandle& shader) const override {
    std::vector<std::string> reasons = rhi::validation::refusals(shader, info());
    for (const std::string& capability : missing_capabilities(shader->spirv(), context_->physical))
      reasons.push_back("device '" + info().name + "' does not offer " + capability);
    return reasons;
  }

  rhi::RayTracingPipelineHandle create_ray_tracing_pipeline(const rhi::RayTracingPipelineDesc& desc) override {
    rhi::validation::check(desc, info());
    return std::make_shared<RayTracingPipeline>(context_, desc);
  }

  rhi::ShaderTableHandle create_shader_table(const rhi::ShaderTableDesc& desc) override {
    rhi::validation::check(desc, info());
    return std::make_shared<ShaderTable>(context_, desc);
  }

  rhi::BindGroupHandle create_bind_group(const rhi::BindGroupDesc& desc) override {
    rhi::validation::check(desc, info());
    return std::make_shared<BindGroup>(context_, desc);
  }

  rhi::QueryPoolHandle create_query_pool(const rhi::QueryPoolDesc& desc) override {
    rhi::validation::check(desc);
    return std::make_shared<QueryPool>(context_, desc);
  }

  rhi::CommandListHandle create_command_list(std::string label) override {
    return std::make_shared<CommandList>(context_, std::move(label));
  }

  rhi::FenceHandle submit(const rhi::CommandListHandle& list) override {
    if (list == nullptr) throw rhi::Error(rhi::ErrorCode::invalid_argument, "", "submit names no command list");
    auto& commands = own<CommandList>(list, context_, list->label(), "command list");
    return std::make_shared<Fence>(context_, commands.submit());
  }

  void wait_idle() override { context_->queue.wait(context_->queue.last_submitted()); }

  void download(const rhi::BufferHandle& buffer, std::uint64_t offset, std::span<std::byte> bytes) override {
    rhi::validation::check_download(buffer, offset, bytes.size());
    const Buffer& source = own<Buffer>(buffer, context_, buffer->desc().label, "buffer of a download");
    if (bytes.empty()) return wait_idle();
    const std::string label = "download of " + buffer->desc().label;
    const std::uint64_t staging_size = std::min<std::uint64_t>(bytes.size(), download_piece);
    // Shared with the submission, which may outlive this call when waiting for it fails.
    const auto staging = std::make_shared<BackedBuffer>(make_backed_buffer(
        *context_, staging_size, vk::BufferUsageFlagBits::eTransferDst, MemoryKind::download, label));
    while (!bytes.empty()) {
      const std::uint64_t size = std::min<std::uint64_t>(bytes.size(), staging_size);
      copy_to_host(source, buffer, offset, staging, size, label);
      std::memcpy(bytes.data(), staging->memory.mapped(), size);
      bytes = bytes.subspan(size);
      offset += size;
    }
  }

 private:
  void copy_to_host(const Buffer& source, const rhi::BufferHandle& buffer, std::uint64_t offset,
                    const std::shared_ptr<BackedBuffer>& staging, std::uint64_t size, const std::string& label) {
    translating_errors(label, "copy from the device", [&] {
      const auto both = std::make_shared<std::pair<rhi::BufferHandle, std::shared_ptr<BackedBuffer>>>(buffer, staging);
      context_->queue.wait(submit_commands(*context_, label, both, [&](const vk::raii::CommandBuffer& commands) {
        commands.copyBuffer(source.handle(), *staging->handle, vk::BufferCopy{.srcOffset = offset, .size = size});
        host_read_barrier(commands);
      }));
    });
  }

  ContextHandle context_;
};

/// N of "vulkan:N", 0 for "vulkan".
std::size_t device_index(const std::string& name) {
  constexpr std::string_view first = "vulkan";
  constexpr std::string_view prefix = "vulkan:";
  if (name == first) return 0;
  std::size_t index = 0;
  if (name.starts_with(prefix)) {
    const char* const end = name.data() + name.size();
    const auto [parsed, error] = std::from_chars(name.data() + prefix.size(), end, index);
    if (error == std::errc() && parsed == end) return index;
  }
  throw rhi::Error(rhi::ErrorCode::no_such_device, "",
                   "'" + name + "' is not a Vulkan device: the name must be vulkan or vulkan:N");
}

[[noreturn]] void throw_no_such_device(const std::string& name, const PhysicalDevices& devices) {
  std::string why;
  if (devices.qualifying.empty()) {
    why = "no Vulkan device qualifies";
    for (const std::string& refusal : devices.refusals)
      why += (&refusal == devices.refusals.data() ? ": " : "; ") + refusal;
  } else {
    why = "there is no device '" + name + "', but";
    for (const PhysicalDevice& device : devices.qualifying)
      why +=
          (&device == devices.qualifying.data() ? " " : ", ") + device.info.name + " (" + device.info.description + ")";
  }
  throw rhi::Error(rhi::ErrorCode::no_such_device, "", why);
}

}  // namespace

std::vector<rhi::DeviceInfo> enumerate(const rhi::MessageCallback& on_message) {
  const auto warn = [&](const std::string& text) {
    if (on_message) on_message({rhi::Severity::warning, "vulkan", text});
  };
  std::vector<rhi::DeviceInfo> infos;
  try {
    const Instance instance(false, on_message);
    const PhysicalDevices devices = find_physical_devices(instance);
    for (const PhysicalDevice& device : devices.qualifying) {
      infos.push_back(device.info);
      infos.back().spirv_capabilities = offered_capabilities(device);
    }
    for (const std::string& refusal : devices.refusals) warn(refusal);
  } catch (const rhi::Error& error) {
    warn(error.what());
  }
  return infos;
}

rhi::DeviceHandle make_device(std::unique_ptr<Instance> instance, PhysicalDevice physical) {
  return std::make_shared<Device>(std::make_shared<Context>(std::move(instance), std::move(physical)));
}

rhi::DeviceHandle create_device(const rhi::DeviceDesc& desc) {
  const std::size_t index = device_index(desc.name);
  auto instance = std::make_unique<Instance>(desc.driver_validation, desc.on_message);
  PhysicalDevices devices = find_physical_devices(*instance);
  if (index >= devices.qualifying.size()) throw_no_such_device(desc.name, devices);
  PhysicalDevice& physical = devices.qualifying[index];
  if (!desc.robust_access) forget_robust_access(physical.features);
  physical.info.spirv_capabilities = offered_capabilities(physical);
  return make_device(std::move(instance), std::move(physical));
}

}  // namespace tandem::vulkan
