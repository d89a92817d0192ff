#pragma once

#include <cmath>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

namespace tandem::weekend {

/// An orthonormal basis around a unit vector, its z.
class Frame {
 public:
  explicit Frame(const glm::dvec3& z) : z_(z) {
    const glm::dvec3 other = std::abs(z.x) > 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0);
    y_ = glm::normalize(glm::cross(z, other));
    x_ = glm::cross(z, y_);
  }

  glm::dvec3 to_world(const glm::dvec3& v) const { return v.x * x_ + v.y * y_ + v.z * z_; }
  glm::dvec3 to_local(const glm::dvec3& v) const { return {glm::dot(v, x_), glm::dot(v, y_), glm::dot(v, z_)}; }

 private:
  glm::dvec3 x_, y_, z_;
};

}  // namespace tandem::weekend
