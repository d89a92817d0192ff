#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <utility>

#include "rhi_cpu/kernel/memory.hpp"
#include "rhi_cpu/kernel/packing.hpp"
#include "rhi_cpu/kernel/srgb.hpp"
#include "rhi_cpu/kernel/types.hpp"

/// Bits of texels and the numbers that shaders read and write. Conversions are those of Vulkan's "Fixed-Point Data
/// Conversions", rounded to the nearest, halves to even; integers that do not fit keep their low bits.
namespace tandem::kernel {

/// rhi::TextureFormat, and what a shader says that names none.
enum class TexelFormat : std::uint32_t {
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
  of_the_image  ///< Image::format decides, when the shader runs
};

inline constexpr std::uint32_t texel_format_count = static_cast<std::uint32_t>(TexelFormat::of_the_image);

/// How bits become numbers. The last ones are not components of one width, one after the other.
enum class Coding : std::uint8_t {
  unorm,
  snorm,
  uint,
  sint,
  floating,
  srgb,
  bgra_unorm,
  rgb10a2_unorm,
  rgb10a2_uint,
  rg11b10_float
};

struct TexelLayout {
  Coding coding;
  std::uint8_t bytes;
  std::uint8_t components;
};

/// Of each TexelFormat.
inline constexpr TexelLayout texel_layouts[] = {
    {Coding::unorm, 1, 1},          // r8_unorm
    {Coding::snorm, 1, 1},          // r8_snorm
    {Coding::uint, 1, 1},           // r8_uint
    {Coding::sint, 1, 1},           // r8_sint
    {Coding::unorm, 2, 2},          // rg8_unorm
    {Coding::snorm, 2, 2},          // rg8_snorm
    {Coding::uint, 2, 2},           // rg8_uint
    {Coding::sint, 2, 2},           // rg8_sint
    {Coding::unorm, 4, 4},          // rgba8_unorm
    {Coding::snorm, 4, 4},          // rgba8_snorm
    {Coding::uint, 4, 4},           // rgba8_uint
    {Coding::sint, 4, 4},           // rgba8_sint
    {Coding::unorm, 2, 1},          // r16_unorm
    {Coding::snorm, 2, 1},          // r16_snorm
    {Coding::uint, 2, 1},           // r16_uint
    {Coding::sint, 2, 1},           // r16_sint
    {Coding::floating, 2, 1},       // r16_float
    {Coding::unorm, 4, 2},          // rg16_unorm
    {Coding::snorm, 4, 2},          // rg16_snorm
    {Coding::uint, 4, 2},           // rg16_uint
    {Coding::sint, 4, 2},           // rg16_sint
    {Coding::floating, 4, 2},       // rg16_float
    {Coding::unorm, 8, 4},          // rgba16_unorm
    {Coding::snorm, 8, 4},          // rgba16_snorm
    {Coding::uint, 8, 4},           // rgba16_uint
    {Coding::sint, 8, 4},           // rgba16_sint
    {Coding::floating, 8, 4},       // rgba16_float
    {Coding::uint, 4, 1},           // r32_uint
    {Coding::sint, 4, 1},           // r32_sint
    {Coding::floating, 4, 1},       // r32_float
    {Coding::uint, 8, 2},           // rg32_uint
    {Coding::sint, 8, 2},           // rg32_sint
    {Coding::floating, 8, 2},       // rg32_float
    {Coding::uint, 16, 4},          // rgba32_uint
    {Coding::sint, 16, 4},          // rgba32_sint
    {Coding::floating, 16, 4},      // rgba32_float
    {Coding::uint, 8, 1},           // r64_uint
    {Coding::sint, 8, 1},           // r64_sint
    {Coding::rgb10a2_unorm, 4, 4},  // rgb10a2_unorm
    {Coding::rgb10a2_uint, 4, 4},   // rgb10a2_uint
    {Coding::rg11b10_float, 4, 3},  // rg11b10_float
    {Coding::srgb, 4, 4},           // rgba8_srgb
    {Coding::bgra_unorm, 4, 4},     // bgra8_unorm
    {Coding::unorm, 2, 1},          // d16_unorm
    {Coding::floating, 4, 1},       // d32_float
};
static_assert(sizeof(texel_layouts) / sizeof(TexelLayout) == texel_format_count);

constexpr const TexelLayout& layout_of(TexelFormat format) { return texel_layouts[static_cast<std::uint32_t>(format)]; }

constexpr bool holds_integers(Coding coding) {
  return coding == Coding::uint || coding == Coding::sint || coding == Coding::rgb10a2_uint;
}

template <std::size_t bytes, bool is_signed>
struct IntegerOf;
template <>
struct IntegerOf<1, false> {
  using type = std::uint8_t;
};
template <>
struct IntegerOf<1, true> {
  using type = std::int8_t;
};
template <>
struct IntegerOf<2, false> {
  using type = std::uint16_t;
};
template <>
struct IntegerOf<2, true> {
  using type = std::int16_t;
};
template <>
struct IntegerOf<4, false> {
  using type = std::uint32_t;
};
template <>
struct IntegerOf<4, true> {
  using type = std::int32_t;
};
template <>
struct IntegerOf<8, false> {
  using type = std::uint64_t;
};
template <>
struct IntegerOf<8, true> {
  using type = std::int64_t;
};

/// What a component is stored as, of a layout whose components are alike.
template <TexelFormat format>
using stored_t =
    typename IntegerOf<layout_of(format).bytes / layout_of(format).components,
                       layout_of(format).coding == Coding::snorm || layout_of(format).coding == Coding::sint>::type;

/// The largest code of `bits` bits.
constexpr float unorm_scale(int bits) { return static_cast<float>((1u << bits) - 1u); }

inline std::uint32_t float_to_unorm(float value, float scale) {
  return static_cast<std::uint32_t>(kernel::round_even(kernel::clamp(value, 0.0f, 1.0f) * scale));
}

/// A component of one of the codings that have equal components.
template <Coding coding, typename Stored>
inline float decode_float(Stored stored) {
  constexpr int bits = 8 * sizeof(Stored);
  if constexpr (coding == Coding::unorm)
    return static_cast<float>(stored) / unorm_scale(bits);
  else if constexpr (coding == Coding::snorm)
    return kernel::clamp(static_cast<float>(stored) / unorm_scale(bits - 1), -1.0f, 1.0f);
  else if constexpr (bits == 16)
    return half_to_float(stored);
  else
    return std::bit_cast<float>(stored);
}

template <Coding coding, typename Stored>
inline Stored encode_float(float value) {
  constexpr int bits = 8 * sizeof(Stored);
  if constexpr (coding == Coding::unorm)
    return static_cast<Stored>(float_to_unorm(value, unorm_scale(bits)));
  else if constexpr (coding == Coding::snorm)
    return static_cast<Stored>(kernel::round_even(kernel::clamp(value, -1.0f, 1.0f) * unorm_scale(bits - 1)));
  else if constexpr (bits == 16)
    return static_cast<Stored>(float_to_half(value));
  else
    return std::bit_cast<Stored>(value);
}

/// Without a sign, with 5 bits of exponent and `fraction_bits` below them: the components of rg11b10_float.
template <int fraction_bits>
inline float small_float_to_float(std::uint32_t bits) {
  return half_to_float((bits & ((32u << fraction_bits) - 1u)) << (10 - fraction_bits));
}

/// Rounded towards zero, as Vulkan allows and lavapipe does. What is negative becomes 0, what is too large the largest
/// finite number.
template <int fraction_bits>
inline std::uint32_t float_to_small_float(float value) {
  constexpr std::uint32_t infinity = 31u << fraction_bits;
  const auto bits = std::bit_cast<std::uint32_t>(value);
  if (value != value) return infinity | (1u << (fraction_bits - 1));
  if (!(value > 0.0f)) return 0u;
  if (bits == 0x7f800000u) return infinity;
  if (bits < 0x38800000u) return static_cast<std::uint32_t>(value * static_cast<float>(1 << (14 + fraction_bits)));
  return kernel::min((bits - 0x38000000u) >> (23 - fraction_bits), infinity - 1u);
}

inline vec4 decode_packed(Coding coding, std::uint32_t texel) {
  switch (coding) {
    case Coding::srgb:
      return {srgb_to_linear[texel & 255u], srgb_to_linear[(texel >> 8) & 255u], srgb_to_linear[(texel >> 16) & 255u],
              static_cast<float>(texel >> 24) / 255.0f};
    case Coding::bgra_unorm: {
      const vec4 bgra = unpack_unorm_4x8(texel);
      return {bgra.z, bgra.y, bgra.x, bgra.w};
    }
    case Coding::rgb10a2_unorm:
      return {static_cast<float>(texel & 1023u) / 1023.0f, static_cast<float>((texel >> 10) & 1023u) / 1023.0f,
              static_cast<float>((texel >> 20) & 1023u) / 1023.0f, static_cast<float>(texel >> 30) / 3.0f};
    default:
      return {small_float_to_float<6>(texel), small_float_to_float<6>(texel >> 11),
              small_float_to_float<5>(texel >> 22), 1.0f};
  }
}

inline std::uint32_t encode_packed(Coding coding, const vec4& value) {
  switch (coding) {
    case Coding::srgb:
      return pack_unorm_4x8({linear_to_srgb(value.x), linear_to_srgb(value.y), linear_to_srgb(value.z), value.w});
    case Coding::bgra_unorm:
      return pack_unorm_4x8({value.z, value.y, value.x, value.w});
    case Coding::rgb10a2_unorm:
      return float_to_unorm(value.x, 1023.0f) | float_to_unorm(value.y, 1023.0f) << 10 |
             float_to_unorm(value.z, 1023.0f) << 20 | float_to_unorm(value.w, 3.0f) << 30;
    default:
      return float_to_small_float<6>(value.x) | float_to_small_float<6>(value.y) << 11 |
             float_to_small_float<5>(value.z) << 22;
  }
}

/// A texel as components of type C: float, or an integer for a format of integers. What the format lacks is 0, alpha 1.
/// All is 0 for a format of another kind.
template <typename C, TexelFormat format>
inline glm::vec<4, C> decode(const std::byte* texel) {
  constexpr TexelLayout layout = layout_of(format);
  glm::vec<4, C> value(C(0), C(0), C(0), C(1));
  if constexpr (holds_integers(layout.coding) == std::is_floating_point_v<C>) {
    value.w = C(0);
  } else if constexpr (layout.coding == Coding::rgb10a2_uint) {
    const auto bits = load<std::uint32_t>(texel);
    for (int i = 0; i < 4; ++i) value[i] = static_cast<C>((bits >> (10 * i)) & (i < 3 ? 1023u : 3u));
  } else if constexpr (layout.coding > Coding::floating) {
    value = decode_packed(layout.coding, load<std::uint32_t>(texel));
  } else {
    using Stored = stored_t<format>;
    for (int i = 0; i < layout.components; ++i) {
      const Stored stored = load<Stored>(texel + static_cast<std::size_t>(i) * sizeof(Stored));
      if constexpr (std::is_floating_point_v<C>)
        value[i] = decode_float<layout.coding>(stored);
      else
        value[i] = static_cast<C>(stored);
    }
  }
  return value;
}

/// The other way; does nothing for a format of another kind.
template <typename C, TexelFormat format>
inline void encode(std::byte* texel, const glm::vec<4, C>& value) {
  constexpr TexelLayout layout = layout_of(format);
  if constexpr (holds_integers(layout.coding) == std::is_floating_point_v<C>) {
    return;
  } else if constexpr (layout.coding == Coding::rgb10a2_uint) {
    std::uint32_t bits = 0;
    for (int i = 0; i < 4; ++i) bits |= (static_cast<std::uint32_t>(value[i]) & (i < 3 ? 1023u : 3u)) << (10 * i);
    store(texel, bits);
  } else if constexpr (layout.coding > Coding::floating) {
    store(texel, encode_packed(layout.coding, value));
  } else {
    using Stored = stored_t<format>;
    for (int i = 0; i < layout.components; ++i) {
      Stored stored;
      if constexpr (std::is_floating_point_v<C>)
        stored = encode_float<layout.coding, Stored>(value[i]);
      else
        stored = static_cast<Stored>(value[i]);
      store(texel + static_cast<std::size_t>(i) * sizeof(Stored), stored);
    }
  }
}

template <typename C>
using Decoder = glm::vec<4, C> (*)(const std::byte* texel);
template <typename C>
using Encoder = void (*)(std::byte* texel, const glm::vec<4, C>& value);

template <typename C, std::size_t... formats>
constexpr std::array<Decoder<C>, texel_format_count> all_decoders(std::index_sequence<formats...>) {
  return {decode<C, static_cast<TexelFormat>(formats)>...};
}
template <typename C, std::size_t... formats>
constexpr std::array<Encoder<C>, texel_format_count> all_encoders(std::index_sequence<formats...>) {
  return {encode<C, static_cast<TexelFormat>(formats)>...};
}

/// By number of the format, for a format that is known when the shader runs.
template <typename C>
inline constexpr auto decoders = all_decoders<C>(std::make_index_sequence<texel_format_count>());
template <typename C>
inline constexpr auto encoders = all_encoders<C>(std::make_index_sequence<texel_format_count>());

}  // namespace tandem::kernel
