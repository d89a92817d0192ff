#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>

namespace tandem::rhi {

enum class TextureDimension : std::uint32_t { d1, d2, d3, d2_array };

/// The formats that every Vulkan device can use for storage images.
enum class TextureFormat : std::uint32_t {
  rgba8_unorm,
  rgba8_snorm,
  rgba8_uint,
  rgba8_sint,
  rgba16_uint,
  rgba16_sint,
  rgba16_float,
  r32_uint,
  r32_sint,
  r32_float,
  rg32_uint,
  rg32_sint,
  rg32_float,
  rgba32_uint,
  rgba32_sint,
  rgba32_float
};

/// Bytes of one texel.
std::uint32_t size_of(TextureFormat format);

struct TextureDesc {
  TextureDimension dimension = TextureDimension::d2;
  TextureFormat format = TextureFormat::rgba8_unorm;
  std::array<std::uint32_t, 3> size = {1, 1, 1};  ///< width, height, depth or layers; 1 where the dimension has none
  std::string label;
};

/// Texels that a shader reads and writes as a storage image (image1D, image2D, image3D, image2DArray). Its contents are
/// undefined until written, by CommandList::copy_to_texture or a shader. No samplers: what the path tracer filters, it
/// filters itself, so that every backend agrees.
class Texture {
 public:
  virtual ~Texture() = default;
  Texture(const Texture&) = delete;
  Texture& operator=(const Texture&) = delete;

  const TextureDesc& desc() const noexcept { return desc_; }
  /// Of all texels, tightly packed: x fastest, then y, then z or the layer.
  std::uint64_t size_in_bytes() const noexcept {
    return std::uint64_t{size_of(desc_.format)} * desc_.size[0] * desc_.size[1] * desc_.size[2];
  }

 protected:
  explicit Texture(TextureDesc desc) : desc_(std::move(desc)) {}

 private:
  TextureDesc desc_;
};

using TextureHandle = std::shared_ptr<Texture>;

}  // namespace tandem::rhi
