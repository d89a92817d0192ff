#pragma once

#include <optional>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "tools/weekend/random.hpp"

/// A path tracer in the spirit of Shirley's "Ray Tracing in One Weekend" series (2020): double precision, virtual
/// hittables, a bounding volume hierarchy of its own, one thread, no care for speed. It is the baseline of
/// `tandem bench --suite thesis`, and a third opinion on Tandem's pictures: it shares the scene loader with Tandem and
/// nothing that traces or shades (docs/decisions/0029-baseline.md).
namespace tandem::weekend {

class Material;

struct Ray {
  glm::dvec3 origin{0};
  glm::dvec3 direction{0, 0, 1};  ///< unit

  glm::dvec3 at(double t) const { return origin + t * direction; }
};

/// Where a ray meets a surface.
struct Hit {
  double t = 0;
  glm::dvec3 position{0};
  glm::dvec3 normal{0};          ///< unit, of the true surface, on the side from which the ray came
  glm::dvec3 shading_normal{0};  ///< unit, likewise; interpolated where the surface is to look round
  bool outside = true;           ///< the ray came from the side of the surface's own normal
  glm::dvec2 uv{0};              ///< texture coordinates, v upwards
  const Material* material = nullptr;
};

/// An axis-aligned box.
struct Box {
  glm::dvec3 minimum{0};
  glm::dvec3 maximum{0};
};

Box around(const Box& a, const Box& b);
/// Whether the ray is in the box at some t of the interval.
bool meets(const Box& box, const Ray& ray, double t_min, double t_max);

/// What a ray can meet. Virtual, as in the books: this is part of what makes the baseline the baseline.
class Hittable {
 public:
  virtual ~Hittable() = default;

  /// The closest hit with t in (t_min, t_max). A surface that dissolves decides by `random` whether the ray meets it.
  virtual std::optional<Hit> hit(const Ray& ray, double t_min, double t_max, Random& random) const = 0;
  virtual Box bounds() const = 0;

  /// A direction towards a uniformly chosen point of it, not normalised, and the solid-angle density of that direction;
  /// for what lights may be made of.
  virtual glm::dvec3 sample_direction(const glm::dvec3& origin, Random& random) const = 0;
  virtual double direction_density(const Ray& ray) const = 0;
};

}  // namespace tandem::weekend
