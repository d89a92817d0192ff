#pragma once

#include <bit>
#include <cstdint>
#include <type_traits>

#include "rhi_cpu/kernel/components.hpp"

/// GLSL's bit functions, on integers of 32 bits and their vectors, and integer arithmetic with a double-width result.
namespace tandem::kernel {

/// A mask of the `count` lowest bits, 0 <= count.
constexpr std::uint32_t low_bits(std::uint32_t count) { return count >= 32 ? ~0u : (1u << count) - 1u; }

/// Bits [offset, offset + count) of `a`, sign-extended for a signed T. Counts that reach beyond bit 31 are undefined in
/// SPIR-V; the bits beyond read as zero or sign here.
template <typename T>
constexpr T bitfield_extract(const T& a, int offset, int count) {
  using C = component_t<T>;
  return each(
      [=](C x) {
        if (count <= 0) return C{0};
        const std::uint32_t field =
            (static_cast<std::uint32_t>(x) >> (offset & 31)) & low_bits(static_cast<std::uint32_t>(count));
        if constexpr (std::is_signed_v<C>) {
          const int unused = count >= 32 ? 0 : 32 - count;
          return static_cast<C>(static_cast<std::int32_t>(field << unused) >> unused);
        } else {
          return static_cast<C>(field);
        }
      },
      a);
}

/// `base` with the bits [offset, offset + count) replaced by the low bits of `insert`.
template <typename T>
constexpr T bitfield_insert(const T& base, const T& insert, int offset, int count) {
  using C = component_t<T>;
  return each(
      [=](C x, C y) {
        if (count <= 0) return x;
        const std::uint32_t mask = low_bits(static_cast<std::uint32_t>(count)) << (offset & 31);
        return static_cast<C>((static_cast<std::uint32_t>(x) & ~mask) |
                              ((static_cast<std::uint32_t>(y) << (offset & 31)) & mask));
      },
      base, insert);
}

template <typename T>
constexpr T bitfield_reverse(const T& a) {
  using C = component_t<T>;
  return each(
      [](C c) {
        auto x = static_cast<std::uint32_t>(c);
        x = ((x >> 1) & 0x55555555u) | ((x & 0x55555555u) << 1);
        x = ((x >> 2) & 0x33333333u) | ((x & 0x33333333u) << 2);
        x = ((x >> 4) & 0x0f0f0f0fu) | ((x & 0x0f0f0f0fu) << 4);
        x = ((x >> 8) & 0x00ff00ffu) | ((x & 0x00ff00ffu) << 8);
        return static_cast<C>((x >> 16) | (x << 16));
      },
      a);
}

template <typename T>
constexpr auto bit_count(const T& a) {
  return each([](auto x) { return static_cast<std::int32_t>(std::popcount(static_cast<std::uint32_t>(x))); }, a);
}

/// Position of the lowest set bit, -1 for 0.
template <typename T>
constexpr auto find_lsb(const T& a) {
  return each([](auto x) { return x == 0 ? -1 : std::countr_zero(static_cast<std::uint32_t>(x)); }, a);
}

/// Position of the highest set bit; of the highest bit that differs from the sign for a signed T. -1 when there is
/// none.
template <typename T>
constexpr auto find_msb(const T& a) {
  using C = component_t<T>;
  return each(
      [](C x) {
        auto bits = static_cast<std::uint32_t>(x);
        if constexpr (std::is_signed_v<C>)
          if (x < 0) bits = ~bits;
        return 31 - std::countl_zero(bits);
      },
      a);
}

/// 1 where a + b, of unsigned numbers, does not fit their width.
template <typename T>
constexpr T add_carry(const T& a, const T& b) {
  using C = component_t<T>;
  using U = std::make_unsigned_t<C>;
  return each([](C x, C y) { return static_cast<C>(static_cast<U>(U(x) + U(y)) < U(x)); }, a, b);
}
/// 1 where a < b, of unsigned numbers.
template <typename T>
constexpr T subtract_borrow(const T& a, const T& b) {
  using C = component_t<T>;
  using U = std::make_unsigned_t<C>;
  return each([](C x, C y) { return static_cast<C>(U(x) < U(y)); }, a, b);
}
/// The upper half of the product, which has twice the width.
template <typename T>
constexpr T multiply_high(const T& a, const T& b) {
  using C = component_t<T>;
  constexpr int width = 8 * sizeof(C);
  __extension__ using Signed = std::conditional_t<width == 64, __int128, std::int64_t>;
  __extension__ using Unsigned = std::conditional_t<width == 64, unsigned __int128, std::uint64_t>;
  using Wide = std::conditional_t<std::is_signed_v<C>, Signed, Unsigned>;
  return each([](C x, C y) { return static_cast<C>((static_cast<Wide>(x) * static_cast<Wide>(y)) >> width); }, a, b);
}

}  // namespace tandem::kernel
