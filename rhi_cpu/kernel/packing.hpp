#pragma once

#include <bit>
#include <cstdint>

#include "rhi_cpu/kernel/half_conversion.hpp"
#include "rhi_cpu/kernel/math.hpp"
#include "rhi_cpu/kernel/types.hpp"

/// GLSL's packing functions. The first component goes to the lowest bits.
namespace tandem::kernel {

template <int length>
inline std::uint32_t pack_normalized(const glm::vec<length, float>& v, float low, float scale) {
  constexpr int bits = 32 / length;
  std::uint32_t packed = 0;
  for (int i = 0; i < length; ++i) {
    const auto whole = static_cast<std::int32_t>(kernel::round_even(kernel::clamp(v[i], low, 1.0f) * scale));
    packed |= (static_cast<std::uint32_t>(whole) & (0xffffffffu >> (32 - bits))) << (bits * i);
  }
  return packed;
}

template <int length>
inline glm::vec<length, float> unpack_unsigned(std::uint32_t packed, float scale) {
  constexpr int bits = 32 / length;
  glm::vec<length, float> v;
  for (int i = 0; i < length; ++i)
    v[i] = static_cast<float>((packed >> (bits * i)) & (0xffffffffu >> (32 - bits))) / scale;
  return v;
}

template <int length>
inline glm::vec<length, float> unpack_signed(std::uint32_t packed, float scale) {
  constexpr int bits = 32 / length;
  glm::vec<length, float> v;
  for (int i = 0; i < length; ++i) {
    const std::int32_t whole = static_cast<std::int32_t>(packed << (32 - bits * (i + 1))) >> (32 - bits);
    v[i] = kernel::clamp(static_cast<float>(whole) / scale, -1.0f, 1.0f);
  }
  return v;
}

inline std::uint32_t pack_unorm_4x8(const vec4& v) { return pack_normalized(v, 0.0f, 255.0f); }
inline std::uint32_t pack_snorm_4x8(const vec4& v) { return pack_normalized(v, -1.0f, 127.0f); }
inline std::uint32_t pack_unorm_2x16(const vec2& v) { return pack_normalized(v, 0.0f, 65535.0f); }
inline std::uint32_t pack_snorm_2x16(const vec2& v) { return pack_normalized(v, -1.0f, 32767.0f); }
inline vec4 unpack_unorm_4x8(std::uint32_t p) { return unpack_unsigned<4>(p, 255.0f); }
inline vec4 unpack_snorm_4x8(std::uint32_t p) { return unpack_signed<4>(p, 127.0f); }
inline vec2 unpack_unorm_2x16(std::uint32_t p) { return unpack_unsigned<2>(p, 65535.0f); }
inline vec2 unpack_snorm_2x16(std::uint32_t p) { return unpack_signed<2>(p, 32767.0f); }

inline std::uint32_t pack_half_2x16(const vec2& v) { return float_to_half(v.x) | (float_to_half(v.y) << 16); }
inline vec2 unpack_half_2x16(std::uint32_t p) { return {half_to_float(p & 0xffffu), half_to_float(p >> 16)}; }

/// The nearest float that is a normal half, an infinity or, below those, zero.
template <typename T>
inline T quantize_to_half(const T& a) {
  constexpr float smallest_normal = 6.103515625e-05f;
  return each(
      [](float x) { return std::fabs(x) < smallest_normal ? std::copysign(0.0f, x) : half_to_float(float_to_half(x)); },
      a);
}

inline double pack_double_2x32(const uvec2& v) {
  return std::bit_cast<double>(std::uint64_t{v.x} | (std::uint64_t{v.y} << 32));
}
inline uvec2 unpack_double_2x32(double d) {
  const auto bits = std::bit_cast<std::uint64_t>(d);
  return {static_cast<std::uint32_t>(bits), static_cast<std::uint32_t>(bits >> 32)};
}

}  // namespace tandem::kernel
