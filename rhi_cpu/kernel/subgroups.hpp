#pragma once

#include <bit>
#include <cstdint>
#include <limits>
#include <type_traits>

#include "rhi_cpu/kernel/components.hpp"
#include "rhi_cpu/kernel/group_limits.hpp"
#include "rhi_cpu/kernel/types.hpp"

/// Subgroup operations as functions of the values of all invocations of a subgroup, and of a mask of those that take
/// part. Values of the others are neither read nor written. Invocations are called lanes here, `width` is the size of a
/// subgroup: a power of two, at most max_subgroup_size. Scalars and vectors, whose components are independent.
namespace tandem::kernel {

/// Bit i: lane i takes part.
using LaneMask = std::uint32_t;

/// The lanes [0, count).
constexpr LaneMask lanes_below(std::uint32_t count) {
  return count >= max_subgroup_size ? ~LaneMask{0} : (LaneMask{1} << count) - 1;
}
constexpr bool has_lane(LaneMask lanes, std::uint32_t lane) { return (lanes >> lane & 1) != 0; }
constexpr std::uint32_t first_lane(LaneMask lanes) { return static_cast<std::uint32_t>(std::countr_zero(lanes)); }

/// visit(lane) for each lane of the mask, the lowest first.
template <typename Visit>
constexpr void for_each_lane(LaneMask lanes, const Visit& visit) {
  for (; lanes != 0; lanes &= lanes - 1) visit(first_lane(lanes));
}

// What values are combined with: of(a, b), and the identity, of components C. And, Or and Xor of bools are the logical
// ones.

struct Sum {
  template <typename C>
  static constexpr C identity() {
    return static_cast<C>(0);
  }
  template <typename C>
  static constexpr C of(C a, C b) {
    return static_cast<C>(a + b);
  }
};
struct Product {
  template <typename C>
  static constexpr C identity() {
    return static_cast<C>(1);
  }
  template <typename C>
  static constexpr C of(C a, C b) {
    return static_cast<C>(a * b);
  }
};
/// An infinity for floats.
struct Least {
  template <typename C>
  static constexpr C identity() {
    using Numbers = std::numeric_limits<C>;
    return Numbers::has_infinity ? Numbers::infinity() : Numbers::max();
  }
  template <typename C>
  static constexpr C of(C a, C b) {
    return b < a ? b : a;
  }
};
struct Greatest {
  template <typename C>
  static constexpr C identity() {
    using Numbers = std::numeric_limits<C>;
    if constexpr (Numbers::has_infinity)
      return -Numbers::infinity();
    else
      return Numbers::min();
  }
  template <typename C>
  static constexpr C of(C a, C b) {
    return a < b ? b : a;
  }
};
struct And {
  template <typename C>
  static constexpr C identity() {
    return static_cast<C>(-1);
  }
  template <typename C>
  static constexpr C of(C a, C b) {
    return static_cast<C>(a & b);
  }
};
struct Or {
  template <typename C>
  static constexpr C identity() {
    return static_cast<C>(0);
  }
  template <typename C>
  static constexpr C of(C a, C b) {
    return static_cast<C>(a | b);
  }
};
struct Xor {
  template <typename C>
  static constexpr C identity() {
    return static_cast<C>(0);
  }
  template <typename C>
  static constexpr C of(C a, C b) {
    return static_cast<C>(a ^ b);
  }
};

template <typename Operation, typename T>
constexpr T combined(const T& a, const T& b) {
  return each([](auto x, auto y) { return Operation::of(x, y); }, a, b);
}

// Arithmetic. Values are combined one after the other, the lowest lane first, ((identity + v0) + v1) + v2..., which
// fixes how floats round. Mesa's CPU driver has the same order.

template <typename Operation, typename T>
constexpr T identity_of() {
  return T(Operation::template identity<component_t<T>>());
}

/// Each lane gets the combination of all lanes of its cluster, `cluster` consecutive lanes, a power of two.
template <typename Operation, std::uint32_t width, typename T>
constexpr void reduce(T* values, LaneMask active, std::uint32_t cluster = width) {
  if (cluster == 0 || cluster > width) cluster = width;
  for (std::uint32_t first = 0; first < width; first += cluster) {
    const LaneMask part = active & (lanes_below(cluster) << first);
    T result = identity_of<Operation, T>();
    for_each_lane(part, [&](std::uint32_t lane) { result = combined<Operation>(result, values[lane]); });
    for_each_lane(part, [&](std::uint32_t lane) { values[lane] = result; });
  }
}

/// Each lane gets the combination of the lanes up to itself.
template <typename Operation, std::uint32_t width, typename T>
constexpr void inclusive_scan(T* values, LaneMask active) {
  T result = identity_of<Operation, T>();
  for_each_lane(active, [&](std::uint32_t lane) { values[lane] = result = combined<Operation>(result, values[lane]); });
}

/// Each lane gets the combination of the lanes before it; the lowest one the identity.
template <typename Operation, std::uint32_t width, typename T>
constexpr void exclusive_scan(T* values, LaneMask active) {
  T result = identity_of<Operation, T>();
  for_each_lane(active, [&](std::uint32_t lane) {
    const T own = values[lane];
    values[lane] = result;
    result = combined<Operation>(result, own);
  });
}

// Votes and ballots.

constexpr bool all_of(const bool* values, LaneMask active) {
  bool result = true;
  for_each_lane(active, [&](std::uint32_t lane) { result &= values[lane]; });
  return result;
}

constexpr bool any_of(const bool* values, LaneMask active) {
  bool result = false;
  for_each_lane(active, [&](std::uint32_t lane) { result |= values[lane]; });
  return result;
}

/// Whether all have the same value, in all components; a NaN has none.
template <typename T>
constexpr bool all_equal(const T* values, LaneMask active) {
  const T& first = values[first_lane(active)];
  bool result = true;
  for_each_lane(active, [&](std::uint32_t lane) {
    const auto same = kernel::equal(values[lane], first);
    if constexpr (length_of<T> == 0)
      result &= same;
    else
      result &= kernel::all(same);
  });
  return result;
}

constexpr uvec4 ballot_of(LaneMask lanes) { return uvec4(lanes, 0, 0, 0); }

/// The lanes whose value is true.
constexpr uvec4 ballot(const bool* values, LaneMask active) {
  LaneMask lanes = 0;
  for_each_lane(active, [&](std::uint32_t lane) { lanes |= LaneMask{values[lane]} << lane; });
  return ballot_of(lanes);
}

/// The value of the lowest lane.
template <typename T>
constexpr T value_of_first(const T* values, LaneMask active) {
  return values[first_lane(active)];
}

// What a ballot says, which no other lane needs to be asked for.

constexpr bool ballot_bit(const uvec4& value, std::uint32_t lane) {
  return (value[static_cast<int>(lane / 32 % 4)] >> lane % 32 & 1) != 0;
}
/// How many of `lanes` are in the ballot.
constexpr std::uint32_t ballot_count(const uvec4& value, LaneMask lanes) {
  return static_cast<std::uint32_t>(std::popcount(value.x & lanes));
}
/// The lowest and the highest lane of a ballot, all bits set when there is none.
template <std::uint32_t width>
constexpr std::uint32_t ballot_lowest(const uvec4& value) {
  const LaneMask lanes = value.x & lanes_below(width);
  return lanes == 0 ? ~0u : first_lane(lanes);
}
template <std::uint32_t width>
constexpr std::uint32_t ballot_highest(const uvec4& value) {
  return static_cast<std::uint32_t>(std::bit_width(value.x & lanes_below(width))) - 1u;
}

// gl_SubgroupEqMask and its like, of a lane.

template <std::uint32_t width>
constexpr uvec4 mask_equal(std::uint32_t lane) {
  return ballot_of(LaneMask{1} << lane);
}
template <std::uint32_t width>
constexpr uvec4 mask_less(std::uint32_t lane) {
  return ballot_of(lanes_below(lane));
}
template <std::uint32_t width>
constexpr uvec4 mask_less_equal(std::uint32_t lane) {
  return ballot_of(lanes_below(lane + 1));
}
template <std::uint32_t width>
constexpr uvec4 mask_greater(std::uint32_t lane) {
  return ballot_of(lanes_below(width) & ~lanes_below(lane + 1));
}
template <std::uint32_t width>
constexpr uvec4 mask_greater_equal(std::uint32_t lane) {
  return ballot_of(lanes_below(width) & ~lanes_below(lane));
}

// Shuffles: each lane says where its new value comes from.

/// Each lane gets the value of lane sources[lane]; zero of one that does not take part or does not exist.
template <std::uint32_t width, typename T>
constexpr void shuffle(T* values, const std::uint32_t* sources, LaneMask active) {
  T before[width] = {};
  for_each_lane(active, [&](std::uint32_t lane) { before[lane] = values[lane]; });
  for_each_lane(active,
                [&](std::uint32_t lane) { values[lane] = sources[lane] < width ? before[sources[lane]] : T{}; });
}

/// The source of a lane in its quad, four consecutive lanes.
constexpr std::uint32_t quad_source(std::uint32_t lane, std::uint32_t index) { return (lane & ~3u) | (index & 3u); }
/// The neighbour of a lane in its quad: 0 across, 1 down, 2 both.
constexpr std::uint32_t quad_neighbour(std::uint32_t lane, std::uint32_t direction) { return lane ^ (direction + 1); }
/// The source of a lane whose cluster is rotated by `delta`.
constexpr std::uint32_t rotated_source(std::uint32_t lane, std::uint32_t delta, std::uint32_t cluster) {
  return (lane & ~(cluster - 1)) | ((lane + delta) & (cluster - 1));
}

}  // namespace tandem::kernel
