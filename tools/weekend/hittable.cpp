#include "tools/weekend/hittable.hpp"

#include <algorithm>

#include <glm/common.hpp>

namespace tandem::weekend {

Box around(const Box& a, const Box& b) {
  return {.minimum = glm::min(a.minimum, b.minimum), .maximum = glm::max(a.maximum, b.maximum)};
}

bool meets(const Box& box, const Ray& ray, double t_min, double t_max) {
  for (int axis = 0; axis < 3; ++axis) {
    const double inverse = 1 / ray.direction[axis];
    double enters = (box.minimum[axis] - ray.origin[axis]) * inverse;
    double leaves = (box.maximum[axis] - ray.origin[axis]) * inverse;
    if (inverse < 0) std::swap(enters, leaves);
    // A ray within a face of the box gives NaN, which these comparisons leave out.
    if (enters > t_min) t_min = enters;
    if (leaves < t_max) t_max = leaves;
    if (t_max < t_min) return false;
  }
  return true;
}

}  // namespace tandem::weekend
