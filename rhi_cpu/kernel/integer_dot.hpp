#pragma once

#include <cstdint>
#include <limits>
#include <type_traits>

#include "rhi_cpu/kernel/components.hpp"

/// SPV_KHR_integer_dot_product.
namespace tandem::kernel {

/// Four components of 8 bits, the first in the lowest bits.
template <typename Component, typename Word>
constexpr glm::vec<4, Component> unpack_4x8(Word word) {
  const auto bits = static_cast<std::uint32_t>(word);
  const auto component = [=](int i) { return static_cast<Component>(static_cast<std::uint8_t>(bits >> (8 * i))); };
  return {component(0), component(1), component(2), component(3)};
}

/// The low bits of a dot product whose components are extended to Result first.
template <typename Result, int length, typename A, typename B>
constexpr Result integer_dot(const glm::vec<length, A>& a, const glm::vec<length, B>& b) {
  std::uint64_t sum = 0;
  for (int i = 0; i < length; ++i) sum += static_cast<std::uint64_t>(a[i]) * static_cast<std::uint64_t>(b[i]);
  return static_cast<Result>(sum);
}

/// a + b, or the end of T's range that lies beyond.
template <typename T>
constexpr T add_saturated(T a, T b) {
  T sum{};
  if (!__builtin_add_overflow(a, b, &sum)) return sum;
  return b < 0 ? std::numeric_limits<T>::min() : std::numeric_limits<T>::max();
}

}  // namespace tandem::kernel
