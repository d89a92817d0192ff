#pragma once

#include <span>
#include <string_view>

#include <glm/vec3.hpp>

namespace tandem::pathtracer {

/// A metal by its complex index of refraction, eta + i absorption, measured in air at 650, 550 and 450 nm, which stand
/// for red, green and blue.
struct Conductor {
  std::string_view name;
  glm::vec3 eta;
  glm::vec3 absorption;
};

/// All that are known, by name in alphabetical order.
std::span<const Conductor> conductors();

/// By its name in lower case, such as "gold"; nullptr if it is not known.
const Conductor* find_conductor(std::string_view name);

}  // namespace tandem::pathtracer
