#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace tandem::rhi {

/// How texels are stored, named as Vulkan's formats are: components with their bits, then how a number becomes bits.
/// The first of the components lies in the lowest bits. Which of them a device takes for what, DeviceInfo::formats
/// says.
enum class TextureFormat : std::uint32_t {
  r8_unorm,
  r8_snorm,
  r8_uint,
  r8_sint,
  rg8_unorm,
  rg8_snorm,
  rg8_uint,
  rg8_sint,
  rgba8_unorm,
  rgba8_snorm,
  rgba8_uint,
  rgba8_sint,
  r16_unorm,
  r16_snorm,
  r16_uint,
  r16_sint,
  r16_float,
  rg16_unorm,
  rg16_snorm,
  rg16_uint,
  rg16_sint,
  rg16_float,
  rgba16_unorm,
  rgba16_snorm,
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
  rgba32_float,
  r64_uint,
  r64_sint,
  rgb10a2_unorm,
  rgb10a2_uint,
  rg11b10_float,
  rgba8_srgb,
  bgra8_unorm,
  d16_unorm,
  d32_float,
};

inline constexpr std::size_t texture_format_count = static_cast<std::size_t>(TextureFormat::d32_float) + 1;

/// What a shader reads of a texel.
enum class ComponentKind : std::uint8_t { unorm, snorm, uint, sint, floating, depth };

struct TextureFormatInfo {
  TextureFormat format;
  std::string_view name;     ///< "rgba8_unorm"
  std::uint32_t size;        ///< bytes of a texel
  std::uint32_t components;  ///< 1 to 4
  ComponentKind kind;
};

const TextureFormatInfo& info_of(TextureFormat format);

/// Bytes of one texel.
inline std::uint32_t size_of(TextureFormat format) { return info_of(format).size; }

/// Uses of a texture that a device may lack for a format.
struct FormatSupport {
  bool storage = false;         ///< storage images
  bool storage_atomic = false;  ///< atomic operations on them
  bool sampled = false;         ///< sampled images
  bool filtered = false;        ///< linear filters
  bool uniform_texel_buffer = false;
  bool storage_texel_buffer = false;
};

}  // namespace tandem::rhi
