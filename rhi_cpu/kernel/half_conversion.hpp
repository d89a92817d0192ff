#pragma once

#include <bit>
#include <cstdint>
#include <type_traits>

/// IEEE 754 binary16, as bits, from and to float. Without branches where the compiler has none to spare: every case is
/// computed and one is picked.
namespace tandem::kernel {

/// The nearest binary16, halves to even; a NaN becomes the quiet one of its sign.
constexpr std::uint32_t float_to_half(float value) {
  const auto bits = std::bit_cast<std::uint32_t>(value);
  const std::uint32_t sign = (bits >> 16) & 0x8000u;
  const std::uint32_t magnitude = bits & 0x7fffffffu;
#ifdef __F16C__
  if (!std::is_constant_evaluated() && magnitude <= 0x7f800000u) {
    using Floats [[gnu::vector_size(16)]] = float;
    using Halves [[gnu::vector_size(16)]] = short;
    constexpr int to_nearest = 0;
    const Halves halves = __builtin_ia32_vcvtps2ph(Floats{value}, to_nearest);
    return static_cast<std::uint16_t>(halves[0]);
  }
#endif
  // Above 1/2, floats are multiples of 2^-24, and so are the binary16 below 2^-14: the addition rounds.
  const std::uint32_t subnormal = std::bit_cast<std::uint32_t>(std::bit_cast<float>(magnitude) + 0.5f) - 0x3f000000u;
  const std::uint32_t normal = (magnitude - 0x38000000u + 0xfffu + ((magnitude >> 13) & 1u)) >> 13;
  const std::uint32_t special = magnitude > 0x7f800000u ? 0x7e00u : 0x7c00u;
  const std::uint32_t finite = magnitude < 0x38800000u ? subnormal : normal;
  return sign | (magnitude >= 0x477ff000u ? special : finite);  // from where it rounds to 65536
}

/// Exact.
constexpr float half_to_float(std::uint32_t half) {
  const std::uint32_t sign = (half & 0x8000u) << 16;
  const std::uint32_t shifted = (half & 0x7fffu) << 13;
  constexpr std::uint32_t exponents = 0x0f800000u;
#ifdef __F16C__
  if (!std::is_constant_evaluated() && shifted <= exponents) {
    using Floats [[gnu::vector_size(16)]] = float;
    using Halves [[gnu::vector_size(16)]] = short;
    const Floats floats = __builtin_ia32_vcvtph2ps(Halves{static_cast<short>(half)});
    return floats[0];
  }
#endif
  // As if of the exponent 2^-14, which a subnormal has, without the leading 1 that it has not.
  const std::uint32_t subnormal =
      std::bit_cast<std::uint32_t>(std::bit_cast<float>(shifted + 0x38800000u) - 6.103515625e-05f);
  const std::uint32_t special = shifted + 0x70000000u;
  const std::uint32_t normal = shifted + 0x38000000u;
  const std::uint32_t finite = (shifted & exponents) == 0 ? subnormal : normal;
  return std::bit_cast<float>(sign | ((shifted & exponents) == exponents ? special : finite));
}

/// The nearest binary16, rounded once: to float with the last bit set where that is not exact, which no tie survives.
constexpr std::uint32_t double_to_half(double value) {
  const auto nearest = static_cast<float>(value);
  auto bits = std::bit_cast<std::uint32_t>(nearest);
  const auto back = static_cast<double>(nearest);
  if (back != value) {
    const bool is_larger = value < 0 ? back < value : back > value;
    bits = (is_larger ? bits - 1 : bits) | 1u;
  }
  return float_to_half(std::bit_cast<float>(bits));
}

}  // namespace tandem::kernel
