#pragma once

#include <array>

#include "tools/weekend/hittable.hpp"

namespace tandem::weekend {

struct Corner {
  glm::dvec3 position{0};
  glm::dvec3 normal{0};  ///< unit; of smooth triangles
  glm::dvec2 uv{0};
};

class Triangle final : public Hittable {
 public:
  /// @param smooth whether the corners' normals are interpolated
  Triangle(const std::array<Corner, 3>& corners, bool smooth, const Material* material);

  std::optional<Hit> hit(const Ray& ray, double t_min, double t_max, Random& random) const override;
  Box bounds() const override;
  glm::dvec3 sample_direction(const glm::dvec3& origin, Random& random) const override;
  double direction_density(const Ray& ray) const override;

 private:
  struct Place {
    double t, b, c;
  };
  std::optional<Place> meet(const Ray& ray) const;

  std::array<Corner, 3> corners_;
  glm::dvec3 normal_;  ///< unit; 0 of a triangle without an area, which nothing meets
  double area_;
  bool smooth_;
  const Material* material_;
};

class Sphere final : public Hittable {
 public:
  Sphere(const glm::dvec3& centre, double radius, const Material* material);

  std::optional<Hit> hit(const Ray& ray, double t_min, double t_max, Random& random) const override;
  Box bounds() const override;
  /// From outside: within the cone of the sphere. From inside: from all around.
  glm::dvec3 sample_direction(const glm::dvec3& origin, Random& random) const override;
  double direction_density(const Ray& ray) const override;

 private:
  glm::dvec3 centre_;
  double radius_;
  const Material* material_;
};

}  // namespace tandem::weekend
