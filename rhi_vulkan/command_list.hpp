#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "rhi/command_list.hpp"
#include "rhi_vulkan/acceleration_structure.hpp"
#include "rhi_vulkan/command_buffer.hpp"
#include "rhi_vulkan/dependency_tracker.hpp"
#include "rhi_vulkan/pipeline_layout.hpp"
#include "rhi_vulkan/query_pool.hpp"
#include "rhi_vulkan/texture.hpp"
#include "rhi_vulkan/transient_memory.hpp"

namespace tandem::vulkan {

class CommandList final : public rhi::CommandList {
 public:
  CommandList(ContextHandle context, std::string label);

  void upload(const rhi::BufferHandle& buffer, std::uint64_t offset, std::span<const std::byte> bytes) override;
  void copy(const rhi::BufferRange& source, const rhi::BufferRange& destination) override;
  void fill(const rhi::BufferRange& range, std::uint32_t value) override;
  void build_bottom_level(const rhi::AccelerationStructureHandle& structure, const rhi::BottomLevelDesc& desc) override;
  void build_top_level(const rhi::AccelerationStructureHandle& structure, const rhi::TopLevelDesc& desc) override;
  void update_bottom_level(const rhi::AccelerationStructureHandle& structure,
                           const rhi::BottomLevelDesc& desc) override;
  void update_top_level(const rhi::AccelerationStructureHandle& structure, const rhi::TopLevelDesc& desc) override;
  void copy_to_texture(const rhi::BufferRange& source, const rhi::TextureHandle& destination) override;
  void copy_from_texture(const rhi::TextureHandle& source, const rhi::BufferRange& destination) override;
  void dispatch(const rhi::DispatchDesc& desc) override;
  void trace_rays(const rhi::TraceRaysDesc& desc) override;
  void write_timestamp(const rhi::QueryPoolHandle& pool, std::uint32_t index) override;

  const ContextHandle& context() const noexcept { return context_; }
  /// Ends the recording the first time, submits it and returns the submission's number.
  std::uint64_t submit();

 private:
  /// What the device needs until the commands have executed.
  struct Recording {
    explicit Recording(CommandBuffer command_buffer);

    CommandBuffer commands;
    TransientMemory staging;
    TransientMemory scratch;
    std::vector<std::shared_ptr<const void>> resources;
    bool ended = false;  ///< by the first submission
  };

  struct StructureUse {
    enum class Kind { build, update, trace };
    Kind kind;
    std::shared_ptr<AccelerationStructure> structure;
    std::uint32_t instance_count;  ///< of the build or update of a top level
    std::string pipeline;          ///< label of the one that traces
  };

  /// Throws rhi::Error(invalid_argument) once the list was submitted.
  Recording& recording();
  /// A barrier where the command that follows needs one.
  void order(CommandKind kind, std::span<const Access> accesses);
  template <typename Copy>
  void copy_texture(const rhi::BufferRange& range, const rhi::TextureHandle& handle, vk::ImageLayout layout,
                    Copy&& copy);
  /// @param label the pipeline's
  void bind(vk::PipelineBindPoint point, vk::Pipeline pipeline, const PipelineLayout& layout, const std::string& label,
            std::span<const rhi::BindGroupHandle> bind_groups, std::span<const std::byte> push_constants);
  void note_traced(const rhi::BindGroup& group, const std::string& pipeline);
  /// Throws rhi::Error(invalid_argument) for a rule that they break. What the list builds, with the instances.
  std::map<AccelerationStructure*, std::uint32_t> check_structure_uses() const;
  template <typename Desc>
  void build(const rhi::AccelerationStructureHandle& handle, const Desc& desc,
             vk::BuildAccelerationStructureModeKHR mode);

  ContextHandle context_;
  std::shared_ptr<Recording> recording_;
  DependencyTracker dependencies_;
  std::vector<std::pair<std::shared_ptr<QueryPool>, std::uint32_t>> timestamps_;
  std::vector<StructureUse> structure_uses_;  // checked on submission: only then is it known what was built before
};

}  // namespace tandem::vulkan
