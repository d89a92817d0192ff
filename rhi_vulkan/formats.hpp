#pragma once

#include "rhi/texture_format.hpp"
#include "rhi_vulkan/vulkan.hpp"

namespace tandem::vulkan {

vk::Format format_of(rhi::TextureFormat format);

}  // namespace tandem::vulkan
