#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "rhi/ray_tracing_pipeline.hpp"
#include "rhi_vulkan/pipeline_layout.hpp"

namespace tandem::vulkan {

/// The lists of a pipeline's desc, in the order in which their shader groups follow each other.
enum class GroupKind : std::uint32_t { ray_generation, miss, hit, callable };

class RayTracingPipeline final : public rhi::RayTracingPipeline {
 public:
  RayTracingPipeline(ContextHandle context, const rhi::RayTracingPipelineDesc& desc);

  const ContextHandle& context() const noexcept { return context_; }
  vk::Pipeline handle() const { return *pipeline_; }
  const PipelineLayout& layout() const noexcept { return *layout_; }
  /// The handle that stands at the beginning of a shader record.
  std::span<const std::byte> group_handle(GroupKind kind, std::uint32_t position) const;
  /// What setRayTracingPipelineStackSizeKHR has to be told before a trace; nothing where the driver knows by itself.
  std::optional<std::uint32_t> stack_size() const noexcept { return stack_size_; }

 private:
  std::uint32_t group_index(GroupKind kind, std::uint32_t position) const;
  std::uint32_t needed_stack_size() const;

  ContextHandle context_;
  std::optional<PipelineLayout> layout_;
  vk::raii::Pipeline pipeline_ = nullptr;
  std::vector<std::byte> group_handles_;
  std::optional<std::uint32_t> stack_size_;
};

}  // namespace tandem::vulkan
