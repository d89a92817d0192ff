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

/// Memory that addresses must stay inside of; without `data`, any.
struct Bounds {
  const std::byte* data = nullptr;
  std::size_t size = 0;

  bool contain(const std::byte* first, std::size_t extent) const {
    const auto offset = static_cast<std::size_t>(first - data);
    return data == nullptr || (size >= extent && offset <= size - extent);
  }
};

/// Lanes whose numbers are looked at together: a row of a workgroup of 8 times 8 is half of 16 lanes.
inline constexpr int row_length = lane_count < 8 ? lane_count : 8;

/// Whether all lanes execute, and the numbers of each row of lanes lie one after the other.
template <typename T>
inline bool are_in_rows(Mask mask, const Addresses& addresses, const Bounds& bounds) {
  Lanes<std::uint64_t> expected;
  for (int i = 0; i < lane_count; ++i)
    expected.set(
        i, addresses.of_lane[i / row_length * row_length] + static_cast<std::uint64_t>(i % row_length) * sizeof(T));
  if (bits_of(mask && addresses.of_lane == expected) != all_bits) return false;
  bool are_inside = true;
  for (int row = 0; row < lane_count; row += row_length)
    are_inside &= bounds.contain(addresses.lane(row), row_length * sizeof(T));
  return are_inside;
}

/// The numbers at the addresses, as `gather` gives them: at once where they are neighbours, as those of neighbouring
/// invocations often are, or one and the same.
template <typename T, typename Read>
inline Lanes<T> gather_numbers(Mask mask, const Addresses& addresses, const Bounds& bounds, const Read& read) {
  if (are_in_rows<T>(mask, addresses, bounds)) {
    Lanes<T> result;
    for (int row = 0; row < lane_count; row += row_length)
      std::memcpy(reinterpret_cast<T*>(&result.of_lane) + row, addresses.lane(row), row_length * sizeof(T));
    return result;
  }
  const Addresses safe = readable(mask, addresses);
  if (bits_of(safe.of_lane == Lanes<std::uint64_t>(safe.of_lane[0])) == all_bits)
    return Lanes<T>(read(static_cast<const std::byte*>(safe.lane(0))));
  return gather(safe, read);
}

/// Stores the numbers if they are neighbours. @return whether it has
template <typename T>
inline bool stored_in_rows(Mask mask, const Addresses& addresses, const Bounds& bounds, const Lanes<T>& value) {
  if (!are_in_rows<T>(mask, addresses, bounds)) return false;
  for (int row = 0; row < lane_count; row += row_length)
    std::memcpy(addresses.lane(row), reinterpret_cast<const T*>(&value.of_lane) + row, row_length * sizeof(T));
  return true;
}

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
