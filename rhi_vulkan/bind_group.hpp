#pragma once

#include <optional>
#include <vector>

#include "rhi/bind_group.hpp"
#include "rhi/texture_view.hpp"
#include "rhi_vulkan/context.hpp"

namespace tandem::vulkan {

class BindGroup final : public rhi::BindGroup {
 public:
  BindGroup(ContextHandle context, const rhi::BindGroupDesc& desc);

  const ContextHandle& context() const noexcept { return context_; }
  vk::DescriptorSet handle() const { return *set_->handle(); }

 private:
  void write();
  vk::DescriptorImageInfo image_info(const rhi::BoundResource& resource, rhi::BindingKind kind);
  vk::ImageView make_view(const rhi::ResolvedView& view);
  vk::BufferView make_view(const rhi::TexelBuffer& texels);

  ContextHandle context_;
  std::vector<vk::raii::ImageView> image_views_;
  std::vector<vk::raii::BufferView> buffer_views_;
  std::optional<DescriptorSet> set_;
};

}  // namespace tandem::vulkan
