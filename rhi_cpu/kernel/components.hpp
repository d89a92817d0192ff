#pragma once

#include <bit>
#include <cstring>
#include <limits>
#include <type_traits>
#include <utility>

#include "rhi_cpu/kernel/types.hpp"

/// Operations that act on scalars, or on vectors component by component: relations, selection, conversion, and integer
/// arithmetic. What C++ leaves undefined is defined here: integer division by zero, shifts by the width or more, and
/// conversions of floats out of range. Sums and products of signed integers rely on -fwrapv.
namespace tandem::kernel {

template <typename T>
inline constexpr int length_of = 0;  ///< components of a vector, 0 for a scalar
template <int length, typename T>
inline constexpr int length_of<glm::vec<length, T>> = length;

template <typename T>
struct ComponentOf {
  using type = T;
};
template <int length, typename T>
struct ComponentOf<glm::vec<length, T>> {
  using type = T;
};
template <typename T>
using component_t = typename ComponentOf<T>::type;

/// function(a, b...) for scalars; the vector of function(a[i], b[i]...) for vectors of one length. The wide form has
/// its own for what is no scalar (kernel/wide/lanes.hpp).
template <typename Function, typename A, typename... B>
constexpr auto each(const Function& function, const A& a, const B&... b) {
  if constexpr (length_of<A> == 0) {
    return function(a, b...);
  } else {
    const auto component = [&](int i) { return each(function, a[i], b[i]...); };
    return [&]<int... i>(std::integer_sequence<int, i...>) {
      return glm::vec<length_of<A>, decltype(component(0))>(component(i)...);
    }
    (std::make_integer_sequence<int, length_of<A>>());
  }
}

/// The same bits as another type of the same size.
template <typename To, typename From>
constexpr To bit_cast(const From& from) {
  static_assert(sizeof(To) == sizeof(From));
  if constexpr (std::is_scalar_v<To> && std::is_scalar_v<From>) {
    return std::bit_cast<To>(from);
  } else {
    To to;
    std::memcpy(&to, &from, sizeof(To));
    return to;
  }
}

// Relations. The unordered forms are true when an operand is NaN.

template <typename T>
constexpr auto equal(const T& a, const T& b) {
  return each([](auto x, auto y) { return x == y; }, a, b);
}
template <typename T>
constexpr auto not_equal(const T& a, const T& b) {
  return each([](auto x, auto y) { return x != y; }, a, b);
}
template <typename T>
constexpr auto less(const T& a, const T& b) {
  return each([](auto x, auto y) { return x < y; }, a, b);
}
template <typename T>
constexpr auto less_equal(const T& a, const T& b) {
  return each([](auto x, auto y) { return x <= y; }, a, b);
}
template <typename T>
constexpr auto greater(const T& a, const T& b) {
  return kernel::less(b, a);
}
template <typename T>
constexpr auto greater_equal(const T& a, const T& b) {
  return kernel::less_equal(b, a);
}
template <typename T>
constexpr auto ordered_not_equal(const T& a, const T& b) {
  return each([](auto x, auto y) { return x < y || x > y; }, a, b);
}
template <typename T>
constexpr auto unordered_equal(const T& a, const T& b) {
  return each([](auto x, auto y) { return !(x < y || x > y); }, a, b);
}
template <typename T>
constexpr auto unordered_less(const T& a, const T& b) {
  return each([](auto x, auto y) { return !(x >= y); }, a, b);
}
template <typename T>
constexpr auto unordered_less_equal(const T& a, const T& b) {
  return each([](auto x, auto y) { return !(x > y); }, a, b);
}
template <typename T>
constexpr auto unordered_greater(const T& a, const T& b) {
  return kernel::unordered_less(b, a);
}
template <typename T>
constexpr auto unordered_greater_equal(const T& a, const T& b) {
  return kernel::unordered_less_equal(b, a);
}
template <typename T>
constexpr auto ordered(const T& a, const T& b) {
  return each([](auto x, auto y) { return x == x && y == y; }, a, b);
}
template <typename T>
constexpr auto unordered(const T& a, const T& b) {
  return each([](auto x, auto y) { return x != x || y != y; }, a, b);
}
template <typename T>
constexpr auto is_nan(const T& a) {
  return each([](auto x) { return x != x; }, a);
}
template <typename T>
constexpr auto is_inf(const T& a) {
  return each(
      [](auto x) {
        constexpr auto infinity = std::numeric_limits<decltype(x)>::infinity();
        return x == infinity || x == -infinity;
      },
      a);
}

// Logic.

template <typename T>
constexpr auto logical_and(const T& a, const T& b) {
  return each([](bool x, bool y) { return x && y; }, a, b);
}
template <typename T>
constexpr auto logical_or(const T& a, const T& b) {
  return each([](bool x, bool y) { return x || y; }, a, b);
}
template <typename T>
constexpr auto logical_not(const T& a) {
  return each([](bool x) { return !x; }, a);
}
template <int length>
constexpr bool any(const glm::vec<length, bool>& a) {
  bool result = a[0];
  for (int i = 1; i < length; ++i) result |= a[i];
  return result;
}
template <int length>
constexpr bool all(const glm::vec<length, bool>& a) {
  bool result = a[0];
  for (int i = 1; i < length; ++i) result &= a[i];
  return result;
}

/// if_true where the condition holds, else if_false.
template <typename T>
constexpr T select(bool condition, const T& if_true, const T& if_false) {
  return condition ? if_true : if_false;
}
template <int length, typename T>
constexpr glm::vec<length, T> select(const glm::vec<length, bool>& condition, const glm::vec<length, T>& if_true,
                                     const glm::vec<length, T>& if_false) {
  return each([](bool c, T x, T y) { return c ? x : y; }, condition, if_true, if_false);
}

// Arithmetic.

/// Integers wrap; a float changes its sign, which GLM's -vec4, 0 - v, does not do to a zero.
template <typename T>
constexpr T negate(const T& a) {
  using C = component_t<T>;
  return each(
      [](C x) {
        if constexpr (std::is_integral_v<C>)
          return static_cast<C>(0 - static_cast<std::make_unsigned_t<C>>(x));
        else
          return -x;
      },
      a);
}

/// Truncated quotient, as lavapipe gives it: x / 0 is 0 of signed numbers and all bits set of unsigned ones,
/// INT_MIN / -1 is INT_MIN.
template <typename T>
constexpr T divide(const T& a, const T& b) {
  using C = component_t<T>;
  return each(
      [](C x, C y) {
        if (y == 0) return static_cast<C>(std::is_signed_v<C> ? 0 : -1);
        if constexpr (std::is_signed_v<C>)
          if (y == -1) return kernel::negate(x);
        return static_cast<C>(x / y);
      },
      a, b);
}

/// Remainder with the sign of `a`; x rem 0 is -1 (all bits set).
template <typename T>
constexpr T remainder(const T& a, const T& b) {
  using C = component_t<T>;
  return each(
      [](C x, C y) {
        if (y == 0) return static_cast<C>(-1);
        if constexpr (std::is_signed_v<C>)
          if (y == -1) return C{0};
        return static_cast<C>(x % y);
      },
      a, b);
}

/// Remainder with the sign of `b`.
template <typename T>
constexpr T modulo(const T& a, const T& b) {
  using C = component_t<T>;
  return each(
      [](C x, C y) {
        const C r = kernel::remainder(x, y);
        return y != 0 && r != 0 && (r < 0) != (y < 0) ? static_cast<C>(r + y) : r;
      },
      a, b);
}

// Shifts take the count modulo the width, as x86 and Mesa do.

template <typename T, typename Count>
constexpr T shift_left(const T& a, const Count& count) {
  using C = component_t<T>;
  using U = std::make_unsigned_t<C>;
  return each(
      [](C x, auto n) {
        return static_cast<C>(static_cast<U>(static_cast<std::uint64_t>(static_cast<U>(x))
                                             << (static_cast<unsigned>(n) & (8 * sizeof(C) - 1))));
      },
      a, count);
}
/// Arithmetic for a signed T, logical for an unsigned one.
template <typename T, typename Count>
constexpr T shift_right(const T& a, const Count& count) {
  using C = component_t<T>;
  return each([](C x, auto n) { return static_cast<C>(x >> (static_cast<unsigned>(n) & (8 * sizeof(C) - 1))); }, a,
              count);
}

// Conversions.

/// What a function computes with before it rounds to its result, once: the type itself, or float for a half.
constexpr float widened(float x) { return x; }
constexpr double widened(double x) { return x; }

/// Component-wise static_cast where that is defined for every value.
template <typename To, typename From>
constexpr To convert(const From& from) {
  using C = component_t<To>;
  return each([](auto x) { return static_cast<C>(x); }, from);
}

/// An integer that a float became. With -fno-trapping-math g++ would make trunc(x), -0 of a negative fraction, of
/// float(int(x)), which is +0.
template <typename T>
constexpr T integer_of(T x) {
  if (!std::is_constant_evaluated()) asm("" : "+r"(x));
  return x;
}

/// Truncation towards zero; the smallest integer when out of range or NaN, as x86 gives.
template <typename To, typename From>
constexpr To float_to_signed(const From& from) {
  using C = component_t<To>;
  using F = component_t<From>;
  return each(
      [](F narrow) {
        const auto x = widened(narrow);
        constexpr auto limit = static_cast<std::remove_const_t<decltype(x)>>(std::uint64_t{1} << (8 * sizeof(C) - 1));
        return x >= -limit && x < limit ? integer_of(static_cast<C>(x)) : std::numeric_limits<C>::min();
      },
      from);
}

/// Truncation towards zero, clamped to the range of To; NaN gives 0.
template <typename To, typename From>
constexpr To float_to_unsigned(const From& from) {
  using C = component_t<To>;
  using F = component_t<From>;
  return each(
      [](F narrow) {
        const auto x = widened(narrow);
        using W = std::remove_const_t<decltype(x)>;
        constexpr W limit = W{2} * static_cast<W>(std::uint64_t{1} << (8 * sizeof(C) - 1));
        if (!(x > W{-1})) return C{0};
        return x < limit ? integer_of(static_cast<C>(x)) : std::numeric_limits<C>::max();
      },
      from);
}

}  // namespace tandem::kernel
