#include "pathtracer/scene/polygon.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

namespace tandem::pathtracer {
namespace {

using Triangle = std::array<std::uint32_t, 3>;

/// How often no ear is found before the rest becomes a fan: a polygon that crosses itself has no right triangulation,
/// and each search looks at all pairs of its corners.
constexpr int largest_searches = 64;

/// Twice the signed area, positive when counter-clockwise.
double orientation(glm::dvec2 a, glm::dvec2 b, glm::dvec2 c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

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

/// Whether the triangle at corner `at` can be cut off: convex, with none of the other corners inside.
bool is_ear(const std::vector<glm::dvec2>& points, const std::vector<std::uint32_t>& ring, std::size_t at) {
  const std::size_t count = ring.size();
  const glm::dvec2 a = points[ring[(at + count - 1) % count]];
  const glm::dvec2 b = points[ring[at]];
  const glm::dvec2 c = points[ring[(at + 1) % count]];
  if (orientation(a, b, c) <= 0) return false;
  for (const std::uint32_t index : ring) {
    const glm::dvec2 p = points[index];
    // Polygons that reach a hole through a bridge visit its corners twice: those do not block each other.
    if (p == a || p == b || p == c) continue;
    if (orientation(a, b, p) >= 0 && orientation(b, c, p) >= 0 && orientation(c, a, p) >= 0) return false;
  }
  return true;
}

}  // namespace

std::vector<Triangle> triangulate(std::span<const glm::vec3> corners) {
  if (corners.size() == 3) return {{0, 1, 2}};
  const std::vector<glm::dvec2> points = project(corners);
  std::vector<std::uint32_t> ring(corners.size());
  std::iota(ring.begin(), ring.end(), 0u);

  // Cutting corner 0 first gives the diagonal 1-3, cutting corner 1 gives 0-2.
  std::size_t start = 1;
  if (corners.size() == 4 && glm::distance(points[1], points[3]) < glm::distance(points[0], points[2])) start = 0;

  std::vector<Triangle> triangles;
  triangles.reserve(corners.size() - 2);
  int searches = largest_searches;
  while (ring.size() > 3 && searches > 0) {
    std::size_t ear = start % ring.size();
    --searches;
    for (std::size_t tried = 0; tried < ring.size(); ++tried) {
      const std::size_t candidate = (start + tried) % ring.size();
      if (!is_ear(points, ring, candidate)) continue;
      ear = candidate;
      ++searches;
      break;
    }
    const std::size_t count = ring.size();
    triangles.push_back({ring[(ear + count - 1) % count], ring[ear], ring[(ear + 1) % count]});
    ring.erase(ring.begin() + static_cast<std::ptrdiff_t>(ear));
    start = ear;
  }
  for (std::size_t i = 2; i < ring.size(); ++i) triangles.push_back({ring[0], ring[i - 1], ring[i]});
  return triangles;
}

}  // namespace tandem::pathtracer
