#include "pathtracer/scene/polygon.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "base/error.hpp"
#include "pathtracer/scene/point_tree.hpp"

namespace tandem::pathtracer {
namespace {

using Triangle = std::array<std::uint32_t, 3>;

/// How often no ear is found before the rest becomes a fan: a polygon that crosses itself has no right triangulation.
constexpr int largest_searches = 64;
/// Points and boxes that are looked at for each corner at most. Polygons that do not cross themselves, of any shape
/// that was tried, need fewer than a hundred.
constexpr std::uint64_t most_work = 4000;

/// The corners in the coordinate plane in which the polygon appears largest, counter-clockwise (Newell 1972).
std::vector<glm::dvec2> project(std::span<const glm::vec3> corners) {
  glm::dvec3 normal(0);
  const glm::dvec3 origin(corners[0]);
  for (std::size_t i = 0; i < corners.size(); ++i)
    normal += glm::cross(glm::dvec3(corners[i]) - origin, glm::dvec3(corners[(i + 1) % corners.size()]) - origin);
  const glm::dvec3 size = glm::abs(normal);
  const int drop = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  const int first = (drop + 1) % 3;
  const int second = (drop + 2) % 3;
  std::vector<glm::dvec2> points;
  points.reserve(corners.size());
  for (const glm::vec3& corner : corners)
    points.push_back(normal[drop] < 0 ? glm::dvec2(corner[second], corner[first])
                                      : glm::dvec2(corner[first], corner[second]));
  return points;
}

/// The corners that are left, in a ring, and those of them at which a triangle may be cut off (an ear: convex, with
/// none of the other corners inside). A corner that is known to be none is looked at again only when its triangle
/// changes or the corner inside is cut off, so that all searches together take little more than one look at each
/// corner.
class Ring {
 public:
  explicit Ring(std::span<const glm::dvec2> points)
      : points_(points), tree_(points), next_(points.size()), previous_(points.size()), blocked_(points.size()) {
    const auto count = static_cast<std::uint32_t>(points.size());
    for (std::uint32_t i = 0; i < count; ++i) {
      next_[i] = (i + 1) % count;
      previous_[i] = (i + count - 1) % count;
      candidates_.insert(candidates_.end(), i);
    }
  }

  std::uint64_t work() const { return tree_.work(); }
  std::uint32_t next(std::uint32_t corner) const { return next_[corner]; }

  /// The first ear from a corner on.
  std::optional<std::uint32_t> find_ear(std::uint32_t start) {
    while (!candidates_.empty()) {
      auto candidate = candidates_.lower_bound(start);
      if (candidate == candidates_.end()) candidate = candidates_.begin();
      const std::uint32_t corner = *candidate;
      const glm::dvec2 a = points_[previous_[corner]];
      const glm::dvec2 b = points_[corner];
      const glm::dvec2 c = points_[next_[corner]];
      const bool is_convex = orientation(a, b, c) > 0;
      // Polygons that reach a hole through a bridge visit its corners twice: those do not block each other.
      const std::optional<std::uint32_t> inside = is_convex ? tree_.find_in_triangle(a, b, c) : std::nullopt;
      if (is_convex && !inside) return corner;
      candidates_.erase(candidate);
      if (inside) blocked_[*inside].push_back(corner);
    }
    return std::nullopt;
  }

  Triangle cut(std::uint32_t corner) {
    const Triangle triangle = {previous_[corner], corner, next_[corner]};
    next_[triangle[0]] = triangle[2];
    previous_[triangle[2]] = triangle[0];
    next_[corner] = corner;
    tree_.remove(corner);
    candidates_.erase(corner);
    candidates_.insert(triangle[0]);
    candidates_.insert(triangle[2]);
    for (const std::uint32_t other : blocked_[corner])
      if (next_[other] != other) candidates_.insert(other);
    blocked_[corner] = {};
    return triangle;
  }

 private:
  std::span<const glm::dvec2> points_;
  PointTree tree_;
  std::vector<std::uint32_t> next_;  ///< itself: cut off
  std::vector<std::uint32_t> previous_;
  std::vector<std::vector<std::uint32_t>> blocked_;  ///< by a corner that is inside their triangles
  std::set<std::uint32_t> candidates_;
};

}  // namespace

std::vector<Triangle> triangulate(std::span<const glm::vec3> corners) {
  if (corners.size() == 3) return {{0, 1, 2}};
  const std::vector<glm::dvec2> points = project(corners);
  Ring ring(points);

  // Cutting corner 0 first gives the diagonal 1-3, cutting corner 1 gives 0-2.
  std::uint32_t start = 1;
  if (corners.size() == 4 && glm::distance(points[1], points[3]) < glm::distance(points[0], points[2])) start = 0;

  std::vector<Triangle> triangles;
  triangles.reserve(corners.size() - 2);
  std::size_t count = corners.size();
  for (int searches = largest_searches; count > 3 && searches > 0; --count) {
    const std::optional<std::uint32_t> ear = ring.find_ear(start);
    if (!ear) --searches;
    if (ring.work() > most_work * corners.size())
      throw Error(fmt::format("a polygon of {} corners is too entangled to be split into triangles", corners.size()));
    const std::uint32_t corner = ear.value_or(start);
    start = ring.next(corner);
    triangles.push_back(ring.cut(corner));
  }
  // A fan from the first corner that is left.
  std::vector<bool> is_left(corners.size(), true);
  for (const Triangle& triangle : triangles) is_left[triangle[1]] = false;
  const auto first = static_cast<std::uint32_t>(std::ranges::find(is_left, true) - is_left.begin());
  for (std::uint32_t i = ring.next(first); ring.next(i) != first; i = ring.next(i))
    triangles.push_back({first, i, ring.next(i)});
  return triangles;
}

}  // namespace tandem::pathtracer
