#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <glm/vec2.hpp>

namespace tandem::pathtracer {

/// Twice the signed area of a triangle, positive when counter-clockwise.
inline double orientation(glm::dvec2 a, glm::dvec2 b, glm::dvec2 c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// Points of a plane among which those inside a triangle are found, and which can be removed: a k-d tree whose cuts are
/// made once. Building takes O(n log n) for n points; a search looks at the points near the edges of the triangle and
/// at the first ones inside.
class PointTree {
 public:
  /// @param points must outlive this object
  explicit PointTree(std::span<const glm::dvec2> points);

  void remove(std::uint32_t point);
  /// One of the points left that is in the triangle or on its edge, and in none of its corners. @param a, b, c
  /// counter-clockwise
  std::optional<std::uint32_t> find_in_triangle(glm::dvec2 a, glm::dvec2 b, glm::dvec2 c);
  /// Points and boxes that all searches have looked at.
  std::uint64_t work() const noexcept { return work_; }

 private:
  struct Node {
    glm::dvec2 minimum{0};
    glm::dvec2 maximum{0};
    std::uint32_t first = 0;  ///< of its points in order_
    std::uint32_t count = 0;
    std::uint32_t left = 0;  ///< 0 for a leaf; the right one is next to it
    std::uint32_t remaining = 0;
  };

  void split(std::uint32_t node);

  std::span<const glm::dvec2> points_;
  std::vector<std::uint32_t> order_;
  std::vector<std::uint32_t> place_;  ///< in order_, of each point
  std::vector<bool> removed_;
  std::vector<Node> nodes_;
  std::vector<std::uint32_t> stack_;
  std::uint64_t work_ = 0;
};

}  // namespace tandem::pathtracer
