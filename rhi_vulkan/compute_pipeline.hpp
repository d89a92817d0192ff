#pragma once

#include <optional>

#include "rhi/compute_pipeline.hpp"
#include "rhi_vulkan/pipeline_layout.hpp"

namespace tandem::vulkan {

class ComputePipeline final : public rhi::ComputePipeline {
 public:
  ComputePipeline(ContextHandle context, const rhi::ComputePipelineDesc& desc);

  const ContextHandle& context() const noexcept { return context_; }
  vk::Pipeline handle() const { return *pipeline_; }
  const PipelineLayout& layout() const noexcept { return *layout_; }

 private:
  ContextHandle context_;
  std::optional<PipelineLayout> layout_;
  vk::raii::Pipeline pipeline_ = nullptr;
};

}  // namespace tandem::vulkan
