#include "rhi/texture.hpp"

#include <algorithm>
#include <bit>

namespace tandem::rhi {

std::uint32_t side_count(TextureDimension dimension) {
  switch (dimension) {
    case TextureDimension::d1:
    case TextureDimension::d1_array:
      return 1;
    case TextureDimension::d3:
      return 3;
    default:
      return 2;
  }
}

bool is_layered(TextureDimension dimension) {
  return dimension != TextureDimension::d1 && dimension != TextureDimension::d2 && dimension != TextureDimension::d3;
}

std::array<std::uint32_t, 3> level_size(const TextureDesc& desc, std::uint32_t level) {
  std::array<std::uint32_t, 3> size = desc.size;
  for (std::uint32_t i = 0; i < side_count(desc.dimension); ++i) size[i] = std::max(size[i] >> level, 1u);
  return size;
}

std::uint64_t level_size_in_bytes(const TextureDesc& desc, std::uint32_t level) {
  const std::array<std::uint32_t, 3> size = level_size(desc, level);
  return std::uint64_t{size_of(desc.format)} * size[0] * size[1] * size[2];
}

std::uint32_t full_level_count(const TextureDesc& desc) {
  std::uint32_t largest = 1;
  for (std::uint32_t i = 0; i < side_count(desc.dimension); ++i) largest = std::max(largest, desc.size[i]);
  return static_cast<std::uint32_t>(std::bit_width(largest));
}

std::uint64_t level_offset(const TextureDesc& desc, std::uint32_t level) {
  std::uint64_t offset = 0;
  for (std::uint32_t i = 0; i < level; ++i) offset += (level_size_in_bytes(desc, i) + 3) / 4 * 4;
  return offset;
}

std::uint64_t Texture::size_in_bytes() const noexcept {
  const std::uint32_t last = desc_.level_count - 1;
  return level_offset(desc_, last) + level_size_in_bytes(desc_, last);
}

}  // namespace tandem::rhi
