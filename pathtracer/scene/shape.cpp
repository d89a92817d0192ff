#include "pathtracer/scene/shape.hpp"

#include <algorithm>
#include <cmath>

#include <glm/vec2.hpp>

namespace tandem::pathtracer {
namespace {

double cross(glm::dvec2 a, glm::dvec2 b) { return a.x * b.y - a.y * b.x; }

/// The lines of the grid whose coordinates lie in [minimum, maximum], as [first, last).
struct LineRange {
  std::size_t first;
  std::size_t last;
};

LineRange lines_between(double minimum, double maximum, double start, double extent, std::size_t resolution) {
  const auto count = double(resolution);
  const auto index = [&](double coordinate) {
    return std::clamp((coordinate - start) / extent * count - 0.5, -1.0, count);
  };
  return {static_cast<std::size_t>(std::max(0.0, std::ceil(index(minimum)))),
          static_cast<std::size_t>(std::min(count, std::floor(index(maximum)) + 1))};
}

}  // namespace

/// The triangle seen along an axis, and the lines that its bounds meet.
struct SceneProbe::Extent {
  std::array<glm::dvec2, 3> corners;
  LineRange across;
  LineRange along;
};

SceneProbe::Extent SceneProbe::extent_of(const Scene& scene, const GpuTriangle& triangle, int axis) const {
  const int axis_u = (axis + 1) % 3;
  const int axis_v = (axis + 2) % 3;
  std::array<glm::dvec2, 3> corners;
  for (int i = 0; i < 3; ++i) {
    const glm::vec3& p = scene.positions[triangle.vertices[i]];
    corners[i] = {p[axis_u], p[axis_v]};
  }
  const glm::vec3 extent = bounds_.extent();
  const auto [min_u, max_u] = std::minmax({corners[0].x, corners[1].x, corners[2].x});
  const auto [min_v, max_v] = std::minmax({corners[0].y, corners[1].y, corners[2].y});
  return {corners, lines_between(min_u, max_u, bounds_.minimum[axis_u], extent[axis_u], resolution_),
          lines_between(min_v, max_v, bounds_.minimum[axis_v], extent[axis_v], resolution_)};
}

std::uint64_t SceneProbe::meetings(const Scene& scene) const {
  const glm::vec3 extent = bounds_.extent();
  std::uint64_t count = 0;
  for (int axis = 0; axis < 3; ++axis) {
    if (!(extent[(axis + 1) % 3] > 0 && extent[(axis + 2) % 3] > 0)) continue;
    for (const GpuTriangle& triangle : scene.triangles) {
      const Extent lines = extent_of(scene, triangle, axis);
      if (lines.across.last > lines.across.first && lines.along.last > lines.along.first)
        count += (lines.across.last - lines.across.first) * (lines.along.last - lines.along.first);
    }
  }
  return count;
}

SceneProbe::SceneProbe(const Scene& scene, std::uint64_t most_meetings) : bounds_(pathtracer::bounds(scene)) {
  constexpr std::size_t coarsest_resolution = 3;
  while (resolution_ > coarsest_resolution && meetings(scene) > most_meetings) resolution_ /= 2;
  const glm::vec3 extent = bounds_.extent();
  for (int axis = 0; axis < 3; ++axis) {
    lines_[axis].resize(resolution_ * resolution_);
    if (!(extent[(axis + 1) % 3] > 0 && extent[(axis + 2) % 3] > 0)) continue;
    for (const GpuTriangle& triangle : scene.triangles) add(scene, triangle, axis);
    for (std::vector<LineHit>& hits : lines_[axis])
      std::sort(hits.begin(), hits.end(),
                [](const LineHit& a, const LineHit& b) { return a.coordinate < b.coordinate; });
  }
}

void SceneProbe::add(const Scene& scene, const GpuTriangle& triangle, int axis) {
  const int axis_u = (axis + 1) % 3;
  const int axis_v = (axis + 2) % 3;
  const auto [corners, across, along] = extent_of(scene, triangle, axis);
  const double area = cross(corners[1] - corners[0], corners[2] - corners[0]);
  if (area == 0) return;
  for (std::size_t v = along.first; v < along.last; ++v)
    for (std::size_t u = across.first; u < across.last; ++u) {
      const glm::vec3 point = line_point(axis, u, v);
      const glm::dvec2 p(point[axis_u], point[axis_v]);
      std::array<double, 3> weights;
      for (int i = 0; i < 3; ++i)
        weights[i] = cross(corners[(i + 2) % 3] - corners[(i + 1) % 3], p - corners[(i + 1) % 3]) / area;
      if (*std::min_element(weights.begin(), weights.end()) < 0) continue;
      double coordinate = 0;
      for (int i = 0; i < 3; ++i) coordinate += weights[i] * double{scene.positions[triangle.vertices[i]][axis]};
      lines_[axis][v * resolution_ + u].push_back({static_cast<float>(coordinate), area > 0});
    }
}

const std::vector<LineHit>& SceneProbe::line(int axis, std::size_t u, std::size_t v) const {
  return lines_[axis][v * resolution_ + u];
}

glm::vec3 SceneProbe::line_point(int axis, std::size_t u, std::size_t v) const {
  const glm::vec3 extent = bounds_.extent();
  glm::vec3 point = bounds_.centre();
  const int axis_u = (axis + 1) % 3;
  const int axis_v = (axis + 2) % 3;
  point[axis_u] =
      bounds_.minimum[axis_u] + extent[axis_u] * (static_cast<float>(u) + 0.5f) / static_cast<float>(resolution_);
  point[axis_v] =
      bounds_.minimum[axis_v] + extent[axis_v] * (static_cast<float>(v) + 0.5f) / static_cast<float>(resolution_);
  return point;
}

float SceneProbe::closed_fraction(int axis, bool upper_side) const {
  const float depth = 0.05f * bounds_.extent()[axis];
  std::size_t closed = 0;
  for (const std::vector<LineHit>& hits : lines_[axis]) {
    if (hits.empty()) continue;
    closed += upper_side ? hits.back().coordinate >= bounds_.maximum[axis] - depth
                         : hits.front().coordinate <= bounds_.minimum[axis] + depth;
  }
  return static_cast<float>(closed) / static_cast<float>(lines_[axis].size());
}

std::optional<Gap> longest_gap(const std::vector<LineHit>& hits, bool only_faced) {
  std::optional<Gap> longest;
  for (std::size_t i = 1; i < hits.size(); ++i) {
    const Gap gap{hits[i - 1], hits[i]};
    if (only_faced && !gap.is_faced()) continue;
    if (!longest || gap.length() > longest->length()) longest = gap;
  }
  return longest;
}

}  // namespace tandem::pathtracer
