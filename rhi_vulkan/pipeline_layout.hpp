#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "rhi/pipeline.hpp"
#include "rhi_vulkan/context.hpp"

namespace tandem::vulkan {

/// What the shaders of a pipeline bind, in Vulkan's terms. Every binding and the push constants are visible to every
/// stage that the device has, so the layouts of two pipelines are compatible wherever their bindings are the same,
/// whatever the pipelines' kinds.
class PipelineLayout {
 public:
  PipelineLayout(const Context& context, const rhi::PipelineInterface& interface);

  vk::PipelineLayout handle() const { return *layout_; }
  bool uses_set(std::uint32_t set) const noexcept { return set < set_layouts_.size(); }
  /// The layout of a set that the shaders use.
  vk::DescriptorSetLayout set_layout(std::uint32_t set) const { return *set_layouts_.at(set); }

 private:
  std::vector<vk::raii::DescriptorSetLayout> set_layouts_;  // by set number; empty ones for sets that are not used
  vk::raii::PipelineLayout layout_ = nullptr;
};

/// The layout of a compute or ray tracing pipeline. Throws rhi::Error(invalid_argument) naming `label` when the
/// pipeline was made by another device.
const PipelineLayout& layout_of(const rhi::PipelineHandle& pipeline, const ContextHandle& context,
                                const std::string& label);

/// Values of specialisation constants in Vulkan's terms. Refers to the values it was made from.
class Specialization {
 public:
  /// @param shaders whose constants have the values; they say how wide each is
  Specialization(std::span<const rhi::SpecializationValue> values, std::span<const rhi::ShaderModuleHandle> shaders);
  Specialization(const Specialization&) = delete;
  Specialization& operator=(const Specialization&) = delete;

  const vk::SpecializationInfo& info() const noexcept { return info_; }

 private:
  std::vector<vk::SpecializationMapEntry> entries_;
  vk::SpecializationInfo info_;
};

}  // namespace tandem::vulkan
