#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "rhi/acceleration_structure.hpp"
#include "rhi/bind_group.hpp"
#include "rhi/buffer.hpp"
#include "rhi/compute_pipeline.hpp"
#include "rhi/query_pool.hpp"
#include "rhi/ray_tracing_pipeline.hpp"
#include "rhi/shader_table.hpp"
#include "rhi/texture.hpp"

namespace tandem::rhi {

/// One run of a compute shader: workgroup_count[0] * [1] * [2] workgroups of the shader's own size.
struct DispatchDesc {
  ComputePipelineHandle pipeline;
  std::vector<BindGroupHandle> bind_groups;                  ///< in any order, one for each set that the shader uses
  std::span<const std::byte> push_constants = {};            ///< exactly the size that the shader declares; copied
  std::array<std::uint32_t, 3> workgroup_count = {1, 1, 1};  ///< a zero makes the dispatch do nothing
  /// The first workgroup's id, from which the others are counted (gl_WorkGroupID); gl_NumWorkGroups stays
  /// workgroup_count. vkCmdDispatchBase.
  std::array<std::uint32_t, 3> base_workgroup = {0, 0, 0};
  /// Not empty: three uint32 that are read as workgroup_count when the command executes; base_workgroup is zero. The
  /// buffer has the usage indirect, and the offset is a multiple of 4.
  BufferRange indirect_count = {};
};

/// One run of a ray generation shader: size[0] * [1] * [2] invocations.
struct TraceRaysDesc {
  ShaderTableHandle table;
  std::uint32_t ray_generation_record = 0;  ///< position in the table's ray generation records
  std::uint32_t first_miss_record = 0;      ///< the miss record that an index of 0 names
  std::uint32_t first_hit_record = 0;       ///< likewise
  std::uint32_t first_callable_record = 0;
  std::vector<BindGroupHandle> bind_groups;        ///< in any order, one for each set that the pipeline uses
  std::span<const std::byte> push_constants = {};  ///< exactly PipelineInterface::push_constant_size bytes; copied
  std::array<std::uint32_t, 3> size = {1, 1, 1};   ///< a zero makes the trace do nothing
  /// Not empty: three uint32 that are read as the size when the command executes, instead of `size`. The buffer has the
  /// usage indirect, the offset is a multiple of 4, and the device has Capabilities::trace_rays_indirect.
  BufferRange indirect_size;
};

/// Commands recorded to be submitted, once or more often; nothing can be added after the first time. They take effect
/// as if each began after the one before it had ended and its writes were visible: barriers are the backend's business.
/// What a command names is kept alive as long as the list, and until it has executed.
class CommandList {
 public:
  virtual ~CommandList() = default;
  CommandList(const CommandList&) = delete;
  CommandList& operator=(const CommandList&) = delete;

  const std::string& label() const noexcept { return label_; }

  /// Copies `bytes` now and writes them into `buffer` at `offset` when the command executes.
  virtual void upload(const BufferHandle& buffer, std::uint64_t offset, std::span<const std::byte> bytes) = 0;
  /// Ranges of equal size that do not overlap.
  virtual void copy(const BufferRange& source, const BufferRange& destination) = 0;
  /// Writes the 32 bits of `value` over the range; offset and size are multiples of 4.
  virtual void fill(const BufferRange& range, std::uint32_t value) = 0;
  /// All levels, one behind the other as Texture::size_in_bytes says; the range is that large, its offset a multiple of
  /// 16.
  virtual void copy_to_texture(const BufferRange& source, const TextureHandle& destination) = 0;
  virtual void copy_from_texture(const TextureHandle& source, const BufferRange& destination) = 0;

  /// Builds from the desc that the structure was created from, or one with the same geometries, counts and formats over
  /// other buffers.
  virtual void build_bottom_level(const AccelerationStructureHandle& structure, const BottomLevelDesc& desc) = 0;
  /// As build_bottom_level; instance_count may be smaller than at creation.
  virtual void build_top_level(const AccelerationStructureHandle& structure, const TopLevelDesc& desc) = 0;
  /// Refits a built structure to moved vertices, boxes or transforms: desc says what build_bottom_level would, with
  /// the index buffers unchanged and active primitives still active. The structure has BuildFlags::allow_update, and
  /// its address stays the same. A top level that refers to it has to be built or updated after it.
  virtual void update_bottom_level(const AccelerationStructureHandle& structure, const BottomLevelDesc& desc) = 0;
  /// As update_bottom_level, for instances that moved or changed their bottom level, mask or flags; the count stays.
  virtual void update_top_level(const AccelerationStructureHandle& structure, const TopLevelDesc& desc) = 0;

  virtual void dispatch(const DispatchDesc& desc) = 0;
  virtual void trace_rays(const TraceRaysDesc& desc) = 0;

  /// Writes the time at which all commands before this one have ended.
  virtual void write_timestamp(const QueryPoolHandle& pool, std::uint32_t index) = 0;

 protected:
  explicit CommandList(std::string label) : label_(std::move(label)) {}

 private:
  std::string label_;
};

using CommandListHandle = std::shared_ptr<CommandList>;

}  // namespace tandem::rhi
