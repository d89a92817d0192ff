#include "rhi_cpu/device.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <new>

#include <fmt/format.h>

#include "rhi/validation.hpp"
#include "rhi_cpu/acceleration_structure.hpp"
#include "rhi_cpu/bind_group.hpp"
#include "rhi_cpu/buffer.hpp"
#include "rhi_cpu/command_list.hpp"
#include "rhi_cpu/compute_pipeline.hpp"
#include "rhi_cpu/device_state.hpp"
#include "rhi_cpu/fence.hpp"
#include "rhi_cpu/kernel/group_limits.hpp"
#include "rhi_cpu/kernel/shader_call.hpp"
#include "rhi_cpu/query_pool.hpp"
#include "rhi_cpu/ray_tracing_pipeline.hpp"
#include "rhi_cpu/sampler.hpp"
#include "rhi_cpu/shader_module.hpp"
#include "rhi_cpu/shader_table.hpp"
#include "rhi_cpu/texture.hpp"
#include "rhi_cpu/translate/supported.hpp"

namespace tandem::cpu {
namespace {

/// A mistyped number shall not start threads until the machine has no more.
constexpr std::uint32_t most_threads = 4096;

constexpr std::string_view embree_name = "cpu";
constexpr std::string_view scalar_name = "cpu-scalar";
constexpr std::string_view wide_name = "cpu-wide";
constexpr std::string_view exact_name = "cpu-exact";

class Device final : public rhi::Device {
 public:
  explicit Device(DeviceStateHandle state) : rhi::Device(state->info), state_(std::move(state)) {}

  rhi::BufferHandle create_buffer(const rhi::BufferDesc& desc) override {
    return std::make_shared<Buffer>(state_, desc);
  }

  rhi::AccelerationStructureHandle create_bottom_level(const rhi::BottomLevelDesc& desc) override {
    rhi::validation::check(desc, info());
    check_owner(desc, *state_);
    return std::make_shared<BottomLevelStructure>(state_, desc);
  }

  rhi::AccelerationStructureHandle create_top_level(const rhi::TopLevelDesc& desc) override {
    rhi::validation::check(desc, info());
    check_owner(desc, *state_);
    return std::make_shared<TopLevelStructure>(state_, desc);
  }

  rhi::ShaderModuleHandle create_shader_module(const rhi::ShaderModuleDesc& desc) override {
    return std::make_shared<ShaderModule>(desc);
  }

  rhi::ComputePipelineHandle create_compute_pipeline(const rhi::ComputePipelineDesc& desc) override {
    rhi::validation::check(desc, info());
    return std::make_shared<ComputePipeline>(state_, desc);
  }

  rhi::AccelerationStructureHandle create_compacted(const rhi::AccelerationStructureHandle& source,
                                                    std::string label) override {
    if (source == nullptr || source->level() == rhi::AccelerationStructure::Level::bottom)
      return compacted<BottomLevelStructure>(source, std::move(label));
    return compacted<TopLevelStructure>(source, std::move(label));
  }

  rhi::TextureHandle create_texture(const rhi::TextureDesc& desc) override {
    rhi::validation::check(desc, info());
    return std::make_shared<Texture>(state_, desc);
  }

  rhi::SamplerHandle create_sampler(const rhi::SamplerDesc& desc) override {
    rhi::validation::check(desc);
    return std::make_shared<Sampler>(state_, desc);
  }

  std::vector<std::string> refusals(const rhi::ShaderModuleHandle& shader) const override {
    std::vector<std::string> reasons = rhi::validation::refusals(shader, info());
    for (const std::string& feature : unsupported_features(shader->spirv(), shader->label()))
      reasons.push_back(feature + " is not supported by the CPU device");
    return reasons;
  }

  rhi::RayTracingPipelineHandle create_ray_tracing_pipeline(const rhi::RayTracingPipelineDesc& desc) override {
    rhi::validation::check(desc, info());
    return std::make_shared<RayTracingPipeline>(state_, desc);
  }

  rhi::ShaderTableHandle create_shader_table(const rhi::ShaderTableDesc& desc) override {
    rhi::validation::check(desc, info());
    return std::make_shared<ShaderTable>(state_, desc);
  }

  rhi::BindGroupHandle create_bind_group(const rhi::BindGroupDesc& desc) override {
    rhi::validation::check(desc, info());
    if (desc.pipeline->kind() == rhi::Pipeline::Kind::compute)
      own<ComputePipeline>(desc.pipeline, *state_, desc.label);
    else
      own<RayTracingPipeline>(desc.pipeline, *state_, desc.label);
    return std::make_shared<BindGroup>(state_, desc);
  }

  rhi::QueryPoolHandle create_query_pool(const rhi::QueryPoolDesc& desc) override {
    rhi::validation::check(desc);
    return std::make_shared<QueryPool>(state_, desc);
  }

  rhi::CommandListHandle create_command_list(std::string label) override {
    return std::make_shared<CommandList>(state_, std::move(label));
  }

  rhi::FenceHandle submit(const rhi::CommandListHandle& list) override {
    if (list == nullptr) throw rhi::Error(rhi::ErrorCode::invalid_argument, "", "submit names no command list");
    const std::shared_ptr<CommandList> commands = own<CommandList>(list, *state_, list->label());
    const std::lock_guard lock(state_->submission);
    try {
      commands->execute();
    } catch (const std::bad_alloc&) {
      throw rhi::Error(rhi::ErrorCode::out_of_memory, list->label(), "memory ran out while the list was executed");
    }
    return std::make_shared<Fence>();
  }

  void wait_idle() override { const std::lock_guard lock(state_->submission); }

  void download(const rhi::BufferHandle& buffer, std::uint64_t offset, std::span<std::byte> bytes) override {
    rhi::validation::check_download(buffer, offset, bytes.size());
    const std::shared_ptr<Buffer> source = own<Buffer>(buffer, *state_, buffer->desc().label);
    const std::lock_guard lock(state_->submission);
    std::copy_n(source->data() + offset, bytes.size(), bytes.data());
  }

 private:
  template <typename Structure>
  rhi::AccelerationStructureHandle compacted(const rhi::AccelerationStructureHandle& source, std::string label) {
    const std::shared_ptr<Structure> own_source =
        source == nullptr ? nullptr : own<Structure>(source, *state_, source->label());
    const rhi::BuildFlags flags = source == nullptr ? rhi::BuildFlags::none : own_source->created_from().flags;
    rhi::validation::check_compaction(source, flags, label);
    const std::lock_guard lock(state_->submission);
    return own_source->compacted(std::move(label));
  }

  DeviceStateHandle state_;
};

rhi::Limits limits() {
  return {.max_push_constant_size = 256,
          // The length of an array in a shader has 32 bits.
          .max_storage_buffer_range = 0xFFFFFFFFu,
          .max_uniform_buffer_range = 0xFFFFFFFFu,
          // Kernels load and store through typed views, whose widest member has 16 bytes of alignment.
          .storage_buffer_offset_alignment = 16,
          .uniform_buffer_offset_alignment = 16,
          .texel_buffer_offset_alignment = 16,
          .max_texel_buffer_elements = 1u << 27,
          .max_workgroup_size = {1024, 1024, 1024},
          .max_workgroup_invocations = 1024,
          .workgroup_memory_size = kernel::max_workgroup_memory,
          .subgroup_size = kernel::default_subgroup_size,
          .min_subgroup_size = 1,
          .max_subgroup_size = kernel::max_subgroup_size,
          .max_workgroup_subgroups = 1024,
          .max_workgroup_count = {0x7FFFFFFF, 65535, 65535},
          .max_bind_groups = 32,
          .max_geometry_count = (1u << 24) - 1,
          .max_primitive_count = (1u << 29) - 1,
          .max_instance_count = (1u << 24) - 1,
          .max_ray_recursion_depth = 31,
          .max_ray_invocations = 1u << 30,
          .shader_record_alignment = 32,
          .max_shader_record_stride = 4096,
          .shader_handle_size = 32,
          .max_hit_attribute_size = kernel::max_hit_attribute_size,
          .max_texture_size = {16384, 16384, 2048, 16384, 16384, 16384, 16384},
          .max_texture_layers = 2048};
}

std::array<rhi::FormatSupport, rhi::texture_format_count> format_support() {
  std::array<rhi::FormatSupport, rhi::texture_format_count> formats;
  for (std::size_t i = 0; i < formats.size(); ++i) {
    const auto format = static_cast<rhi::TextureFormat>(i);
    const rhi::ComponentKind kind = rhi::info_of(format).kind;
    const bool is_integer = kind == rhi::ComponentKind::uint || kind == rhi::ComponentKind::sint;
    // Those that SPIR-V has a name for.
    const bool has_layout = format <= rhi::TextureFormat::rg11b10_float;
    using enum rhi::TextureFormat;
    formats[i] = {.storage = has_layout,
                  .storage_atomic = format == r32_uint || format == r32_sint || format == r32_float ||
                                    format == r64_uint || format == r64_sint,
                  .sampled = true,
                  .filtered = !is_integer,
                  .uniform_texel_buffer = kind != rhi::ComponentKind::depth,
                  .storage_texel_buffer = has_layout};
  }
  return formats;
}

rhi::DeviceInfo info_of(const rhi::DeviceDesc& desc) {
  rhi::DeviceInfo info = device_info(desc.name);
  if (desc.subgroup_size != 0) info.limits.subgroup_size = desc.subgroup_size;
  return info;
}

}  // namespace

DeviceState::DeviceState(const rhi::DeviceDesc& desc, std::vector<PrecompiledKernel> precompiled)
    : info(info_of(desc)),
      workers(desc.thread_count),
      tracer(desc.name == exact_name ? Tracer::Kind::exact : Tracer::Kind::embree, desc.on_message),
      time_limit(desc.time_limit),
      kernels(std::move(precompiled),
              {.robust = desc.robust_access,
               .watched = desc.time_limit.count() > 0,
               .subgroup_size = info.limits.subgroup_size,
               .lanes = desc.name == scalar_name ? 1
                        : desc.name == wide_name ? native_lanes()
                                                 : desc.lanes,
               .quick = desc.quick_kernels},
              desc.kernel_cache, desc.on_message) {}

std::span<const std::string_view> device_names() {
  static constexpr std::array names = {embree_name, exact_name};
  return names;
}

bool is_device_name(std::string_view name) {
  const std::span<const std::string_view> names = device_names();
  return name == scalar_name || name == wide_name || std::find(names.begin(), names.end(), name) != names.end();
}

rhi::DeviceInfo device_info(std::string_view name) {
  const std::string processor = processor_name();
  return {.name = std::string(name),
          .backend = "cpu",
          .description = processor.empty() ? "CPU" : processor,
          .driver = name == exact_name ? "Tandem's exact tracer" : embree_version(),
          .api = "",
          .kind = rhi::DeviceKind::cpu,
          .capabilities = {.ray_query = true,
                           .ray_tracing_pipeline = true,
                           .position_fetch = false,
                           .trace_rays_indirect = true,
                           .primitive_culling = true,
                           .null_acceleration_structure = true,
                           .buffer_references = true,
                           .non_uniform_indexing = true,
                           .unsized_arrays = true,
                           .partially_bound = true,
                           .cube_arrays = true,
                           .scalar_block_layout = true,
                           .shader_int8 = true,
                           .shader_int16 = true,
                           .shader_int64 = true,
                           .shader_float16 = true,
                           .shader_float64 = true,
                           .timestamps = true,
                           .zeroed_workgroup_memory = true,
                           .workgroup_memory_layout = true,
                           .workgroup_memory_layout_8bit = true,
                           .workgroup_memory_layout_16bit = true,
                           .shared_int64_atomics = true,
                           .shared_float32_atomics = true,
                           .shared_float32_atomic_add = true,
                           .shared_float32_atomic_min_max = true,
                           .shared_float64_atomic_add = true,
                           .subgroup_basic = true,
                           .subgroup_vote = true,
                           .subgroup_arithmetic = true,
                           .subgroup_ballot = true,
                           .subgroup_shuffle = true,
                           .subgroup_shuffle_relative = true,
                           .subgroup_clustered = true,
                           .subgroup_quad = true,
                           .subgroup_rotate = true,
                           .subgroup_clustered_rotate = true,
                           .subgroup_extended_types = true,
                           .required_subgroup_size = true,
                           .full_subgroups = true,
                           .subgroup_uniform_control_flow = true,
                           .maximal_reconvergence = true},
          .limits = limits(),
          .formats = format_support(),
          .spirv_capabilities = supported_capabilities()};
}

rhi::DeviceHandle create_device(const rhi::DeviceDesc& desc, std::vector<PrecompiledKernel> precompiled) {
  if (!is_device_name(desc.name))
    throw rhi::Error(rhi::ErrorCode::no_such_device, desc.name, "there is no such CPU device");
  if (desc.thread_count > most_threads)
    throw rhi::Error(rhi::ErrorCode::invalid_argument, desc.name,
                     fmt::format("a device of {} threads; the most is {}", desc.thread_count, most_threads));
  if (desc.subgroup_size != 0 &&
      (!std::has_single_bit(desc.subgroup_size) || desc.subgroup_size > kernel::max_subgroup_size))
    throw rhi::Error(rhi::ErrorCode::invalid_argument, desc.name,
                     fmt::format("subgroups of {} invocations; the sizes are powers of two up to {}",
                                 desc.subgroup_size, kernel::max_subgroup_size));
  if (desc.lanes != 0 &&
      (!std::has_single_bit(desc.lanes) || desc.lanes > kernel::max_subgroup_size || desc.lanes == 2))
    throw rhi::Error(rhi::ErrorCode::invalid_argument, desc.name,
                     fmt::format("kernels of {} lanes; there are 1, 4, 8, 16 and 32", desc.lanes));
  return std::make_shared<Device>(std::make_shared<DeviceState>(desc, std::move(precompiled)));
}

}  // namespace tandem::cpu
