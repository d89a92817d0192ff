#pragma once

#include "rhi_cpu/kernel/bits.hpp"
#include "rhi_cpu/kernel/math.hpp"
#include "rhi_cpu/kernel/matrices.hpp"
#include "rhi_cpu/kernel/wide/lanes.hpp"

/// Functions of kernel/ that work on all lanes at once where the template of the same name would go from lane to lane.
/// Each gives every lane the bits that the scalar function gives.
namespace tandem::kernel {

inline std::uint32_t bits_of(Mask mask) {
  // Named here, because <immintrin.h> takes the compiler longer than all of a small kernel.
#if defined(__AVX512DQ__) && TANDEM_LANES == 16
  return __builtin_ia32_cvtd2mask512(mask.of_lane);
#elif defined(__AVX__) && TANDEM_LANES == 8
  return static_cast<std::uint32_t>(__builtin_ia32_movmskps256(reinterpret_cast<Lanes<float>::Register>(mask.of_lane)));
#elif defined(__SSE2__) && TANDEM_LANES == 4
  return static_cast<std::uint32_t>(__builtin_ia32_movmskps(reinterpret_cast<Lanes<float>::Register>(mask.of_lane)));
#else
  std::uint32_t bits = 0;
  for (int i = 0; i < lane_count; ++i) bits |= static_cast<std::uint32_t>(mask[i]) << i;
  return bits;
#endif
}
inline bool any_of(Mask mask) { return bits_of(mask) != 0; }
inline constexpr std::uint32_t all_bits = lane_count == 32 ? ~0u : (1u << lane_count) - 1u;

/// An index that is not the same in all lanes, in [0, lane_count).
inline Lanes<std::uint32_t> lane_indices() {
  Lanes<std::uint32_t> indices;
  for (int i = 0; i < lane_count; ++i) indices.set(i, static_cast<std::uint32_t>(i));
  return indices;
}

#define TANDEM_OF_COMPONENTS_1(name)                                 \
  template <int length, typename T>                                  \
  inline auto name(const glm::vec<length, Lanes<T>>& a) {            \
    glm::vec<length, decltype(kernel::name(a[0]))> result;           \
    for (int i = 0; i < length; ++i) result[i] = kernel::name(a[i]); \
    return result;                                                   \
  }
#define TANDEM_OF_COMPONENTS_2(name)                                                           \
  template <int length, typename T>                                                            \
  inline auto name(const glm::vec<length, Lanes<T>>& a, const glm::vec<length, Lanes<T>>& b) { \
    glm::vec<length, decltype(kernel::name(a[0], b[0]))> result;                               \
    for (int i = 0; i < length; ++i) result[i] = kernel::name(a[i], b[i]);                     \
    return result;                                                                             \
  }
#define TANDEM_OF_COMPONENTS_3(name)                                                         \
  template <int length, typename T>                                                          \
  inline auto name(const glm::vec<length, Lanes<T>>& a, const glm::vec<length, Lanes<T>>& b, \
                   const glm::vec<length, Lanes<T>>& c) {                                    \
    glm::vec<length, decltype(kernel::name(a[0], b[0], c[0]))> result;                       \
    for (int i = 0; i < length; ++i) result[i] = kernel::name(a[i], b[i], c[i]);             \
    return result;                                                                           \
  }

// Relations.

#define TANDEM_RELATION(name, expression)                  \
  template <typename T>                                    \
  inline Mask name(const Lanes<T>& a, const Lanes<T>& b) { \
    return expression;                                     \
  }                                                        \
  TANDEM_OF_COMPONENTS_2(name)
TANDEM_RELATION(equal, a == b)
TANDEM_RELATION(not_equal, a != b)
TANDEM_RELATION(less, a < b)
TANDEM_RELATION(less_equal, a <= b)
TANDEM_RELATION(greater, a > b)
TANDEM_RELATION(greater_equal, a >= b)
TANDEM_RELATION(ordered_not_equal, a<b || a> b)
TANDEM_RELATION(unordered_equal, !(a < b || a > b))
TANDEM_RELATION(unordered_less, !(a >= b))
TANDEM_RELATION(unordered_less_equal, !(a > b))
TANDEM_RELATION(unordered_greater, !(a <= b))
TANDEM_RELATION(unordered_greater_equal, !(a < b))
TANDEM_RELATION(ordered, a == a && b == b)
TANDEM_RELATION(unordered, a != a || b != b)
#undef TANDEM_RELATION

template <typename T>
inline Mask is_nan(const Lanes<T>& a) {
  return a != a;
}
TANDEM_OF_COMPONENTS_1(is_nan)

inline Mask logical_and(const Mask& a, const Mask& b) { return a && b; }
TANDEM_OF_COMPONENTS_2(logical_and)
inline Mask logical_or(const Mask& a, const Mask& b) { return a || b; }
TANDEM_OF_COMPONENTS_2(logical_or)
inline Mask logical_not(const Mask& a) { return !a; }
TANDEM_OF_COMPONENTS_1(logical_not)

template <int length>
inline Mask any(const glm::vec<length, Mask>& a) {
  Mask result = a[0];
  for (int i = 1; i < length; ++i) result = result || a[i];
  return result;
}
template <int length>
inline Mask all(const glm::vec<length, Mask>& a) {
  Mask result = a[0];
  for (int i = 1; i < length; ++i) result = result && a[i];
  return result;
}

// Arithmetic.

template <typename T>
inline Lanes<T> negate(const Lanes<T>& a) {
  return -a;
}
TANDEM_OF_COMPONENTS_1(negate)

template <typename T>
inline Lanes<T> min(const Lanes<T>& a, const Lanes<T>& b) {
  if constexpr (std::is_integral_v<T>)
    return kernel::select(b < a, b, a);
  else
    return kernel::select(b < a || a != a, b, a);
}
TANDEM_OF_COMPONENTS_2(min)
template <typename T>
inline Lanes<T> max(const Lanes<T>& a, const Lanes<T>& b) {
  if constexpr (std::is_integral_v<T>)
    return kernel::select(a < b, b, a);
  else
    return kernel::select(a < b || a != a, b, a);
}
TANDEM_OF_COMPONENTS_2(max)
template <typename T>
inline Lanes<T> clamp(const Lanes<T>& a, const Lanes<T>& low, const Lanes<T>& high) {
  return kernel::min(kernel::max(a, low), high);
}
TANDEM_OF_COMPONENTS_3(clamp)

inline Lanes<float> abs(const Lanes<float>& a) {
  using Bits = Lanes<std::uint32_t>::Register;
  return Lanes<float>(reinterpret_cast<Lanes<float>::Register>(reinterpret_cast<Bits>(a.of_lane) & 0x7fffffffu));
}
inline Lanes<std::int32_t> abs(const Lanes<std::int32_t>& a) { return kernel::select(a < 0, -a, a); }
inline glm::vec<2, Lanes<float>> abs(const glm::vec<2, Lanes<float>>& a) { return {abs(a.x), abs(a.y)}; }
inline glm::vec<3, Lanes<float>> abs(const glm::vec<3, Lanes<float>>& a) { return {abs(a.x), abs(a.y), abs(a.z)}; }
inline glm::vec<4, Lanes<float>> abs(const glm::vec<4, Lanes<float>>& a) {
  return {abs(a.x), abs(a.y), abs(a.z), abs(a.w)};
}
template <typename T>
inline Lanes<T> sign(const Lanes<T>& a) {
  return kernel::select(a > T{0}, Lanes<T>(T{1}),
                        kernel::select(a < T{0}, Lanes<T>(static_cast<T>(-1)), Lanes<T>(T{0})));
}
TANDEM_OF_COMPONENTS_1(sign)
template <typename T>
inline Lanes<T> step(const Lanes<T>& edge, const Lanes<T>& a) {
  return kernel::select(a < edge, Lanes<T>(T{0}), Lanes<T>(T{1}));
}
TANDEM_OF_COMPONENTS_2(step)

// The compiler makes one instruction of each loop.
#define TANDEM_ROUNDING(name, builtin)                                              \
  inline Lanes<float> name(const Lanes<float>& a) {                                 \
    Lanes<float> result;                                                            \
    for (int i = 0; i < lane_count; ++i) result.of_lane[i] = builtin(a.of_lane[i]); \
    return result;                                                                  \
  }                                                                                 \
  TANDEM_OF_COMPONENTS_1(name)
TANDEM_ROUNDING(sqrt, __builtin_sqrtf)
#if defined(__SSE4_1__)
TANDEM_ROUNDING(floor, __builtin_floorf)
TANDEM_ROUNDING(ceil, __builtin_ceilf)
TANDEM_ROUNDING(trunc, __builtin_truncf)
TANDEM_ROUNDING(round_even, __builtin_rintf)  // nobody changes how this rounds
#else
TANDEM_OF_COMPONENTS_1(floor)
TANDEM_OF_COMPONENTS_1(ceil)
TANDEM_OF_COMPONENTS_1(trunc)
TANDEM_OF_COMPONENTS_1(round_even)
#endif
#undef TANDEM_ROUNDING

inline Lanes<float> inverse_sqrt(const Lanes<float>& a) { return Lanes<float>(1.0f) / kernel::sqrt(a); }
TANDEM_OF_COMPONENTS_1(inverse_sqrt)
template <typename T>
inline Lanes<T> fract(const Lanes<T>& a) {
  return a - kernel::floor(a);
}
TANDEM_OF_COMPONENTS_1(fract)
template <typename T>
inline Lanes<T> float_modulo(const Lanes<T>& a, const Lanes<T>& b) {
  return a - b * kernel::floor(a / b);
}
TANDEM_OF_COMPONENTS_2(float_modulo)
template <typename T>
inline Lanes<T> float_remainder(const Lanes<T>& a, const Lanes<T>& b) {
  return a - b * kernel::trunc(a / b);
}
TANDEM_OF_COMPONENTS_2(float_remainder)
template <typename T>
inline Lanes<T> smooth_step(const Lanes<T>& low, const Lanes<T>& high, const Lanes<T>& a) {
  const Lanes<T> t = kernel::clamp((a - low) / (high - low), Lanes<T>(T{0}), Lanes<T>(T{1}));
  return t * (t * (Lanes<T>(T{3}) - Lanes<T>(T{2}) * t));
}
TANDEM_OF_COMPONENTS_3(smooth_step)

// Shifts.

template <typename T, typename Count>
requires(sizeof(T) == 4 && sizeof(Count) == 4) inline Lanes<T> shift_left(const Lanes<T>& a,
                                                                          const Lanes<Count>& count) {
  return Lanes<T>(a.of_lane << reinterpret_cast<typename Lanes<T>::Register>(count.of_lane & Count{31}));
}
template <typename T, typename Count>
requires(sizeof(T) == 4 && sizeof(Count) == 4) inline Lanes<T> shift_right(const Lanes<T>& a,
                                                                           const Lanes<Count>& count) {
  return Lanes<T>(a.of_lane >> reinterpret_cast<typename Lanes<T>::Register>(count.of_lane & Count{31}));
}

// Conversions.

template <typename To, typename From>
requires(is_lanes<To>) inline To convert(const Lanes<From>& from) {
  if constexpr (has_registers<component_t<To>> && has_registers<From>)
    return To(__builtin_convertvector(from.of_lane, typename To::Register));
  else
    return each([](From x) { return static_cast<component_t<To>>(x); }, from);
}
template <typename To, typename From>
requires(has_registers<From>&& std::is_same_v<To, Lanes<std::int32_t>>) inline To
    float_to_signed(const Lanes<From>& from) {
#if defined(__AVX__) && TANDEM_LANES == 8
  // What the instruction makes of numbers out of range is what is asked for.
  if constexpr (std::is_same_v<From, float>) return To(__builtin_ia32_cvttps2dq256(from.of_lane));
#elif defined(__SSE2__) && TANDEM_LANES == 4
  if constexpr (std::is_same_v<From, float>) return To(__builtin_ia32_cvttps2dq(from.of_lane));
#endif
  constexpr From limit = 2147483648.0f;
  const Mask inside = from >= -limit && from < limit;
  const Lanes<From> x = kernel::select(inside, from, Lanes<From>(-limit));
  return To(__builtin_convertvector(x.of_lane, typename To::Register));
}
template <typename To, typename From>
requires(has_registers<From>&& std::is_same_v<To, Lanes<std::uint32_t>>) inline To
    float_to_unsigned(const Lanes<From>& from) {
  constexpr From limit = 4294967296.0f;
  const Mask positive = from > From{-1}, inside = from < limit;
  const Lanes<From> x = kernel::select(positive && inside, from, Lanes<From>(From{0}));
  const To converted(__builtin_convertvector(x.of_lane, typename To::Register));
  return kernel::select(positive, kernel::select(inside, converted, To(~0u)), To(0u));
}

#undef TANDEM_OF_COMPONENTS_1
#undef TANDEM_OF_COMPONENTS_2
#undef TANDEM_OF_COMPONENTS_3

}  // namespace tandem::kernel
