#pragma once

#include <type_traits>

namespace tandem::rhi {

/// Specialise to true to give a scoped enum the bit operators below.
template <typename Enum>
inline constexpr bool is_flags = false;

template <typename Enum>
concept Flags = std::is_enum_v<Enum> && is_flags<Enum>;

template <Flags Enum>
constexpr Enum operator|(Enum a, Enum b) {
  return static_cast<Enum>(static_cast<std::underlying_type_t<Enum>>(a) | static_cast<std::underlying_type_t<Enum>>(b));
}

template <Flags Enum>
constexpr Enum operator&(Enum a, Enum b) {
  return static_cast<Enum>(static_cast<std::underlying_type_t<Enum>>(a) & static_cast<std::underlying_type_t<Enum>>(b));
}

template <Flags Enum>
constexpr Enum& operator|=(Enum& a, Enum b) {
  return a = a | b;
}

/// Whether every bit of `wanted` is set in `flags`.
template <Flags Enum>
constexpr bool has(Enum flags, Enum wanted) {
  return (flags & wanted) == wanted;
}

}  // namespace tandem::rhi
