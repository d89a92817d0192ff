#pragma once

#include <bit>

#include "rhi_cpu/kernel/memory.hpp"
#include "rhi_cpu/kernel/wide/functions.hpp"

/// Loads of buffers by all lanes at once.
namespace tandem::kernel {

/// An address per lane, the twin of a pointer. Those of lanes that do not execute lead nowhere.
struct Addresses {
  using Narrow = std::byte*;
  Lanes<std::uint64_t> of_lane;

  Addresses() = default;
  Addresses(const std::byte* all) : of_lane(reinterpret_cast<std::uint64_t>(all)) {}
  explicit Addresses(Lanes<std::uint64_t> addresses) : of_lane(addresses) {}
  friend Addresses operator+(const Addresses& a, Lanes<std::uint64_t> distance) {
    return Addresses(a.of_lane + distance);
  }
  std::byte* lane(int lane) const { return reinterpret_cast<std::byte*>(of_lane[lane]); }
  void set_lane(int lane, std::byte* address) { of_lane.set(lane, reinterpret_cast<std::uint64_t>(address)); }
  static Addresses select(Mask mask, const Addresses& if_true, const Addresses& if_false) {
    return Addresses(kernel::select(mask, if_true.of_lane, if_false.of_lane));
  }
};
template <>
struct WideOf<std::byte*> {
  using type = Addresses;
};
inline Addresses operator+(const std::byte* base, const Lanes<std::uint64_t>& distance) {
  return Addresses(Lanes<std::uint64_t>(reinterpret_cast<std::uint64_t>(base)) + distance);
}

/// Addresses that all lanes may read: where the mask has none, one of another lane.
/// @param mask not empty
inline Addresses readable(Mask mask, const Addresses& addresses) {
  const std::uint64_t any = addresses.of_lane[std::countr_zero(bits_of(mask))];
  return Addresses(kernel::select(mask, addresses.of_lane, Lanes<std::uint64_t>(any)));
}

/// The values of read(address) at readable addresses.
template <typename Read>
inline auto gather(const Addresses& addresses, const Read& read) {
  wide_t<decltype(read(static_cast<const std::byte*>(nullptr)))> result;
#pragma GCC unroll 32
  for (int i = 0; i < lane_count; ++i) kernel::set_lane(result, i, read(kernel::lane(addresses, i)));
  return result;
}

/// lane_count values of any kind, one after the other.
template <typename T>
struct PerLane {
  T of_lane[lane_count];
  T& operator[](int lane) { return of_lane[lane]; }
};

/// The lanes of a mask, in order, for a loop.
class EachLane {
 public:
  explicit EachLane(Mask mask) : bits_(bits_of(mask)) {}
  struct Iterator {
    std::uint32_t bits;
    int operator*() const { return std::countr_zero(bits); }
    Iterator& operator++() {
      bits &= bits - 1;
      return *this;
    }
    bool operator!=(const Iterator& other) const { return bits != other.bits; }
  };
  Iterator begin() const { return {bits_}; }
  Iterator end() const { return {0}; }

 private:
  std::uint32_t bits_;
};

/// Local invocations [first, first + lane_count) of a workgroup of x times y times any.
template <uint x, uint y>
inline glm::vec<3, Lanes<uint>> local_invocations(uint first) {
  glm::vec<3, Lanes<uint>> ids;
  for (int i = 0; i < lane_count; ++i) {
    const uint index = first + static_cast<uint>(i);
    kernel::set_lane(ids, i, uvec3(index % x, index / x % y, index / (x * y)));
  }
  return ids;
}

}  // namespace tandem::kernel
