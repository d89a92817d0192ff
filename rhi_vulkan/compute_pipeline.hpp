#pragma once

#include <vector>

#include "rhi/compute_pipeline.hpp"
#include "rhi_vulkan/context.hpp"

namespace tandem::vulkan {

class ComputePipeline final : public rhi::ComputePipeline {
 public:
  ComputePipeline(ContextHandle context, const rhi::ComputePipelineDesc& desc);

  const ContextHandle& context() const noexcept { return context_; }
  vk::Pipeline handle() const { return *pipeline_; }
  vk::PipelineLayout layout() const { return *layout_; }
  bool uses_set(std::uint32_t set) const noexcept { return set < set_layouts_.size(); }
  /// The layout of a set that the shader uses.
  vk::DescriptorSetLayout set_layout(std::uint32_t set) const { return *set_layouts_.at(set); }

 private:
  ContextHandle context_;
  std::vector<vk::raii::DescriptorSetLayout> set_layouts_;  // by set number; empty ones for sets that are not used
  vk::raii::PipelineLayout layout_ = nullptr;
  vk::raii::Pipeline pipeline_ = nullptr;
};

/// The Vulkan type of a binding that a bind group can hold.
vk::DescriptorType descriptor_type(rhi::BindingKind kind);

}  // namespace tandem::vulkan
