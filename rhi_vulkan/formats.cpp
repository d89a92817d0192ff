#include "rhi_vulkan/formats.hpp"

#include <cstddef>
#include <iterator>

namespace tandem::vulkan {
namespace {

/// In the order of rhi::TextureFormat.
constexpr vk::Format formats[] = {
    vk::Format::eR8Unorm,
    vk::Format::eR8Snorm,
    vk::Format::eR8Uint,
    vk::Format::eR8Sint,
    vk::Format::eR8G8Unorm,
    vk::Format::eR8G8Snorm,
    vk::Format::eR8G8Uint,
    vk::Format::eR8G8Sint,
    vk::Format::eR8G8B8A8Unorm,
    vk::Format::eR8G8B8A8Snorm,
    vk::Format::eR8G8B8A8Uint,
    vk::Format::eR8G8B8A8Sint,
    vk::Format::eR16Unorm,
    vk::Format::eR16Snorm,
    vk::Format::eR16Uint,
    vk::Format::eR16Sint,
    vk::Format::eR16Sfloat,
    vk::Format::eR16G16Unorm,
    vk::Format::eR16G16Snorm,
    vk::Format::eR16G16Uint,
    vk::Format::eR16G16Sint,
    vk::Format::eR16G16Sfloat,
    vk::Format::eR16G16B16A16Unorm,
    vk::Format::eR16G16B16A16Snorm,
    vk::Format::eR16G16B16A16Uint,
    vk::Format::eR16G16B16A16Sint,
    vk::Format::eR16G16B16A16Sfloat,
    vk::Format::eR32Uint,
    vk::Format::eR32Sint,
    vk::Format::eR32Sfloat,
    vk::Format::eR32G32Uint,
    vk::Format::eR32G32Sint,
    vk::Format::eR32G32Sfloat,
    vk::Format::eR32G32B32A32Uint,
    vk::Format::eR32G32B32A32Sint,
    vk::Format::eR32G32B32A32Sfloat,
    vk::Format::eR64Uint,
    vk::Format::eR64Sint,
    vk::Format::eA2B10G10R10UnormPack32,
    vk::Format::eA2B10G10R10UintPack32,
    vk::Format::eB10G11R11UfloatPack32,
    vk::Format::eR8G8B8A8Srgb,
    vk::Format::eB8G8R8A8Unorm,
    vk::Format::eD16Unorm,
    vk::Format::eD32Sfloat,
};
static_assert(std::size(formats) == rhi::texture_format_count);

}  // namespace

vk::Format format_of(rhi::TextureFormat format) { return formats[static_cast<std::size_t>(format)]; }

vk::ImageAspectFlags aspect_of(rhi::TextureFormat format) {
  const bool is_depth = rhi::info_of(format).kind == rhi::ComponentKind::depth;
  return is_depth ? vk::ImageAspectFlagBits::eDepth : vk::ImageAspectFlagBits::eColor;
}

vk::ImageViewType view_type_of(rhi::TextureDimension dimension) { return static_cast<vk::ImageViewType>(dimension); }

rhi::FormatSupport support_of(const vk::raii::PhysicalDevice& device, rhi::TextureFormat format) {
  using Feature = vk::FormatFeatureFlagBits;
  const vk::FormatProperties properties = device.getFormatProperties(format_of(format));
  const auto images = [&](Feature feature) { return bool(properties.optimalTilingFeatures & feature); };
  const auto buffers = [&](Feature feature) { return bool(properties.bufferFeatures & feature); };
  return {.storage = images(Feature::eStorageImage),
          .storage_atomic = images(Feature::eStorageImageAtomic),
          .sampled = images(Feature::eSampledImage),
          .filtered = images(Feature::eSampledImageFilterLinear),
          .uniform_texel_buffer = buffers(Feature::eUniformTexelBuffer),
          .storage_texel_buffer = buffers(Feature::eStorageTexelBuffer)};
}

}  // namespace tandem::vulkan
