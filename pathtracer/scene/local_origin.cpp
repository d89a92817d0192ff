#include "pathtracer/scene/local_origin.hpp"

#include <algorithm>
#include <cmath>

namespace tandem::pathtracer {

glm::dvec3 local_origin(const Scene& scene) {
  constexpr double farthest = 16;  // the four bits that this costs are less than what a ray's offset allows for
  const Bounds box = bounds(scene);
  const glm::dvec3 centre = 0.5 * (glm::dvec3(box.minimum) + glm::dvec3(box.maximum));
  const glm::dvec3 extent = glm::dvec3(box.maximum) - glm::dvec3(box.minimum);
  const double half = 0.5 * std::max({extent.x, extent.y, extent.z});
  const double step = half > 0 ? std::exp2(std::ceil(std::log2(half))) : 0;
  glm::dvec3 origin(0);
  for (int axis = 0; axis < 3; ++axis)
    if (std::abs(centre[axis]) > farthest * half)
      origin[axis] = step > 0 ? std::round(centre[axis] / step) * step : centre[axis];
  return origin;
}

}  // namespace tandem::pathtracer
