#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

namespace tandem::test {

/// Whether two floats are at most two units in the last place of the larger one apart. Embree computes t and
/// barycentrics with the processor's approximate reciprocal and one step of Newton's method: of simple numbers the
/// result is exact on a processor with AVX-512, and up to two units off on others.
inline bool within_few_ulp(float a, float b) {
  const float larger = std::max(std::abs(a), std::abs(b));
  return a == b || std::abs(a - b) <= 2 * (std::nextafter(larger, std::numeric_limits<float>::infinity()) - larger);
}

/// The whole number that the value is so close to, else the value.
inline float whole_if_close(float value) {
  const float whole = std::round(value);
  return within_few_ulp(value, whole) ? whole : value;
}

}  // namespace tandem::test
