#include "rhi_cpu/texture.hpp"

#include <utility>

namespace tandem::cpu {
namespace {

kernel::Image image_of(const rhi::TextureDesc& desc, std::byte* texels) {
  kernel::Image image = {.texels = texels,
                         .size = {desc.size[0], desc.size[1], desc.size[2]},
                         .format = static_cast<std::uint32_t>(desc.format),
                         .sides = rhi::side_count(desc.dimension),
                         .level_count = desc.level_count};
  if (desc.dimension == rhi::TextureDimension::d1_array) std::swap(image.size[1], image.size[2]);
  for (std::uint32_t level = 0; level < desc.level_count; ++level)
    image.level_offsets[level] = rhi::level_offset(desc, level);
  return image;
}

}  // namespace

Texture::Texture(DeviceStateHandle device, const rhi::TextureDesc& desc)
    : rhi::Texture(desc),
      device_(std::move(device)),
      memory_(allocate_host_memory(size_in_bytes(), desc.label, "a texture")),
      image_(image_of(desc, memory_.get())) {}

}  // namespace tandem::cpu
