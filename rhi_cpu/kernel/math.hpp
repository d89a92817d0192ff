#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>
#include <utility>

#include "rhi_cpu/kernel/components.hpp"
#include "rhi_cpu/kernel/types.hpp"

/// The scalar functions of GLSL.std.450, for scalars and, component by component, for vectors. Functions that IEEE 754
/// rounds exactly, and those built from them here in Mesa's order, agree with lavapipe to the last bit; sin, cos, tan,
/// asin, acos, atan, exp, log, pow and their kin are the C library's and do not.
namespace tandem::kernel {

// Rounding, without the library calls that a baseline x86-64 makes of std::floor and its kin. From 2^23 (double: 2^52)
// on every value is whole already, and so are infinity and NaN for this purpose.

template <typename T>
inline constexpr T all_whole_from = T(1) / std::numeric_limits<T>::epsilon();

template <typename T>
inline T trunc(const T& a) {
  using F = component_t<T>;
  return each(
      [](F narrow) {
        const auto x = widened(narrow);
        using W = std::remove_const_t<decltype(x)>;
        using I = std::conditional_t<sizeof(W) == 4, std::int32_t, std::int64_t>;
        return std::fabs(x) < all_whole_from<W> ? static_cast<F>(std::copysign(static_cast<W>(static_cast<I>(x)), x))
                                                : narrow;
      },
      a);
}
template <typename T>
inline T floor(const T& a) {
  using F = component_t<T>;
  return each(
      [](F x) {
        const F whole = kernel::trunc(x);
        return whole > x ? whole - F{1} : whole;
      },
      a);
}
template <typename T>
inline T ceil(const T& a) {
  using F = component_t<T>;
  return each(
      [](F x) {
        const F whole = kernel::trunc(x);
        return whole < x ? static_cast<F>(std::copysign(widened(whole + F{1}), widened(x))) : whole;
      },
      a);
}
/// To the nearest, halves to even.
template <typename T>
inline T round_even(const T& a) {
  using F = component_t<T>;
  return each(
      [](F narrow) {
        const auto x = widened(narrow);
        const auto magnitude = std::fabs(x);
        constexpr auto whole_from = all_whole_from<std::remove_const_t<decltype(x)>>;
        return magnitude < whole_from ? static_cast<F>(std::copysign((magnitude + whole_from) - whole_from, x))
                                      : narrow;
      },
      a);
}
template <typename T>
inline T fract(const T& a) {
  return a - kernel::floor(a);
}

template <typename T>
inline T abs(const T& a) {
  using C = component_t<T>;
  return each(
      [](C x) {
        if constexpr (std::is_integral_v<C>)
          return x < 0 ? kernel::negate(x) : x;
        else
          return static_cast<C>(std::fabs(widened(x)));
      },
      a);
}
template <typename T>
constexpr T sign(const T& a) {
  using C = component_t<T>;
  return each([](C x) { return x > C{0} ? C{1} : x < C{0} ? static_cast<C>(-1) : C{0}; }, a);
}

/// a - b * floor(a / b), the sign of b.
template <typename T>
inline T float_modulo(const T& a, const T& b) {
  return a - b * kernel::floor(a / b);
}
/// a - b * trunc(a / b), the sign of a.
template <typename T>
inline T float_remainder(const T& a, const T& b) {
  return a - b * kernel::trunc(a / b);
}

/// The smaller; the other one when one is NaN.
template <typename T>
constexpr T min(const T& a, const T& b) {
  return each([](auto x, auto y) { return y < x || x != x ? y : x; }, a, b);
}
/// The larger; the other one when one is NaN.
template <typename T>
constexpr T max(const T& a, const T& b) {
  return each([](auto x, auto y) { return x < y || x != x ? y : x; }, a, b);
}
template <typename T>
constexpr T clamp(const T& a, const T& low, const T& high) {
  return kernel::min(kernel::max(a, low), high);
}

template <typename T>
constexpr T mix(const T& a, const T& b, const T& t) {
  return a * (T(component_t<T>(1)) - t) + b * t;
}
template <typename T>
constexpr T step(const T& edge, const T& a) {
  using F = component_t<T>;
  return each([](F e, F x) { return x < e ? F{0} : F{1}; }, edge, a);
}
template <typename T>
constexpr T smooth_step(const T& low, const T& high, const T& a) {
  using F = component_t<T>;
  const T t = kernel::clamp((a - low) / (high - low), T(F(0)), T(F(1)));
  return t * (t * (T(F(3)) - T(F(2)) * t));
}
/// a * b + c with two roundings, as Mesa's software rasteriser computes it.
template <typename T>
constexpr T fma(const T& a, const T& b, const T& c) {
  return a * b + c;
}

template <typename T>
inline T sqrt(const T& a) {
  using F = component_t<T>;
  return each([](F x) { return static_cast<F>(std::sqrt(widened(x))); }, a);
}
template <typename T>
inline T inverse_sqrt(const T& a) {
  using F = component_t<T>;
  return each([](F x) { return static_cast<F>(1 / std::sqrt(widened(x))); }, a);
}

template <typename T>
constexpr T radians(const T& a) {
  return a * component_t<T>(0.017453292519943295);
}
template <typename T>
constexpr T degrees(const T& a) {
  return a * component_t<T>(57.29577951308232);
}

#define TANDEM_LIBRARY_FUNCTION(name)                                          \
  template <typename T>                                                        \
  inline T name(const T& a) {                                                  \
    using F = component_t<T>;                                                  \
    return each([](F x) { return static_cast<F>(std::name(widened(x))); }, a); \
  }
TANDEM_LIBRARY_FUNCTION(sin)
TANDEM_LIBRARY_FUNCTION(cos)
TANDEM_LIBRARY_FUNCTION(tan)
TANDEM_LIBRARY_FUNCTION(asin)
TANDEM_LIBRARY_FUNCTION(acos)
TANDEM_LIBRARY_FUNCTION(atan)
TANDEM_LIBRARY_FUNCTION(sinh)
TANDEM_LIBRARY_FUNCTION(cosh)
TANDEM_LIBRARY_FUNCTION(tanh)
TANDEM_LIBRARY_FUNCTION(asinh)
TANDEM_LIBRARY_FUNCTION(acosh)
TANDEM_LIBRARY_FUNCTION(atanh)
TANDEM_LIBRARY_FUNCTION(exp)
TANDEM_LIBRARY_FUNCTION(exp2)
TANDEM_LIBRARY_FUNCTION(log)
TANDEM_LIBRARY_FUNCTION(log2)
#undef TANDEM_LIBRARY_FUNCTION

/// The angle of (x, y).
template <typename T>
inline T atan2(const T& y, const T& x) {
  using F = component_t<T>;
  return each([](F b, F a) { return static_cast<F>(std::atan2(widened(b), widened(a))); }, y, x);
}
template <typename T>
inline T pow(const T& a, const T& exponent) {
  using F = component_t<T>;
  return each([](F x, F y) { return static_cast<F>(std::pow(widened(x), widened(y))); }, a, exponent);
}

/// Splits into a fraction with the sign of `a` and the whole part.
template <typename T>
inline T modf(const T& a, T& whole) {
  whole = kernel::trunc(a);
  using F = component_t<T>;
  return each(
      [](F x, F w) { return static_cast<F>(std::copysign(widened(kernel::is_inf(x) ? F{0} : x - w), widened(x))); }, a,
      whole);
}

/// Splits into a significand in [0.5, 1) and an exponent of two.
template <typename T, typename Exponent>
inline T frexp(const T& a, Exponent& exponent) {
  using F = component_t<T>;
  exponent = each(
      [](F x) {
        int e = 0;
        if (x == x && !kernel::is_inf(x)) std::frexp(widened(x), &e);
        return std::int32_t{e};
      },
      a);
  return each(
      [](F x) {
        int e = 0;
        return kernel::is_inf(x) ? x : static_cast<F>(std::frexp(widened(x), &e));
      },
      a);
}
/// Exponents of any width: beyond those that a float has, one is as good as another.
template <typename T, typename Exponent>
inline T ldexp(const T& a, const Exponent& exponent) {
  using F = component_t<T>;
  constexpr int beyond_all = 1 << 15;
  return each(
      [](F x, auto e) {
        const int power = std::cmp_greater(e, beyond_all) ? beyond_all
                          : std::cmp_less(e, -beyond_all) ? -beyond_all
                                                          : static_cast<int>(e);
        return static_cast<F>(std::ldexp(widened(x), power));
      },
      a, exponent);
}

}  // namespace tandem::kernel
