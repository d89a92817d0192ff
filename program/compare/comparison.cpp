#include "program/compare/comparison.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "program/data/scalar.hpp"

namespace tandem::program {
namespace {

constexpr std::uint64_t most = std::numeric_limits<std::uint64_t>::max();

/// The bits as a number whose order is that of the values, -0 beside 0.
std::uint64_t ordered(ScalarType scalar, std::uint64_t bits) {
  const std::uint64_t sign = std::uint64_t{1} << (8 * size_of(scalar) - 1);
  if (!is_signed(scalar)) return bits;
  if (!is_floating(scalar)) return bits ^ sign;
  return (bits & sign) != 0 ? sign - (bits & ~sign) : sign + bits;
}

struct Distance {
  std::uint64_t ulp = 0;
  double relative = 0;
  double absolute = 0;
};

Distance distance(ScalarType scalar, std::uint64_t a, std::uint64_t b) {
  const std::uint64_t ulp = ulp_distance(scalar, a, b);
  // Whole numbers of 64 bits are no doubles, but their difference is known.
  const double x = number_of(scalar, a), y = number_of(scalar, b);
  const double absolute = is_floating(scalar) ? std::fabs(x - y) : static_cast<double>(ulp);
  const double larger = std::max(std::fabs(x), std::fabs(y));
  if (!std::isfinite(absolute) || !std::isfinite(larger))
    return {.ulp = ulp, .relative = std::numeric_limits<double>::infinity(), .absolute = absolute};
  return {.ulp = ulp, .relative = larger == 0 ? 0 : absolute / larger, .absolute = absolute};
}

class Comparer {
 public:
  Comparer(const ValueType& type, std::span<const std::byte> a, std::span<const std::byte> b,
           const Tolerance& tolerance)
      : type_(type), a_(a), b_(b), tolerance_(tolerance) {}

  void compare(const Place& place) {
    const std::uint64_t index = result_.scalars++;
    const std::uint64_t a = bits_at(a_, place), b = bits_at(b_, place);
    if (a == b) {
      ++result_.bit_equal;
      ++result_.within;
      return;
    }
    const bool a_is_nan = std::isnan(number_of(place.scalar, a)), b_is_nan = std::isnan(number_of(place.scalar, b));
    Distance far;
    if (a_is_nan || b_is_nan) {
      if (a_is_nan != b_is_nan) {
        far.relative = std::numeric_limits<double>::infinity();
        ++(a_is_nan ? result_.nan_a : result_.nan_b);
      }
    } else {
      far = distance(place.scalar, a, b);
      result_.largest_ulp = std::max(result_.largest_ulp, far.ulp);
      if (std::isfinite(far.absolute)) result_.largest_absolute = std::max(result_.largest_absolute, far.absolute);
    }
    result_.largest_relative = std::max(result_.largest_relative, far.relative);
    const bool agrees =
        a_is_nan || b_is_nan ? a_is_nan && b_is_nan : far.ulp <= tolerance_.ulp || far.relative <= tolerance_.relative;
    result_.within += agrees ? 1 : 0;
    if (!result_.first) result_.first = difference(index, place, far);
    if (!result_.worst || far.relative > result_.worst->relative) result_.worst = difference(index, place, far);
    if (!agrees && !result_.disagreed) result_.disagreed = difference(index, place, far);
  }

  Comparison result() {
    for (std::optional<Difference>* each : {&result_.first, &result_.worst, &result_.disagreed})
      if (*each) (*each)->path = path_of(type_, a_.size(), (*each)->index);
    return std::move(result_);
  }

 private:
  Difference difference(std::uint64_t index, const Place& place, const Distance& far) const {
    return {.index = index,
            .a = to_text(place.scalar, bits_at(a_, place)),
            .b = to_text(place.scalar, bits_at(b_, place)),
            .ulp = far.ulp,
            .relative = far.relative};
  }

  const ValueType& type_;
  std::span<const std::byte> a_, b_;
  Tolerance tolerance_;
  Comparison result_;
};

}  // namespace

std::uint64_t ulp_distance(ScalarType scalar, std::uint64_t a, std::uint64_t b) {
  if (std::isnan(number_of(scalar, a)) || std::isnan(number_of(scalar, b))) return most;
  const std::uint64_t x = ordered(scalar, a), y = ordered(scalar, b);
  return x > y ? x - y : y - x;
}

Comparison compare(const ValueType& type, std::span<const std::byte> a, std::span<const std::byte> b,
                   const Tolerance& tolerance) {
  if (std::ranges::equal(a, b)) {
    const std::uint64_t count = scalar_count(type, a.size());
    return {.scalars = count, .bit_equal = count, .within = count};
  }
  Comparer comparer(type, a, b, tolerance);
  for_each_place(type, a.size(), [&](const Place& place) { comparer.compare(place); });
  return comparer.result();
}

}  // namespace tandem::program
