#pragma once

#include <bit>
#include <cstdint>

namespace tandem::compare {

/// The place of a float in their order: neighbours differ by 1, both zeros are at 0, infinities are one beyond the
/// largest numbers. NaNs have no order, but do get a place beyond the infinities.
constexpr std::int64_t ordinal(float value) {
  const auto bits = std::bit_cast<std::uint32_t>(value);
  const auto magnitude = static_cast<std::int64_t>(bits & 0x7FFF'FFFFU);
  return (bits >> 31U) == 0 ? magnitude : -magnitude;
}

/// Units in the last place between two floats: how many steps of nextafter lead from one to the other. 0 for equal
/// values, +0 and -0 among them.
constexpr std::uint64_t ulp_distance(float a, float b) {
  const std::int64_t difference = ordinal(a) - ordinal(b);
  return static_cast<std::uint64_t>(difference < 0 ? -difference : difference);
}

}  // namespace tandem::compare
