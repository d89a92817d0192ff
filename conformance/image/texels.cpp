#include "conformance/image/texels.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace tandem::conformance {
namespace {

using rhi::ComponentKind;
using rhi::TextureFormat;

std::array<int, 4> bits_of(TextureFormat format) {
  if (format == TextureFormat::rgb10a2_unorm || format == TextureFormat::rgb10a2_uint) return {10, 10, 10, 2};
  if (format == TextureFormat::rg11b10_float) return {11, 11, 10, 0};
  const rhi::TextureFormatInfo& info = rhi::info_of(format);
  std::array<int, 4> bits = {};
  for (std::uint32_t i = 0; i < info.components; ++i) bits[i] = static_cast<int>(info.size * 8 / info.components);
  return bits;
}

/// A float of 10, 11, 16 or 32 bits. The small ones have five bits of exponent, and those of 10 and 11 no sign.
std::uint64_t float_bits(double value, int bits) {
  if (bits == 32) return std::bit_cast<std::uint32_t>(static_cast<float>(value));
  const int mantissa_bits = bits == 16 ? 10 : bits - 5;
  if (value == 0) return 0;
  int exponent = 0;
  const double mantissa = std::frexp(std::abs(value), &exponent);  // in [0.5, 1)
  const auto fraction = static_cast<std::uint64_t>(std::ldexp(2 * mantissa - 1, mantissa_bits));
  const std::uint64_t sign = bits == 16 && value < 0 ? 1u << 15 : 0;
  return sign | static_cast<std::uint64_t>(exponent - 1 + 15) << mantissa_bits | fraction;
}

/// The largest integer that stands for 1.
double scale_of(ComponentKind kind, int bits) {
  return std::ldexp(1.0, kind == ComponentKind::snorm ? bits - 1 : bits) - 1;
}

std::int64_t fixed_point(double value, ComponentKind kind, int bits) {
  const double clamped = std::clamp(value, kind == ComponentKind::snorm ? -1.0 : 0.0, 1.0);
  return static_cast<std::int64_t>(std::floor(clamped * scale_of(kind, bits) + 0.5));
}

}  // namespace

std::vector<std::uint8_t> encoded(TextureFormat format, const Value& value) {
  const rhi::TextureFormatInfo& info = rhi::info_of(format);
  const std::array<int, 4> bits = bits_of(format);
  std::vector<std::uint8_t> bytes(info.size);
  int position = 0;
  for (std::uint32_t i = 0; i < info.components; ++i) {
    std::uint64_t component = 0;
    if (info.kind == ComponentKind::floating)
      component = float_bits(value[i], bits[i]);
    else if (info.kind == ComponentKind::uint || info.kind == ComponentKind::sint)
      component = static_cast<std::uint64_t>(static_cast<std::int64_t>(value[i]));
    else
      component = static_cast<std::uint64_t>(fixed_point(value[i], info.kind, bits[i]));
    for (int bit = 0; bit < bits[i]; ++bit, ++position)
      bytes[static_cast<std::size_t>(position / 8)] |=
          static_cast<std::uint8_t>((component >> bit & 1) << (position % 8));
  }
  return bytes;
}

Value read_back(TextureFormat format, const Value& value) {
  const rhi::TextureFormatInfo& info = rhi::info_of(format);
  const std::array<int, 4> bits = bits_of(format);
  Value result = {0, 0, 0, 1};
  for (std::uint32_t i = 0; i < info.components; ++i) {
    const bool is_fixed = info.kind == ComponentKind::unorm || info.kind == ComponentKind::snorm;
    result[i] = is_fixed ? static_cast<double>(fixed_point(value[i], info.kind, bits[i])) / scale_of(info.kind, bits[i])
                         : value[i];
  }
  return result;
}

}  // namespace tandem::conformance
