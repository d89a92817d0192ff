#include "rhi/texture.hpp"

namespace tandem::rhi {

std::uint32_t size_of(TextureFormat format) {
  switch (format) {
    case TextureFormat::rgba8_unorm:
    case TextureFormat::rgba8_snorm:
    case TextureFormat::rgba8_uint:
    case TextureFormat::rgba8_sint:
    case TextureFormat::r32_uint:
    case TextureFormat::r32_sint:
    case TextureFormat::r32_float:
      return 4;
    case TextureFormat::rgba16_uint:
    case TextureFormat::rgba16_sint:
    case TextureFormat::rgba16_float:
    case TextureFormat::rg32_uint:
    case TextureFormat::rg32_sint:
    case TextureFormat::rg32_float:
      return 8;
    case TextureFormat::rgba32_uint:
    case TextureFormat::rgba32_sint:
    case TextureFormat::rgba32_float:
      return 16;
  }
  return 0;
}

}  // namespace tandem::rhi
