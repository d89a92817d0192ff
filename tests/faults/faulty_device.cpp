#include "tests/faults/faulty_device.hpp"

#include <algorithm>
#include <cstring>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <utility>
#include <variant>

namespace tandem::test {
namespace {

/// What a buffer holds on a device that does not clear it: 0.5 as a float.
constexpr std::uint32_t stale_memory = 0x3f000000;

/// What the device and its command lists share.
struct FaultState {
  rhi::DeviceHandle device;
  DeviceEdits edits;
  std::mutex mutex;
  std::map<const rhi::Buffer*, std::vector<std::byte>> uploaded;  ///< of inputs of acceleration structures
  std::optional<DispatchEdit> previous;                           ///< the dispatch before, as it was asked for
};

std::vector<std::byte> bytes_of(std::span<const std::byte> bytes) { return {bytes.begin(), bytes.end()}; }

class FaultyCommandList final : public rhi::CommandList {
 public:
  FaultyCommandList(std::shared_ptr<FaultState> state, std::string label)
      : CommandList(label), state_(std::move(state)), list_(state_->device->create_command_list(std::move(label))) {}

  const rhi::CommandListHandle& inner() const noexcept { return list_; }

  void upload(const rhi::BufferHandle& buffer, std::uint64_t offset, std::span<const std::byte> bytes) override {
    std::vector<std::byte> edited = bytes_of(bytes);
    if (edits().upload) edits().upload(*buffer, edited);
    remember(*buffer, offset, edited);
    list_->upload(buffer, offset, edited);
  }
  void copy(const rhi::BufferRange& source, const rhi::BufferRange& destination) override {
    list_->copy(source, destination);
  }
  void fill(const rhi::BufferRange& range, std::uint32_t value) override {
    if (!edits().skips_fills) list_->fill(range, value);
  }
  void copy_to_texture(const rhi::BufferRange& source, const rhi::TextureHandle& destination) override {
    list_->copy_to_texture(source, destination);
  }
  void copy_from_texture(const rhi::TextureHandle& source, const rhi::BufferRange& destination) override {
    list_->copy_from_texture(source, destination);
  }

  void build_bottom_level(const rhi::AccelerationStructureHandle& structure,
                          const rhi::BottomLevelDesc& desc) override {
    list_->build_bottom_level(structure, edited(desc));
  }
  void build_top_level(const rhi::AccelerationStructureHandle& structure, const rhi::TopLevelDesc& desc) override {
    list_->build_top_level(structure, edited(desc));
  }
  void update_bottom_level(const rhi::AccelerationStructureHandle& structure,
                           const rhi::BottomLevelDesc& desc) override {
    if (!edits().skips_bottom_level_updates) list_->update_bottom_level(structure, edited(desc));
  }
  void update_top_level(const rhi::AccelerationStructureHandle& structure, const rhi::TopLevelDesc& desc) override {
    if (!edits().skips_top_level_updates) list_->update_top_level(structure, edited(desc));
  }

  void dispatch(const rhi::DispatchDesc& desc) override {
    const DispatchEdit run = edited({bytes_of(desc.push_constants), desc.workgroup_count});
    rhi::DispatchDesc inner = desc;
    inner.push_constants = run.push_constants;
    inner.workgroup_count = run.size;
    list_->dispatch(inner);
  }
  void trace_rays(const rhi::TraceRaysDesc& desc) override {
    const DispatchEdit run = edited({bytes_of(desc.push_constants), desc.size});
    rhi::TraceRaysDesc inner = desc;
    inner.push_constants = run.push_constants;
    inner.size = run.size;
    list_->trace_rays(inner);
  }
  void write_timestamp(const rhi::QueryPoolHandle& pool, std::uint32_t index) override {
    list_->write_timestamp(pool, index);
  }

 private:
  const DeviceEdits& edits() const { return state_->edits; }

  void remember(const rhi::Buffer& buffer, std::uint64_t offset, std::span<const std::byte> bytes) {
    if (!rhi::has(buffer.desc().usage, rhi::BufferUsage::acceleration_structure_input)) return;
    const std::lock_guard lock(state_->mutex);
    std::vector<std::byte>& known = state_->uploaded[&buffer];
    known.resize(buffer.size());
    std::ranges::copy(bytes, known.begin() + static_cast<std::ptrdiff_t>(offset));
  }

  /// What was uploaded to a range of at least `size` bytes.
  std::vector<std::byte> uploaded(const rhi::BufferRange& range, std::size_t size) {
    const std::lock_guard lock(state_->mutex);
    const auto found = state_->uploaded.find(range.buffer.get());
    if (found == state_->uploaded.end() || found->second.size() < range.offset + size)
      throw rhi::Error(rhi::ErrorCode::unsupported, range.buffer->desc().label,
                       "what a build reads and a fault changes has to be uploaded");
    return {found->second.begin() + static_cast<std::ptrdiff_t>(range.offset), found->second.end()};
  }

  /// A buffer like that of the range, with other bytes.
  rhi::BufferRange buffer_of(const rhi::BufferRange& range, std::span<const std::byte> bytes) {
    rhi::BufferDesc desc = range.buffer->desc();
    desc.size = bytes.size();
    const rhi::BufferHandle copy = state_->device->create_buffer(desc);
    list_->upload(copy, 0, bytes);
    return {copy};
  }

  /// The first `count` elements of a range, `stride` bytes apart, edited in a buffer of their own.
  template <typename T>
  rhi::BufferRange edited_copy(const rhi::BufferRange& range, std::uint32_t count, std::uint32_t stride,
                               const std::function<void(T&)>& edit) {
    std::vector<std::byte> bytes = uploaded(range, count == 0 ? 0 : (count - 1) * std::size_t{stride} + sizeof(T));
    for (std::uint32_t i = 0; i < count; ++i) {
      T value;
      std::memcpy(&value, bytes.data() + i * std::size_t{stride}, sizeof(T));
      edit(value);
      std::memcpy(bytes.data() + i * std::size_t{stride}, &value, sizeof(T));
    }
    return buffer_of(range, bytes);
  }

  /// Indices of a geometry in which triangles that are lost have the same corner three times.
  rhi::BufferRange indices_without_lost(const rhi::TriangleGeometry& geometry, const std::string& label) {
    if (geometry.index_format != rhi::IndexFormat::uint32 || geometry.vertex_format != rhi::VertexFormat::float3)
      throw rhi::Error(rhi::ErrorCode::unsupported, label, "triangles that a fault loses have uint32 and float3");
    using Triangle = std::array<std::uint32_t, 3>;
    const std::vector<std::byte> vertices =
        uploaded(geometry.vertices, std::size_t{geometry.vertex_count} * geometry.vertex_stride);
    return edited_copy<Triangle>(geometry.indices, geometry.triangle_count, sizeof(Triangle), [&](Triangle& triangle) {
      std::array<std::array<float, 3>, 3> corners;
      for (std::size_t i = 0; i < 3; ++i)
        std::memcpy(&corners[i], vertices.data() + std::size_t{triangle[i]} * geometry.vertex_stride,
                    sizeof(corners[i]));
      if (edits().loses_triangle(corners)) triangle[1] = triangle[2] = triangle[0];
    });
  }

  rhi::BottomLevelDesc edited(rhi::BottomLevelDesc desc) {
    for (rhi::Geometry& geometry : desc.geometries) {
      if (auto* triangles = std::get_if<rhi::TriangleGeometry>(&geometry); triangles != nullptr && edits().vertex) {
        if (triangles->vertex_format != rhi::VertexFormat::float3)
          throw rhi::Error(rhi::ErrorCode::unsupported, desc.label, "positions that a fault changes are float3");
        triangles->vertices = edited_copy<std::array<float, 3>>(triangles->vertices, triangles->vertex_count,
                                                                triangles->vertex_stride, edits().vertex);
      }
      if (auto* triangles = std::get_if<rhi::TriangleGeometry>(&geometry); triangles && edits().loses_triangle)
        triangles->indices = indices_without_lost(*triangles, desc.label);
      if (auto* boxes = std::get_if<rhi::AabbGeometry>(&geometry); boxes != nullptr && edits().box)
        boxes->boxes = edited_copy<std::array<float, 6>>(boxes->boxes, boxes->box_count, boxes->stride, edits().box);
    }
    if (edits().bottom_level) edits().bottom_level(desc);
    return desc;
  }
  rhi::TopLevelDesc edited(rhi::TopLevelDesc desc) {
    if (edits().instance)
      desc.instances = edited_copy<rhi::InstanceDesc>(desc.instances, desc.instance_count, sizeof(rhi::InstanceDesc),
                                                      edits().instance);
    if (edits().instance_count) edits().instance_count(desc.instance_count);
    return desc;
  }
  DispatchEdit edited(DispatchEdit run) {
    const std::lock_guard lock(state_->mutex);
    DispatchEdit asked = run;
    if (edits().dispatch) edits().dispatch(run, state_->previous ? &*state_->previous : nullptr);
    state_->previous = std::move(asked);
    return run;
  }

  std::shared_ptr<FaultState> state_;
  rhi::CommandListHandle list_;
};

rhi::DeviceInfo faulty(rhi::DeviceInfo info) {
  info.name = "faulty " + info.name;
  return info;
}

class FaultyDevice final : public rhi::Device {
 public:
  FaultyDevice(rhi::DeviceHandle device, DeviceEdits edits)
      : Device(faulty(device->info())), state_(std::make_shared<FaultState>()) {
    state_->device = std::move(device);
    state_->edits = std::move(edits);
  }

  rhi::BufferHandle create_buffer(const rhi::BufferDesc& desc) override {
    const rhi::BufferHandle buffer = inner().create_buffer(desc);
    {
      // Memory is used again, and so are addresses.
      const std::lock_guard lock(state_->mutex);
      state_->uploaded.erase(buffer.get());
    }
    if (state_->edits.skips_fills && desc.size % sizeof(stale_memory) == 0) {
      const rhi::CommandListHandle list = inner().create_command_list("stale memory of " + desc.label);
      list->fill({buffer}, stale_memory);
      inner().submit(list)->wait();
    }
    return buffer;
  }
  rhi::AccelerationStructureHandle create_bottom_level(const rhi::BottomLevelDesc& desc) override {
    rhi::BottomLevelDesc edited = desc;
    if (state_->edits.bottom_level) state_->edits.bottom_level(edited);
    return inner().create_bottom_level(edited);
  }
  rhi::AccelerationStructureHandle create_top_level(const rhi::TopLevelDesc& desc) override {
    return inner().create_top_level(desc);
  }
  rhi::AccelerationStructureHandle create_compacted(const rhi::AccelerationStructureHandle& source,
                                                    std::string label) override {
    return inner().create_compacted(source, std::move(label));
  }
  rhi::TextureHandle create_texture(const rhi::TextureDesc& desc) override { return inner().create_texture(desc); }

  rhi::ShaderModuleHandle create_shader_module(const rhi::ShaderModuleDesc& desc) override {
    if (!state_->edits.shader) return inner().create_shader_module(desc);
    SpirvModule module(desc.spirv);
    if (!state_->edits.shader(module, rhi::reflect(desc.spirv, desc.label).stage))
      return inner().create_shader_module(desc);
    const std::vector<std::uint32_t> words = module.words();
    return inner().create_shader_module({words, desc.label, true});
  }
  rhi::SamplerHandle create_sampler(const rhi::SamplerDesc& desc) override { return inner().create_sampler(desc); }
  std::vector<std::string> refusals(const rhi::ShaderModuleHandle& shader) const override {
    return state_->device->refusals(shader);
  }
  rhi::ComputePipelineHandle create_compute_pipeline(const rhi::ComputePipelineDesc& desc) override {
    rhi::ComputePipelineDesc edited = desc;
    if (state_->edits.specialization) state_->edits.specialization(edited.specialization);
    return inner().create_compute_pipeline(edited);
  }
  rhi::RayTracingPipelineHandle create_ray_tracing_pipeline(const rhi::RayTracingPipelineDesc& desc) override {
    rhi::RayTracingPipelineDesc edited = desc;
    if (state_->edits.specialization) state_->edits.specialization(edited.specialization);
    return inner().create_ray_tracing_pipeline(edited);
  }
  rhi::ShaderTableHandle create_shader_table(const rhi::ShaderTableDesc& desc) override {
    return inner().create_shader_table(desc);
  }
  rhi::BindGroupHandle create_bind_group(const rhi::BindGroupDesc& desc) override {
    return inner().create_bind_group(desc);
  }
  rhi::QueryPoolHandle create_query_pool(const rhi::QueryPoolDesc& desc) override {
    return inner().create_query_pool(desc);
  }
  rhi::CommandListHandle create_command_list(std::string label) override {
    return std::make_shared<FaultyCommandList>(state_, std::move(label));
  }
  rhi::FenceHandle submit(const rhi::CommandListHandle& list) override {
    return inner().submit(std::dynamic_pointer_cast<FaultyCommandList>(list)->inner());
  }
  void wait_idle() override { inner().wait_idle(); }
  void download(const rhi::BufferHandle& buffer, std::uint64_t offset, std::span<std::byte> bytes) override {
    inner().download(buffer, offset, bytes);
  }

 private:
  rhi::Device& inner() const { return *state_->device; }

  std::shared_ptr<FaultState> state_;
};

}  // namespace

rhi::DeviceHandle faulty_device(rhi::DeviceHandle device, DeviceEdits edits) {
  return std::make_shared<FaultyDevice>(std::move(device), std::move(edits));
}

}  // namespace tandem::test
