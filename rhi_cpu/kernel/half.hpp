#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <type_traits>

#include <glm/matrix.hpp>

#include "rhi_cpu/kernel/atomics.hpp"
#include "rhi_cpu/kernel/components.hpp"
#include "rhi_cpu/kernel/half_conversion.hpp"
#include "rhi_cpu/kernel/types.hpp"

/// 16-bit floats. A translated shader includes this header only when it has some.
namespace tandem::kernel {

/// IEEE 754 binary16. Each operation is one of float, rounded to the nearest: the same as if it were rounded once,
/// since a float has more than twice as many bits and two.
class half {
 public:
  half() = default;
  template <typename T>
  requires std::is_arithmetic_v<T>
  explicit constexpr half(T value) : bits_(static_cast<std::uint16_t>(rounded(value))) {}

  static constexpr half from_bits(std::uint16_t bits) {
    half result{};
    result.bits_ = bits;
    return result;
  }
  constexpr std::uint16_t bits() const { return bits_; }

  template <typename T>
  requires std::is_arithmetic_v<T>
  explicit constexpr operator T() const { return static_cast<T>(half_to_float(bits_)); }

  constexpr half operator-() const { return from_bits(static_cast<std::uint16_t>(bits_ ^ 0x8000u)); }
  constexpr half operator+() const { return *this; }
  friend constexpr half operator+(half a, half b) { return half(float(a) + float(b)); }
  friend constexpr half operator-(half a, half b) { return half(float(a) - float(b)); }
  friend constexpr half operator*(half a, half b) { return half(float(a) * float(b)); }
  friend constexpr half operator/(half a, half b) { return half(float(a) / float(b)); }
  constexpr half& operator+=(half b) { return *this = *this + b; }
  constexpr half& operator-=(half b) { return *this = *this - b; }
  constexpr half& operator*=(half b) { return *this = *this * b; }
  constexpr half& operator/=(half b) { return *this = *this / b; }

  friend constexpr bool operator==(half a, half b) { return float(a) == float(b); }
  friend constexpr bool operator!=(half a, half b) { return float(a) != float(b); }
  friend constexpr bool operator<(half a, half b) { return float(a) < float(b); }
  friend constexpr bool operator<=(half a, half b) { return float(a) <= float(b); }
  friend constexpr bool operator>(half a, half b) { return float(a) > float(b); }
  friend constexpr bool operator>=(half a, half b) { return float(a) >= float(b); }

 private:
  template <typename T>
  static constexpr std::uint32_t rounded(T value) {
    // An integer that a float does not hold exactly is beyond the largest half.
    if constexpr (std::is_same_v<T, double>)
      return double_to_half(value);
    else
      return float_to_half(static_cast<float>(value));
  }

  std::uint16_t bits_;
};

template <>
struct MachineWord<half> {
  using type = std::uint16_t;
};

/// What the functions of kernel/math.hpp compute with before they round.
constexpr float widened(half x) { return static_cast<float>(x); }

/// The half next to each component, a double or a float, on the side of zero.
template <typename To, typename From>
constexpr To convert_toward_zero(const From& from) {
  return each(
      [](auto x) {
        const auto nearest = static_cast<half>(x);
        const auto value = static_cast<double>(x), back = static_cast<double>(nearest);
        const bool is_beyond = value < 0 ? back < value : back > value;
        return is_beyond ? half::from_bits(static_cast<std::uint16_t>(nearest.bits() - 1)) : nearest;
      },
      from);
}

/// Computed in float and rounded once, as drivers do: a difference of products loses most of a half's bits otherwise.
template <int size>
inline half determinant(const glm::mat<size, size, half>& m) {
  return half(glm::determinant(glm::mat<size, size, float>(m)));
}
template <int size>
inline glm::mat<size, size, half> inverse(const glm::mat<size, size, half>& m) {
  return glm::mat<size, size, half>(glm::inverse(glm::mat<size, size, float>(m)));
}

using f16vec2 = glm::vec<2, half>;
using f16vec3 = glm::vec<3, half>;
using f16vec4 = glm::vec<4, half>;

static_assert(sizeof(half) == 2 && std::is_trivial_v<half> && sizeof(f16vec3) == 6);

}  // namespace tandem::kernel

template <>
struct std::numeric_limits<tandem::kernel::half> {
  using half = tandem::kernel::half;
  static constexpr bool is_specialized = true;
  static constexpr bool is_signed = true;
  static constexpr bool is_integer = false;
  static constexpr bool is_exact = false;
  static constexpr bool is_iec559 = true;  // GLM asks
  static constexpr bool has_infinity = true;
  static constexpr bool has_quiet_NaN = true;
  static constexpr int digits = 11;
  static constexpr half min() { return half::from_bits(0x0400); }
  static constexpr half max() { return half::from_bits(0x7bff); }
  static constexpr half lowest() { return half::from_bits(0xfbff); }
  static constexpr half epsilon() { return half::from_bits(0x1400); }
  static constexpr half infinity() { return half::from_bits(0x7c00); }
  static constexpr half quiet_NaN() { return half::from_bits(0x7e00); }
};
