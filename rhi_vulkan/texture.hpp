#pragma once

#include <memory>
#include <vector>

#include "rhi/texture.hpp"
#include "rhi_vulkan/buffer.hpp"

namespace tandem::vulkan {

/// An image in the layout eGeneral from its creation on, but while it is copied.
class Texture final : public rhi::Texture {
 public:
  Texture(ContextHandle context, const rhi::TextureDesc& desc);

  const ContextHandle& context() const noexcept { return context_; }
  vk::Image handle() const { return *image_->handle; }
  /// With everything before finished and visible to everything after.
  void change_layout(const vk::raii::CommandBuffer& commands, vk::ImageLayout from, vk::ImageLayout to) const;
  /// All levels, in a buffer from `offset` on as rhi::level_offset says.
  std::vector<vk::BufferImageCopy> whole(std::uint64_t offset) const;

 private:
  struct BackedImage {
    MemoryAllocation memory;
    vk::raii::Image handle = nullptr;  // destroyed before its memory
  };

  std::shared_ptr<BackedImage> make_image() const;

  ContextHandle context_;
  std::shared_ptr<BackedImage> image_;  // shared with the submission that changes its layout
};

}  // namespace tandem::vulkan
