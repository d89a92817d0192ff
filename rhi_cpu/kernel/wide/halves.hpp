#pragma once

#include <cstdint>
#include <type_traits>

#include "rhi_cpu/kernel/half.hpp"
#include "rhi_cpu/kernel/wide/functions.hpp"
#include "rhi_cpu/kernel/wide/half_conversion.hpp"
#include "rhi_cpu/kernel/wide/lanes.hpp"

/// 16-bit floats of all lanes, with the bits that kernel::half gives each. A kernel of the wide form includes this
/// header where it includes half.hpp.
namespace tandem::kernel {

template <>
struct Lanes<half> {
  using Words = Lanes<std::uint16_t>;
  Words words;

  Lanes() = default;
  Lanes(half all) : words(all.bits()) {}
  template <typename T>
  requires std::is_arithmetic_v<T>
  explicit Lanes(T all) : words(half(all).bits()) {}
  explicit Lanes(const Words& all) : words(all) {}
  explicit Lanes(const Lanes<float>& floats) : words(halves_of(floats)) {}

  half operator[](int lane) const { return half::from_bits(words[lane]); }
  void set(int lane, half value) { words.set(lane, value.bits()); }

  friend Lanes operator+(const Lanes& a, const Lanes& b) { return Lanes(floats_of(a.words) + floats_of(b.words)); }
  friend Lanes operator-(const Lanes& a, const Lanes& b) { return Lanes(floats_of(a.words) - floats_of(b.words)); }
  friend Lanes operator*(const Lanes& a, const Lanes& b) { return Lanes(floats_of(a.words) * floats_of(b.words)); }
  friend Lanes operator/(const Lanes& a, const Lanes& b) { return Lanes(floats_of(a.words) / floats_of(b.words)); }
  friend Lanes operator-(const Lanes& a) { return Lanes(a.words ^ Words(0x8000)); }
  friend Lanes operator+(const Lanes& a) { return a; }
  Lanes& operator+=(const Lanes& b) { return *this = *this + b; }
  Lanes& operator-=(const Lanes& b) { return *this = *this - b; }
  Lanes& operator*=(const Lanes& b) { return *this = *this * b; }
  Lanes& operator/=(const Lanes& b) { return *this = *this / b; }

  friend Mask operator==(const Lanes& a, const Lanes& b) { return floats_of(a.words) == floats_of(b.words); }
  friend Mask operator!=(const Lanes& a, const Lanes& b) { return floats_of(a.words) != floats_of(b.words); }
  friend Mask operator<(const Lanes& a, const Lanes& b) { return floats_of(a.words) < floats_of(b.words); }
  friend Mask operator<=(const Lanes& a, const Lanes& b) { return floats_of(a.words) <= floats_of(b.words); }
  friend Mask operator>(const Lanes& a, const Lanes& b) { return floats_of(a.words) > floats_of(b.words); }
  friend Mask operator>=(const Lanes& a, const Lanes& b) { return floats_of(a.words) >= floats_of(b.words); }
};

// Conversions that need not go from lane to lane.

template <typename To>
requires std::is_same_v<To, Lanes<float>>
inline To convert(const Lanes<half>& from) { return floats_of(from.words); }
template <typename To>
requires std::is_same_v<To, Lanes<half>>
inline To convert(const Lanes<float>& from) { return To(from); }
template <typename To, int length>
requires std::is_same_v<To, glm::vec<length, Lanes<float>>>
inline To convert(const glm::vec<length, Lanes<half>>& from) {
  To result;
  for (int i = 0; i < length; ++i) result[i] = floats_of(from[i].words);
  return result;
}
template <typename To, int length>
requires std::is_same_v<To, glm::vec<length, Lanes<half>>>
inline To convert(const glm::vec<length, Lanes<float>>& from) {
  To result;
  for (int i = 0; i < length; ++i) result[i] = Lanes<half>(from[i]);
  return result;
}
template <typename To>
requires std::is_same_v<To, Lanes<std::int32_t>>
inline To float_to_signed(const Lanes<half>& from) { return kernel::float_to_signed<To>(floats_of(from.words)); }
template <typename To>
requires std::is_same_v<To, Lanes<std::uint32_t>>
inline To float_to_unsigned(const Lanes<half>& from) { return kernel::float_to_unsigned<To>(floats_of(from.words)); }

}  // namespace tandem::kernel
