#pragma once

#include "rhi_cpu/kernel/lanes.hpp"
#include "rhi_cpu/kernel/wide/functions.hpp"

/// Subgroup operations of the lanes that execute together.
namespace tandem::kernel {

inline Lanes<std::uint32_t> quad_source(const Lanes<std::uint32_t>& lane, const Lanes<std::uint32_t>& index) {
  return each([](std::uint32_t a, std::uint32_t b) { return kernel::quad_source(a, b); }, lane, index);
}
inline Lanes<std::uint32_t> quad_neighbour(const Lanes<std::uint32_t>& lane, const Lanes<std::uint32_t>& direction) {
  return each([](std::uint32_t a, std::uint32_t b) { return kernel::quad_neighbour(a, b); }, lane, direction);
}
inline Lanes<std::uint32_t> rotated_source(const Lanes<std::uint32_t>& lane, const Lanes<std::uint32_t>& delta,
                                           const Lanes<std::uint32_t>& cluster) {
  return each([](std::uint32_t a, std::uint32_t b, std::uint32_t c) { return kernel::rotated_source(a, b, c); }, lane,
              delta, cluster);
}

/// f(lane) of every lane.
template <typename Function>
inline auto of_lanes(const Function& f) {
  wide_t<decltype(f(0u))> result;
  for (int i = 0; i < lane_count; ++i) kernel::set_lane(result, i, f(static_cast<std::uint32_t>(i)));
  return result;
}

/// What kernel::Lane is for an invocation that is a fibre.
class Together {
 public:
  explicit Together(Mask mask) : active_(bits_of(mask)) {}

  void meet() const {}
  Mask is_elected() const {
    Mask result = false;
    result.set(static_cast<int>(first_lane(active_)), true);
    return result;
  }

  template <typename Operation, typename T>
  wide_t<T> apply(const wide_t<T>& value) const {
    T values[lane_count];
    to_array(value, values);
    Operation::run(values, active_);
    return from_array(values);
  }

  template <typename Operation, typename T>
  auto agree(const wide_t<T>& value) const {
    T values[lane_count];
    to_array(value, values);
    return kernel::spread(Operation::run(values, active_));
  }

  template <typename T>
  wide_t<T> exchange(const wide_t<T>& value, const Lanes<std::uint32_t>& sources) const {
    T values[lane_count];
    to_array(value, values);
    std::uint32_t from[lane_count];
    to_array(sources, from);
    kernel::shuffle<lane_count>(values, from, active_);
    return from_array(values);
  }

 private:
  template <typename T>
  static void to_array(const wide_t<T>& value, T (&values)[lane_count]) {
    for (int i = 0; i < lane_count; ++i) values[i] = kernel::lane(value, i);
  }
  template <typename T>
  static wide_t<T> from_array(const T (&values)[lane_count]) {
    wide_t<T> value;
    for (int i = 0; i < lane_count; ++i) kernel::set_lane(value, i, values[i]);
    return value;
  }

  LaneMask active_;
};

}  // namespace tandem::kernel
