#pragma once

#include <cstdint>

#include "rhi_cpu/kernel/wide/lanes.hpp"

/// IEEE 754 binary16 of all lanes from and to float, with the bits that kernel/half_conversion.hpp gives each.
namespace tandem::kernel {

/// half_to_float of every lane.
inline Lanes<float> floats_of(const Lanes<std::uint16_t>& halves) {
  using Bits = Lanes<std::uint32_t>;
  using Floats = Lanes<float>::Register;
  const auto half = __builtin_convertvector(halves.of_lane, Bits::Register);
  const auto sign = (half & 0x8000u) << 16, shifted = (half & 0x7fffu) << 13;
#if defined(__F16C__) && TANDEM_LANES == 8
  // The instruction makes signalling NaNs quiet.
  typedef short Halves __attribute__((vector_size(16)));
  const auto number =
      reinterpret_cast<Bits::Register>(__builtin_ia32_vcvtph2ps256(reinterpret_cast<Halves>(halves.of_lane)));
  return Lanes<float>(reinterpret_cast<Floats>(shifted > 0x0f800000u ? sign | (shifted + 0x70000000u) : number));
#else
  const auto exponent = shifted & 0x0f800000u;
  const auto subnormal =
      reinterpret_cast<Bits::Register>(reinterpret_cast<Floats>(shifted + 0x38800000u) - 6.103515625e-05f);
  const auto finite = exponent == 0u ? subnormal : shifted + 0x38000000u;
  return Lanes<float>(reinterpret_cast<Floats>(sign | (exponent == 0x0f800000u ? shifted + 0x70000000u : finite)));
#endif
}

/// float_to_half of every lane.
inline Lanes<std::uint16_t> halves_of(const Lanes<float>& floats) {
  using Bits = Lanes<std::uint32_t>;
  using Floats = Lanes<float>::Register;
  const auto bits = reinterpret_cast<Bits::Register>(floats.of_lane);
  const auto sign = (bits >> 16) & 0x8000u, magnitude = bits & 0x7fffffffu;
  const auto subnormal = reinterpret_cast<Bits::Register>(reinterpret_cast<Floats>(magnitude) + 0.5f) - 0x3f000000u;
  const auto normal = (magnitude - 0x38000000u + 0xfffu + ((magnitude >> 13) & 1u)) >> 13;
  const auto special = magnitude > 0x7f800000u ? Bits(0x7e00u).of_lane : Bits(0x7c00u).of_lane;
  const auto finite = magnitude < 0x38800000u ? subnormal : normal;
  const auto half = sign | (magnitude >= 0x477ff000u ? special : finite);
  return Lanes<std::uint16_t>(__builtin_convertvector(half, Lanes<std::uint16_t>::Register));
}

}  // namespace tandem::kernel
