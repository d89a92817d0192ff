#include "compare/geometry/rounding.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tandem::compare {

double rounding_distance(double magnitude) {
  return tolerated_ulp * double{std::numeric_limits<float>::epsilon()} * magnitude;
}

double largest_magnitude(const glm::dvec3& v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); }

}  // namespace tandem::compare
