#include "compare/cause/tie.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "compare/geometry/distance.hpp"
#include "compare/geometry/intersection.hpp"
#include "compare/geometry/primitive.hpp"
#include "compare/geometry/ray.hpp"

namespace tandem::compare {
namespace {

using pathtracer::PathEvent;
using pathtracer::Scene;
using pathtracer::TracedRay;

/// Where the ray meets what the answer names; none where nothing is named, or a sphere that moves.
std::vector<Intersection> intersections_of(const Scene& scene, const TracedRay& ray, std::uint32_t answer) {
  if (answer < scene.triangles.size()) {
    const std::optional<Intersection> found = meet(geometry_ray(ray), corners_of(scene, answer));
    return found ? std::vector{*found} : std::vector<Intersection>{};
  }
  const pathtracer::GpuSphere* const sphere = sphere_of(scene, answer);
  if (!sphere || sphere->motion != glm::vec3(0)) return {};
  return meet(geometry_ray(ray), *sphere);
}

bool lets_through(const Scene& scene, std::uint32_t answer) {
  return answer < scene.triangles.size() && pathtracer::is_transparent(scene, scene.triangles[answer]);
}

double distance_to_outline(const Scene& scene, const TracedRay& ray, std::uint32_t triangle) {
  const Corners corners = corners_of(scene, triangle);
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < 3; ++i)
    least = std::min(least, distance_from_line(geometry_ray(ray), corners[i], corners[(i + 1) % 3]));
  return least;
}

}  // namespace

DifferenceClass class_of_tie(const Scene& scene, const TracedRay& ray, std::uint32_t answer_a, std::uint32_t answer_b) {
  if (ray.kind == pathtracer::RayKind::occlusion) return DifferenceClass::grazing_visibility;
  const std::vector<Intersection> with_a = intersections_of(scene, ray, answer_a),
                                  with_b = intersections_of(scene, ray, answer_b);
  const auto is_certain = [](const Intersection& intersection) { return intersection.certain; };
  const bool inside_a = std::any_of(with_a.begin(), with_a.end(), is_certain);
  const bool inside_b = std::any_of(with_b.begin(), with_b.end(), is_certain);
  if (inside_a && inside_b) {
    for (const Intersection& a : with_a)
      for (const Intersection& b : with_b)
        if (a.certain && b.certain && a.t_low <= b.t_high && b.t_low <= a.t_high)
          return DifferenceClass::coincident_geometry;
  }
  if ((inside_a && lets_through(scene, answer_a)) || (inside_b && lets_through(scene, answer_b)))
    return DifferenceClass::flipped_decision;
  return DifferenceClass::edge_or_vertex_tie;
}

std::string passing_text(const Scene& scene, const TracedRay& ray, std::uint32_t answer_a, std::uint32_t answer_b) {
  if (ray.kind == pathtracer::RayKind::occlusion) return {};
  const bool triangle_a = answer_a < scene.triangles.size(), triangle_b = answer_b < scene.triangles.size();
  if (triangle_a && triangle_b) {
    std::vector<glm::dvec3> shared;
    for (const glm::dvec3& corner : corners_of(scene, answer_a)) {
      const Corners others = corners_of(scene, answer_b);
      if (std::find(others.begin(), others.end(), corner) != others.end()) shared.push_back(corner);
    }
    if (shared.size() == 2)
      return fmt::format("they share an edge, and it passes {:.1g} from it",
                         distance_from_line(geometry_ray(ray), shared[0], shared[1]));
    if (shared.size() == 1)
      return fmt::format("they share a vertex, and it passes {:.1g} from it",
                         distance_from_line(geometry_ray(ray), shared[0], shared[0]));
  }
  // Of two that do not touch, the one that it barely meets.
  if (!triangle_a && !triangle_b) return {};
  const double outline_a = triangle_a ? distance_to_outline(scene, ray, answer_a) : HUGE_VAL;
  const double outline_b = triangle_b ? distance_to_outline(scene, ray, answer_b) : HUGE_VAL;
  return fmt::format("it passes {:.1g} from an edge of triangle {}", std::min(outline_a, outline_b),
                     outline_a <= outline_b ? answer_a : answer_b);
}

bool is_report_within_rounding(const Scene& scene, const PathEvent& a, const PathEvent& b, std::size_t field,
                               double tolerance) {
  namespace word = pathtracer::event_word;
  const bool is_t = field == word::hit_t;
  const auto close = [&](double x, double y) {
    return std::abs(x - y) <= tolerance * (is_t ? std::max(std::abs(x), std::abs(y)) : 1.0);
  };
  const std::size_t count = is_t ? 1 : 2;
  bool all_close = true;
  for (std::size_t i = field; i < field + count; ++i)
    all_close = all_close && (a.words[i] == b.words[i] || close(a.number(i), b.number(i)));
  if (all_close) return true;
  const auto is_possible = [&](const PathEvent& event) {
    const TracedRay ray = pathtracer::ray_of({}, event);
    const std::vector<Intersection> intersections = intersections_of(scene, ray, ray.answer);
    return std::any_of(intersections.begin(), intersections.end(), [&](const Intersection& intersection) {
      if (is_t) return event.number(field) >= intersection.t_low && event.number(field) <= intersection.t_high;
      for (std::size_t i = 0; i < 2; ++i)
        if (!(std::abs(event.number(field + i) - intersection.barycentrics[i]) <= intersection.barycentric_errors[i]))
          return false;
      return true;
    });
  };
  return is_possible(a) && is_possible(b);
}

}  // namespace tandem::compare
