#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "compare/geometry/ray.hpp"
#include "pathtracer/scene/scene.hpp"

namespace tandem::compare {

/// A hierarchy of axis-aligned boxes over primitives, for tracing in doubles.
class BoundingVolumes {
 public:
  explicit BoundingVolumes(std::span<const pathtracer::Bounds> primitives);

  /// Calls `visit` with the index of every primitive whose box the ray meets, within rounding, at a t from 0 to the
  /// least that a call has returned so far, infinity at first; in no order.
  void traverse(const GeometryRay& ray, const std::function<double(std::uint32_t primitive)>& visit) const;

 private:
  struct Node {
    glm::dvec3 minimum, maximum;
    std::uint32_t first = 0;  ///< of its primitives in order_, or its first child; the other one follows
    std::uint32_t count = 0;  ///< of primitives; 0 of an inner node
  };
  void split(std::uint32_t node, std::uint32_t first, std::uint32_t count,
             std::span<const pathtracer::Bounds> primitives);

  std::vector<Node> nodes_;
  std::vector<std::uint32_t> order_;
};

}  // namespace tandem::compare
