#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>

#include "rhi/texture_format.hpp"

namespace tandem::rhi {

/// The numbers of VkImageViewType.
enum class TextureDimension : std::uint32_t { d1, d2, d3, cube, d1_array, d2_array, cube_array };

struct TextureDesc {
  TextureDimension dimension = TextureDimension::d2;
  TextureFormat format = TextureFormat::rgba8_unorm;
  /// Width, height, and depth or layers, of which a cube has 6 each; 1 where the dimension has none.
  std::array<std::uint32_t, 3> size = {1, 1, 1};
  std::uint32_t level_count = 1;  ///< mip levels, each half the size of the one before, rounded down, at least 1
  std::string label;
};

/// How many of size[] are sides, which are halved from level to level; the other one is layers.
std::uint32_t side_count(TextureDimension dimension);
/// Whether size[2] is layers.
bool is_layered(TextureDimension dimension);
/// Of a level; size[2] stays where it is layers.
std::array<std::uint32_t, 3> level_size(const TextureDesc& desc, std::uint32_t level);
/// Bytes of a level, tightly packed: x fastest, then y, then z or the layer.
std::uint64_t level_size_in_bytes(const TextureDesc& desc, std::uint32_t level);
/// Where a level begins behind those before it, at a multiple of 4 bytes.
std::uint64_t level_offset(const TextureDesc& desc, std::uint32_t level);
/// The most levels of a texture of this size.
std::uint32_t full_level_count(const TextureDesc& desc);

/// Texels that a shader reads and writes as a storage image, fetches, or samples. Its contents are undefined until
/// written, by CommandList::copy_to_texture or a shader.
class Texture {
 public:
  virtual ~Texture() = default;
  Texture(const Texture&) = delete;
  Texture& operator=(const Texture&) = delete;

  const TextureDesc& desc() const noexcept { return desc_; }
  /// Of all levels, each tightly packed and beginning at level_offset().
  std::uint64_t size_in_bytes() const noexcept;

 protected:
  explicit Texture(TextureDesc desc) : desc_(std::move(desc)) {}

 private:
  TextureDesc desc_;
};

using TextureHandle = std::shared_ptr<Texture>;

}  // namespace tandem::rhi
