#pragma once

#include <optional>

#include "rhi/bind_group.hpp"
#include "rhi_vulkan/context.hpp"

namespace tandem::vulkan {

class BindGroup final : public rhi::BindGroup {
 public:
  BindGroup(ContextHandle context, const rhi::BindGroupDesc& desc);

  const ContextHandle& context() const noexcept { return context_; }
  vk::DescriptorSet handle() const { return *set_->handle(); }

 private:
  void write() const;

  ContextHandle context_;
  std::optional<DescriptorSet> set_;
};

}  // namespace tandem::vulkan
