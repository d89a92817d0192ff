#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>

#include "rhi_cpu/kernel/components.hpp"
#include "rhi_cpu/kernel/types.hpp"

/// How many invocations a kernel of the wide form runs at once.
#ifndef TANDEM_LANES
#define TANDEM_LANES 8
#endif

/// The values of a subgroup of invocations: one number per lane. Vectors and matrices of them are GLM's, over Lanes
/// instead of numbers, so every function template of kernel/ that only adds, multiplies and compares takes them as they
/// are. Numbers convert to Lanes implicitly: what all lanes have in common is kept as one number and spread where a
/// lane's own number meets it.
///
/// The registers are those of the compiler's vector extension, whose operators round as the scalar ones do.
namespace tandem::kernel {

inline constexpr int lane_count = TANDEM_LANES;

template <typename T>
inline constexpr bool has_registers = std::is_arithmetic_v<T> && !std::is_same_v<T, bool>;

template <typename T>
struct Registers {
  typedef T type __attribute__((vector_size(sizeof(T) * lane_count)));
};
template <std::size_t size>
struct SignedOfSize;
template <>
struct SignedOfSize<1> {
  using type = std::int8_t;
};
template <>
struct SignedOfSize<2> {
  using type = std::int16_t;
};
template <>
struct SignedOfSize<4> {
  using type = std::int32_t;
};
template <>
struct SignedOfSize<8> {
  using type = std::int64_t;
};
/// What a comparison of T's registers gives: all bits of a lane, or none.
template <typename T>
using mask_registers = typename Registers<typename SignedOfSize<sizeof(T)>::type>::type;

/// Anything without registers of its own, one per lane.
template <typename T>
struct Lanes {
  T of_lane[lane_count];

  Lanes() = default;
  Lanes(const T& all) {
    for (T& each : of_lane) each = all;
  }
  T& operator[](int lane) { return of_lane[lane]; }
  const T& operator[](int lane) const { return of_lane[lane]; }
};

/// A bool per lane; also the mask of the lanes that execute.
template <>
struct Lanes<bool> {
  using Register = mask_registers<std::int32_t>;
  Register of_lane;

  Lanes() = default;
  Lanes(bool all) : of_lane(Register{} - std::int32_t{all}) {}
  explicit Lanes(Register lanes) : of_lane(lanes) {}

  bool operator[](int lane) const { return of_lane[lane] != 0; }
  void set(int lane, bool value) { of_lane[lane] = -std::int32_t{value}; }

  friend Lanes operator&&(Lanes a, Lanes b) { return Lanes(a.of_lane & b.of_lane); }
  friend Lanes operator||(Lanes a, Lanes b) { return Lanes(a.of_lane | b.of_lane); }
  friend Lanes operator!(Lanes a) { return Lanes(~a.of_lane); }
  friend Lanes operator==(Lanes a, Lanes b) { return Lanes(~(a.of_lane ^ b.of_lane)); }
  friend Lanes operator!=(Lanes a, Lanes b) { return Lanes(a.of_lane ^ b.of_lane); }
};
using Mask = Lanes<bool>;

template <typename T>
inline Mask mask_of(T lanes) {
  if constexpr (sizeof(lanes) == sizeof(Mask::Register))
    return Mask(reinterpret_cast<Mask::Register>(lanes));
  else
    return Mask(__builtin_convertvector(lanes, Mask::Register));
}

template <typename T>
requires has_registers<T>
struct Lanes<T> {
  using Register = typename Registers<T>::type;
  Register of_lane;

  Lanes() = default;
  Lanes(T all) : of_lane(Register{} + all) {
    // -0 + 0 is +0.
    if constexpr (std::is_floating_point_v<T>) of_lane = all - Register{};
  }
  explicit Lanes(Register lanes) : of_lane(lanes) {}
  template <typename U>
  requires(has_registers<U> && !std::is_same_v<T, U>) explicit Lanes(const Lanes<U>& other)
      : of_lane(__builtin_convertvector(other.of_lane, Register)) {}

  T operator[](int lane) const { return of_lane[lane]; }
  void set(int lane, T value) { of_lane[lane] = value; }

  friend Lanes operator+(Lanes a, Lanes b) { return Lanes(a.of_lane + b.of_lane); }
  friend Lanes operator-(Lanes a, Lanes b) { return Lanes(a.of_lane - b.of_lane); }
  friend Lanes operator*(Lanes a, Lanes b) { return Lanes(a.of_lane * b.of_lane); }
  friend Lanes operator/(Lanes a, Lanes b) requires std::is_floating_point_v<T> { return Lanes(a.of_lane / b.of_lane); }
  friend Lanes operator-(Lanes a) { return Lanes(-a.of_lane); }
  friend Lanes operator&(Lanes a, Lanes b) requires std::is_integral_v<T> { return Lanes(a.of_lane & b.of_lane); }
  friend Lanes operator|(Lanes a, Lanes b) requires std::is_integral_v<T> { return Lanes(a.of_lane | b.of_lane); }
  friend Lanes operator^(Lanes a, Lanes b) requires std::is_integral_v<T> { return Lanes(a.of_lane ^ b.of_lane); }
  friend Lanes operator~(Lanes a) requires std::is_integral_v<T> { return Lanes(~a.of_lane); }
  Lanes& operator+=(Lanes b) { return *this = *this + b; }
  Lanes& operator-=(Lanes b) { return *this = *this - b; }
  Lanes& operator*=(Lanes b) { return *this = *this * b; }
  Lanes& operator/=(Lanes b) requires std::is_floating_point_v<T> { return *this = *this / b; }
  Lanes& operator&=(Lanes b) requires std::is_integral_v<T> { return *this = *this & b; }
  Lanes& operator|=(Lanes b) requires std::is_integral_v<T> { return *this = *this | b; }
  Lanes& operator^=(Lanes b) requires std::is_integral_v<T> { return *this = *this ^ b; }

  friend Mask operator==(Lanes a, Lanes b) { return mask_of(a.of_lane == b.of_lane); }
  friend Mask operator!=(Lanes a, Lanes b) { return mask_of(a.of_lane != b.of_lane); }
  friend Mask operator<(Lanes a, Lanes b) { return mask_of(a.of_lane < b.of_lane); }
  friend Mask operator<=(Lanes a, Lanes b) { return mask_of(a.of_lane <= b.of_lane); }
  friend Mask operator>(Lanes a, Lanes b) { return mask_of(a.of_lane > b.of_lane); }
  friend Mask operator>=(Lanes a, Lanes b) { return mask_of(a.of_lane >= b.of_lane); }
};

template <typename T>
inline constexpr bool is_lanes = false;
template <typename T>
inline constexpr bool is_lanes<Lanes<T>> = true;

/// The components of what is made of lanes are those of one lane.
template <typename T>
struct ComponentOf<Lanes<T>> {
  using type = T;
};
template <int length, typename T>
struct ComponentOf<glm::vec<length, Lanes<T>>> {
  using type = T;
};

// The value that all lanes have in common, as every lane's own: T's twin.

template <typename T>
struct WideOf {
  using type = Lanes<T>;
};
template <typename T>
requires requires { typename T::Wide; }
struct WideOf<T> {
  using type = typename T::Wide;
};
template <int length, typename T>
struct WideOf<glm::vec<length, T>> {
  using type = glm::vec<length, Lanes<T>>;
};
template <int columns, int rows, typename T>
struct WideOf<glm::mat<columns, rows, T>> {
  using type = glm::mat<columns, rows, Lanes<T>>;
};
template <typename T, std::size_t size>
struct WideOf<Array<T, size>> {
  using type = Array<typename WideOf<T>::type, size>;
};
template <typename T>
using wide_t = typename WideOf<T>::type;

/// The lanes of a mask as the bits of a number, the first lane lowest.
inline std::uint32_t bits_of(Mask mask);
inline bool any_of(Mask mask);

// One lane's value of a wide one, and back.

template <typename T>
inline T lane(const Lanes<T>& wide, int lane) {
  return wide[lane];
}
template <typename T>
inline void set_lane(Lanes<T>& wide, int lane, const T& value) {
  if constexpr (requires { wide.set(lane, value); })
    wide.set(lane, value);
  else
    wide[lane] = value;
}
template <int length, typename T>
inline glm::vec<length, T> lane(const glm::vec<length, Lanes<T>>& wide, int lane) {
  glm::vec<length, T> value;
  for (int i = 0; i < length; ++i) value[i] = wide[i][lane];
  return value;
}
template <int length, typename T>
inline void set_lane(glm::vec<length, Lanes<T>>& wide, int lane, const glm::vec<length, T>& value) {
  for (int i = 0; i < length; ++i) kernel::set_lane(wide[i], lane, value[i]);
}
template <int columns, int rows, typename T>
inline glm::mat<columns, rows, T> lane(const glm::mat<columns, rows, Lanes<T>>& wide, int lane) {
  glm::mat<columns, rows, T> value;
  for (int i = 0; i < columns; ++i) value[i] = kernel::lane(wide[i], lane);
  return value;
}
template <int columns, int rows, typename T>
inline void set_lane(glm::mat<columns, rows, Lanes<T>>& wide, int lane, const glm::mat<columns, rows, T>& value) {
  for (int i = 0; i < columns; ++i) kernel::set_lane(wide[i], lane, value[i]);
}
template <typename Wide>
requires requires { typename Wide::Narrow; }
inline typename Wide::Narrow lane(const Wide& wide, int lane) { return wide.lane(lane); }
template <typename Wide>
requires requires { typename Wide::Narrow; }
inline void set_lane(Wide& wide, int lane, const typename Wide::Narrow& value) { wide.set_lane(lane, value); }
template <typename Wide, std::size_t size>
inline auto lane(const Array<Wide, size>& wide, int lane) {
  Array<decltype(kernel::lane(wide[0], lane)), size> value;
  for (std::size_t i = 0; i < size; ++i) value[i] = kernel::lane(wide[i], lane);
  return value;
}
template <typename Wide, typename T, std::size_t size>
inline void set_lane(Array<Wide, size>& wide, int lane, const Array<T, size>& value) {
  for (std::size_t i = 0; i < size; ++i) kernel::set_lane(wide[i], lane, value[i]);
}

/// A value of every lane's own.
template <typename T>
inline wide_t<T> spread(const T& value) {
  if constexpr (std::is_same_v<wide_t<T>, Lanes<T>>) {
    return Lanes<T>(value);
  } else if constexpr (length_of<T> != 0) {
    wide_t<T> wide;
    for (int i = 0; i < length_of<T>; ++i) wide[i] = value[i];
    return wide;
  } else {
    wide_t<T> wide;
    for (int i = 0; i < lane_count; ++i) kernel::set_lane(wide, i, value);
    return wide;
  }
}

// if_true in the lanes of the mask, else if_false.

template <typename T>
inline Lanes<T> select(Mask mask, const Lanes<T>& if_true, const Lanes<T>& if_false) {
  if constexpr (has_registers<T>) {
    if constexpr (sizeof(T) == sizeof(std::int32_t))
      return Lanes<T>(mask.of_lane ? if_true.of_lane : if_false.of_lane);
    else
      return Lanes<T>(__builtin_convertvector(mask.of_lane, mask_registers<T>) ? if_true.of_lane : if_false.of_lane);
  } else if constexpr (std::is_same_v<T, bool>) {
    return Mask(mask.of_lane ? if_true.of_lane : if_false.of_lane);
  } else if constexpr (requires { typename Lanes<T>::Words; }) {
    return Lanes<T>(kernel::select(mask, if_true.words, if_false.words));
  } else {
    Lanes<T> result;
    for (int i = 0; i < lane_count; ++i) result[i] = mask[i] ? if_true[i] : if_false[i];
    return result;
  }
}
template <int length, typename T>
inline glm::vec<length, Lanes<T>> select(Mask mask, const glm::vec<length, Lanes<T>>& if_true,
                                         const glm::vec<length, Lanes<T>>& if_false) {
  glm::vec<length, Lanes<T>> result;
  for (int i = 0; i < length; ++i) result[i] = kernel::select(mask, if_true[i], if_false[i]);
  return result;
}
template <int length, typename T>
inline glm::vec<length, Lanes<T>> select(const glm::vec<length, Mask>& masks, const glm::vec<length, Lanes<T>>& if_true,
                                         const glm::vec<length, Lanes<T>>& if_false) {
  glm::vec<length, Lanes<T>> result;
  for (int i = 0; i < length; ++i) result[i] = kernel::select(masks[i], if_true[i], if_false[i]);
  return result;
}
template <int columns, int rows, typename T>
inline glm::mat<columns, rows, Lanes<T>> select(Mask mask, const glm::mat<columns, rows, Lanes<T>>& if_true,
                                                const glm::mat<columns, rows, Lanes<T>>& if_false) {
  glm::mat<columns, rows, Lanes<T>> result;
  for (int i = 0; i < columns; ++i) result[i] = kernel::select(mask, if_true[i], if_false[i]);
  return result;
}
template <typename Wide>
requires requires { typename Wide::Narrow; }
inline Wide select(Mask mask, const Wide& if_true, const Wide& if_false) {
  return Wide::select(mask, if_true, if_false);
}
template <typename Wide, std::size_t size>
inline Array<Wide, size> select(Mask mask, const Array<Wide, size>& if_true, const Array<Wide, size>& if_false) {
  Array<Wide, size> result;
  for (std::size_t i = 0; i < size; ++i) result[i] = kernel::select(mask, if_true[i], if_false[i]);
  return result;
}

/// place = value in the lanes of the mask.
template <typename Wide>
inline void assign(Mask mask, Wide& place, const Wide& value) {
  place = kernel::select(mask, value, place);
}

/// function(a, b...) of each lane's numbers.
template <typename T>
inline const T& of_lane(const T& value, int) {
  return value;
}
template <typename T>
inline T of_lane(const Lanes<T>& value, int lane) {
  return value[lane];
}
template <typename Function, typename A, typename... B>
requires(is_lanes<A> || (is_lanes<B> || ...)) inline auto each(const Function& function, const A& a, const B&... b) {
  using Result = std::remove_cvref_t<decltype(function(of_lane(a, 0), of_lane(b, 0)...))>;
  Lanes<Result> result;
#pragma GCC unroll 32
  for (int i = 0; i < lane_count; ++i)
    kernel::set_lane(result, i, static_cast<Result>(function(of_lane(a, i), of_lane(b, i)...)));
  return result;
}

}  // namespace tandem::kernel
