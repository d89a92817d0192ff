#include "rhi_vulkan/texture.hpp"

#include <algorithm>
#include <utility>

#include "rhi_vulkan/command_buffer.hpp"
#include "rhi_vulkan/formats.hpp"

namespace tandem::vulkan {
namespace {

/// All that the device does with the format.
vk::ImageUsageFlags usage_of(const rhi::FormatSupport& support) {
  vk::ImageUsageFlags usage = vk::ImageUsageFlagBits::eTransferSrc | vk::ImageUsageFlagBits::eTransferDst;
  if (support.storage) usage |= vk::ImageUsageFlagBits::eStorage;
  if (support.sampled) usage |= vk::ImageUsageFlagBits::eSampled;
  return usage;
}

vk::ImageType type_of(rhi::TextureDimension dimension) {
  switch (dimension) {
    case rhi::TextureDimension::d1:
    case rhi::TextureDimension::d1_array:
      return vk::ImageType::e1D;
    case rhi::TextureDimension::d3:
      return vk::ImageType::e3D;
    default:
      return vk::ImageType::e2D;
  }
}

std::uint32_t layers_of(const rhi::TextureDesc& desc) { return rhi::is_layered(desc.dimension) ? desc.size[2] : 1; }

vk::Extent3D extent_of(const rhi::TextureDesc& desc, std::uint32_t level) {
  const std::array<std::uint32_t, 3> size = rhi::level_size(desc, level);
  return {.width = size[0], .height = size[1], .depth = desc.dimension == rhi::TextureDimension::d3 ? size[2] : 1};
}

/// What views of the texture need.
vk::ImageCreateFlags flags_of(const rhi::TextureDesc& desc) {
  const bool has_faces = rhi::side_count(desc.dimension) == 2 && desc.size[0] == desc.size[1] && layers_of(desc) >= 6;
  return has_faces ? vk::ImageCreateFlagBits::eCubeCompatible : vk::ImageCreateFlags();
}

vk::ImageSubresourceRange all_of(const rhi::TextureDesc& desc) {
  return {.aspectMask = aspect_of(desc.format), .levelCount = desc.level_count, .layerCount = layers_of(desc)};
}

}  // namespace

Texture::Texture(ContextHandle context, const rhi::TextureDesc& desc)
    : rhi::Texture(desc), context_(std::move(context)) {
  translating_errors(desc.label, "create the texture", [&] {
    image_ = make_image();
    // Nobody waits: what uses the texture is submitted later, and begins with a barrier.
    submit_commands(*context_, desc.label, image_, [&](const vk::raii::CommandBuffer& commands) {
      change_layout(commands, vk::ImageLayout::eUndefined, vk::ImageLayout::eGeneral);
    });
  });
}

std::shared_ptr<Texture::BackedImage> Texture::make_image() const {
  const vk::Format format = format_of(desc().format);
  const vk::ImageType type = type_of(desc().dimension);
  const vk::ImageCreateFlags flags = flags_of(desc());
  const vk::ImageUsageFlags usage = usage_of(context_->physical.info.formats[static_cast<std::size_t>(desc().format)]);
  // Throws where the driver's limit for this format is lower than the device's for all.
  const vk::ImageFormatProperties limits =
      context_->physical.handle.getImageFormatProperties(format, type, vk::ImageTiling::eOptimal, usage, flags);
  if (size_in_bytes() > limits.maxResourceSize)
    throw rhi::Error(rhi::ErrorCode::out_of_memory, desc().label,
                     std::to_string(size_in_bytes()) + " bytes are more than the " +
                         std::to_string(limits.maxResourceSize) + " that the driver gives a texture");
  const auto image = std::make_shared<BackedImage>();
  image->handle = context_->device.createImage({.flags = flags,
                                                .imageType = type,
                                                .format = format,
                                                .extent = extent_of(desc(), 0),
                                                .mipLevels = desc().level_count,
                                                .arrayLayers = layers_of(desc()),
                                                .samples = vk::SampleCountFlagBits::e1,
                                                .tiling = vk::ImageTiling::eOptimal,
                                                .usage = usage});
  context_->name(image->handle, desc().label);
  vk::MemoryRequirements requirements = image->handle.getMemoryRequirements();
  // Whole pages of it, so that no buffer shares one.
  const std::uint64_t page = context_->physical.buffer_image_granularity;
  requirements.alignment = std::max(requirements.alignment, page);
  requirements.size = (requirements.size + page - 1) / page * page;
  image->memory = allocate(*context_, requirements, MemoryKind::device, desc().label);
  image->handle.bindMemory(image->memory.memory(), image->memory.offset());
  return image;
}

void Texture::change_layout(const vk::raii::CommandBuffer& commands, vk::ImageLayout from, vk::ImageLayout to) const {
  const vk::ImageMemoryBarrier barrier = {
      .srcAccessMask = vk::AccessFlagBits::eMemoryRead | vk::AccessFlagBits::eMemoryWrite,
      .dstAccessMask = vk::AccessFlagBits::eMemoryRead | vk::AccessFlagBits::eMemoryWrite,
      .oldLayout = from,
      .newLayout = to,
      .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
      .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
      .image = handle(),
      .subresourceRange = all_of(desc())};
  commands.pipelineBarrier(vk::PipelineStageFlagBits::eAllCommands, vk::PipelineStageFlagBits::eAllCommands, {},
                           nullptr, nullptr, barrier);
}

std::vector<vk::BufferImageCopy> Texture::whole(std::uint64_t offset) const {
  std::vector<vk::BufferImageCopy> copies;
  for (std::uint32_t level = 0; level < desc().level_count; ++level)
    copies.push_back({.bufferOffset = offset + rhi::level_offset(desc(), level),
                      .imageSubresource = {.aspectMask = aspect_of(desc().format),
                                           .mipLevel = level,
                                           .layerCount = layers_of(desc())},
                      .imageExtent = extent_of(desc(), level)});
  return copies;
}

}  // namespace tandem::vulkan
