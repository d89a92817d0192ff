#pragma once

#include "rhi/texture.hpp"
#include "rhi_vulkan/vulkan.hpp"

namespace tandem::vulkan {

vk::Format format_of(rhi::TextureFormat format);
vk::ImageAspectFlags aspect_of(rhi::TextureFormat format);
vk::ImageViewType view_type_of(rhi::TextureDimension dimension);
/// What the device does with images in optimal tiling and with buffers of the format.
rhi::FormatSupport support_of(const vk::raii::PhysicalDevice& device, rhi::TextureFormat format);

}  // namespace tandem::vulkan
