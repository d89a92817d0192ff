#include "pathtracer/scene/point_tree.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include <glm/common.hpp>

namespace tandem::pathtracer {
namespace {

/// Points of a leaf. Ordinary polygons are one leaf, whose points are all looked at.
constexpr std::uint32_t leaf_size = 32;

}  // namespace

PointTree::PointTree(std::span<const glm::dvec2> points)
    : points_(points), order_(points.size()), place_(points.size()), removed_(points.size(), false), nodes_(1) {
  std::iota(order_.begin(), order_.end(), 0u);
  nodes_[0].count = static_cast<std::uint32_t>(points.size());
  for (std::uint32_t node = 0; node < nodes_.size(); ++node) split(node);
  for (std::uint32_t i = 0; i < order_.size(); ++i) place_[order_[i]] = i;
}

void PointTree::split(std::uint32_t node) {
  Node self = nodes_[node];
  const auto first = order_.begin() + self.first;
  const auto last = first + self.count;
  self.remaining = self.count;
  self.minimum = self.maximum = points_[*first];
  for (auto i = first; i != last; ++i) {
    self.minimum = glm::min(self.minimum, points_[*i]);
    self.maximum = glm::max(self.maximum, points_[*i]);
  }
  if (self.count > leaf_size) {
    const glm::dvec2 extent = self.maximum - self.minimum;
    const int axis = extent.x >= extent.y ? 0 : 1;
    const std::uint32_t half = self.count / 2;
    std::nth_element(first, first + half, last,
                     [&](std::uint32_t a, std::uint32_t b) { return points_[a][axis] < points_[b][axis]; });
    self.left = static_cast<std::uint32_t>(nodes_.size());
    nodes_.push_back({.first = self.first, .count = half});
    nodes_.push_back({.first = self.first + half, .count = self.count - half});
  }
  nodes_[node] = self;
}

void PointTree::remove(std::uint32_t point) {
  if (removed_[point]) return;
  removed_[point] = true;
  for (std::uint32_t node = 0;;) {
    --nodes_[node].remaining;
    if (nodes_[node].left == 0) return;
    node = nodes_[node].left;
    if (place_[point] >= nodes_[node].first + nodes_[node].count) ++node;
  }
}

std::optional<std::uint32_t> PointTree::find_in_triangle(glm::dvec2 a, glm::dvec2 b, glm::dvec2 c) {
  const std::array<glm::dvec2, 3> corners = {a, b, c};
  const glm::dvec2 minimum = glm::min(a, glm::min(b, c));
  const glm::dvec2 maximum = glm::max(a, glm::max(b, c));
  // Far more than rounding adds to a product of two differences of coordinates.
  const glm::dvec2 largest = glm::max(glm::abs(minimum), glm::abs(maximum));
  const double margin = 1e-12 * std::max(largest.x, largest.y);
  const auto is_outside = [&](const Node& node) {
    for (int axis = 0; axis < 2; ++axis)
      if (node.minimum[axis] > maximum[axis] + margin || node.maximum[axis] < minimum[axis] - margin) return true;
    for (std::size_t i = 0; i < 3; ++i) {
      const glm::dvec2 from = corners[i];
      const glm::dvec2 edge = corners[(i + 1) % 3] - from;
      // The corner of the box that is farthest to the left of the edge.
      const glm::dvec2 far(edge.y > 0 ? node.minimum.x : node.maximum.x, edge.x > 0 ? node.maximum.y : node.minimum.y);
      if (orientation(from, corners[(i + 1) % 3], far) < -margin * (std::abs(edge.x) + std::abs(edge.y))) return true;
    }
    return false;
  };
  stack_.assign(1, 0);
  while (!stack_.empty()) {
    const std::uint32_t index = stack_.back();
    const Node& node = nodes_[index];
    stack_.pop_back();
    ++work_;
    if (node.remaining == 0 || (index != 0 && is_outside(node))) continue;
    if (node.left != 0) {
      stack_.push_back(node.left + 1);
      stack_.push_back(node.left);
      continue;
    }
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
      if (removed_[order_[i]]) continue;
      ++work_;
      const glm::dvec2 p = points_[order_[i]];
      if (p == a || p == b || p == c) continue;
      if (orientation(a, b, p) >= 0 && orientation(b, c, p) >= 0 && orientation(c, a, p) >= 0) return order_[i];
    }
  }
  return std::nullopt;
}

}  // namespace tandem::pathtracer
