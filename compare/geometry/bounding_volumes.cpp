#include "compare/geometry/bounding_volumes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include <glm/common.hpp>

#include "compare/geometry/rounding.hpp"

// The device cpu-exact splits its own tree of boxes in the same way. The two share no code on
// purpose: the reference tracer of the probes, which uses this one, checks that device too, and a fault that they had
// in common would stay unseen.

namespace tandem::compare {

BoundingVolumes::BoundingVolumes(std::span<const pathtracer::Bounds> primitives) : order_(primitives.size()) {
  std::iota(order_.begin(), order_.end(), 0u);
  nodes_.emplace_back();
  split(0, 0, static_cast<std::uint32_t>(primitives.size()), primitives);
}

void BoundingVolumes::split(std::uint32_t node, std::uint32_t first, std::uint32_t count,
                            std::span<const pathtracer::Bounds> primitives) {
  constexpr std::uint32_t most_in_leaf = 4;
  constexpr double infinity = std::numeric_limits<double>::infinity();
  glm::dvec3 minimum(infinity), maximum(-infinity), least_centre(infinity), greatest_centre(-infinity);
  for (std::uint32_t i = first; i < first + count; ++i) {
    const pathtracer::Bounds& box = primitives[order_[i]];
    minimum = glm::min(minimum, glm::dvec3(box.minimum));
    maximum = glm::max(maximum, glm::dvec3(box.maximum));
    least_centre = glm::min(least_centre, glm::dvec3(box.centre()));
    greatest_centre = glm::max(greatest_centre, glm::dvec3(box.centre()));
  }
  nodes_[node] = {minimum, maximum, first, count};
  if (count <= most_in_leaf) return;

  const glm::dvec3 spread = greatest_centre - least_centre;
  const int axis = spread.x >= spread.y && spread.x >= spread.z ? 0 : (spread.y >= spread.z ? 1 : 2);
  const std::uint32_t half = count / 2;
  const auto begin = order_.begin() + first;
  std::nth_element(begin, begin + half, begin + count, [&](std::uint32_t a, std::uint32_t b) {
    return primitives[a].centre()[axis] < primitives[b].centre()[axis];
  });
  const auto child = static_cast<std::uint32_t>(nodes_.size());
  nodes_.resize(nodes_.size() + 2);
  nodes_[node].first = child;
  nodes_[node].count = 0;
  split(child, first, half, primitives);
  split(child + 1, first + half, count - half, primitives);
}

void BoundingVolumes::traverse(const GeometryRay& ray,
                               const std::function<double(std::uint32_t primitive)>& visit) const {
  if (order_.empty()) return;
  double bound = std::numeric_limits<double>::infinity();
  const auto meets = [&](const Node& node) {
    double magnitude = ray.magnitude;
    for (int axis = 0; axis < 3; ++axis)
      magnitude = std::max({magnitude, std::abs(node.minimum[axis]), std::abs(node.maximum[axis])});
    const double margin = rounding_distance(magnitude);
    double enter = -std::numeric_limits<double>::infinity(), leave = -enter;
    for (int axis = 0; axis < 3; ++axis) {
      const double near = node.minimum[axis] - margin - ray.origin[axis];
      const double far = node.maximum[axis] + margin - ray.origin[axis];
      if (ray.direction[axis] == 0) {
        if (near > 0 || far < 0) return false;
        continue;
      }
      const double t0 = near / ray.direction[axis], t1 = far / ray.direction[axis];
      enter = std::max(enter, std::min(t0, t1));
      leave = std::min(leave, std::max(t0, t1));
    }
    return enter <= leave && leave >= 0 && enter <= bound;
  };
  std::vector<std::uint32_t> stack = {0};
  while (!stack.empty()) {
    const Node& node = nodes_[stack.back()];
    stack.pop_back();
    if (!meets(node)) continue;
    if (node.count == 0 && node.first != 0) {
      stack.push_back(node.first);
      stack.push_back(node.first + 1);
    }
    for (std::uint32_t i = 0; i < node.count; ++i) bound = std::min(bound, visit(order_[node.first + i]));
  }
}

}  // namespace tandem::compare
