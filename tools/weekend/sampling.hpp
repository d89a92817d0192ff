#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/vec3.hpp>

#include "tools/weekend/random.hpp"

namespace tandem::weekend {

/// With the density cos / pi over the hemisphere around z.
inline glm::dvec3 cosine_direction(Random& random) {
  const double radius2 = random.uniform();
  const double turn = 2 * std::numbers::pi * random.uniform();
  const double radius = std::sqrt(radius2);
  return {std::cos(turn) * radius, std::sin(turn) * radius, std::sqrt(std::max(0.0, 1 - radius2))};
}

/// With the density (n + 1) / (2 pi) cos^n.
inline glm::dvec3 power_cosine_direction(double n, Random& random) {
  const double cosine = std::pow(random.uniform(), 1 / (n + 1));
  const double turn = 2 * std::numbers::pi * random.uniform();
  const double sine = std::sqrt(std::max(0.0, 1 - cosine * cosine));
  return {std::cos(turn) * sine, std::sin(turn) * sine, cosine};
}

}  // namespace tandem::weekend
