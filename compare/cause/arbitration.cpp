#include "compare/cause/arbitration.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include <glm/geometric.hpp>

#include "compare/geometry/distance.hpp"
#include "compare/geometry/primitive.hpp"
#include "compare/geometry/ray.hpp"
#include "compare/geometry/rounding.hpp"

namespace tandem::compare {
namespace {

using pathtracer::RayKind;
using pathtracer::TracedRay;

/// Where the ray meets the plane of a triangle; nothing for a ray in the plane.
std::optional<glm::dvec3> point_in_plane(const TracedRay& ray, const Corners& t) {
  const glm::dvec3 origin(ray.origin), direction(ray.direction);
  const glm::dvec3 normal = glm::cross(t[1] - t[0], t[2] - t[0]);
  const double cosine = glm::dot(normal, direction);
  if (cosine == 0) return std::nullopt;
  return origin + glm::dot(t[0] - origin, normal) / cosine * direction;
}

/// Of the coordinates that intersecting a sphere computes with.
double magnitude_of(const pathtracer::GpuSphere& sphere) {
  const glm::dvec3 begin(sphere.centre), end = begin + glm::dvec3(sphere.motion);
  return std::max({largest_magnitude(begin), largest_magnitude(end), double{sphere.radius}});
}

/// Where the ray first meets a sphere; nothing for one that passes by, or a sphere that moves: when the ray looks, only
/// the devices know.
std::optional<glm::dvec3> point_on_sphere(const TracedRay& ray, const pathtracer::GpuSphere& sphere) {
  if (sphere.motion != glm::vec3(0)) return std::nullopt;
  const glm::dvec3 direction(ray.direction), from_centre = glm::dvec3(ray.origin) - glm::dvec3(sphere.centre);
  const double a = glm::dot(direction, direction), b = glm::dot(from_centre, direction);
  const glm::dvec3 closest = from_centre - b / a * direction;
  const double discriminant = double{sphere.radius} * sphere.radius - glm::dot(closest, closest);
  if (!(discriminant >= 0)) return std::nullopt;
  const double half = std::sqrt(discriminant / a);
  const double t = -b / a > half ? -b / a - half : -b / a + half;
  if (!(t > 0)) return std::nullopt;
  return glm::dvec3(ray.origin) + t * direction;
}

/// Where the ray meets the primitive that an answer names, if that can be told.
std::optional<glm::dvec3> point_on(const TracedRay& ray, const pathtracer::Scene& scene, std::uint32_t answer) {
  if (answer < scene.triangles.size()) return point_in_plane(ray, corners_of(scene, answer));
  const pathtracer::GpuSphere* sphere = sphere_of(scene, answer);
  return sphere != nullptr ? point_on_sphere(ray, *sphere) : std::nullopt;
}

double magnitude_of(const pathtracer::Scene& scene) {
  double magnitude = 0;
  for (const pathtracer::GpuSphere& sphere : scene.spheres) magnitude = std::max(magnitude, magnitude_of(sphere));
  for (const glm::vec3& position : scene.positions)
    magnitude = std::max(magnitude, largest_magnitude(glm::dvec3(position)));
  return magnitude;
}

/// How far rounding may put a hit from where it is, in world space. @param scene_magnitude magnitude_of(scene)
double tolerated_distance(const TracedRay& ray, const pathtracer::Scene& scene, double scene_magnitude,
                          std::uint32_t primitive) {
  double magnitude = scene_magnitude;
  if (primitive < scene.triangles.size()) {
    const Corners t = corners_of(scene, primitive);
    magnitude = std::max({largest_magnitude(t[0]), largest_magnitude(t[1]), largest_magnitude(t[2])});
  } else if (const pathtracer::GpuSphere* sphere = sphere_of(scene, primitive)) {
    magnitude = magnitude_of(*sphere);
  }
  magnitude = std::max(magnitude, largest_magnitude(glm::dvec3(ray.origin)));
  return rounding_distance(magnitude);
}

/// Two unit vectors perpendicular to `v` and to each other.
std::pair<glm::dvec3, glm::dvec3> perpendicular(const glm::dvec3& v) {
  const glm::dvec3 axis = std::abs(v.x) < 0.5 * glm::length(v) ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  const glm::dvec3 first = glm::normalize(glm::cross(v, axis));
  return {first, glm::normalize(glm::cross(v, first))};
}

/// Rays that differ from this one by up to `distance`: moved aside as a whole, tilted about its origin, and with either
/// end moved along it.
std::vector<TracedRay> neighbours(const TracedRay& ray, double distance, double reach) {
  constexpr int directions = 16;
  constexpr double pi = 3.14159265358979323846;
  const glm::dvec3 origin(ray.origin), direction(ray.direction);
  const double length = glm::length(direction);
  const auto [right, up] = perpendicular(direction);
  std::vector<TracedRay> rays;
  const auto add = [&](const glm::dvec3& from, const glm::dvec3& along, double t_max) {
    TracedRay moved = ray;
    moved.origin = glm::vec3(from);
    moved.direction = glm::vec3(along);
    moved.t_max = static_cast<float>(t_max);
    rays.push_back(moved);
  };
  for (const double fraction : {0.125, 0.5, 1.0}) {
    for (int i = 0; i < directions; ++i) {
      const double angle = 2 * pi * i / directions;
      const glm::dvec3 aside = distance * fraction * (std::cos(angle) * right + std::sin(angle) * up);
      add(origin + aside, direction, ray.t_max);
      if (reach > 0) add(origin, direction + aside / reach, ray.t_max);
    }
    const double along = distance * fraction / length;
    for (const double sign : {-1.0, 1.0}) {
      add(origin + sign * along * direction, direction, ray.t_max);
      add(origin, direction, ray.t_max + sign * along);
    }
  }
  return rays;
}

/// Whether the ray passes within `distance` of a triangle, in front of what it exactly hits, or not that far behind:
/// an intersection test may then take the triangle to be hit. A triangle that is seen edge-on is hit by no ray
/// exactly. Of a sphere the neighbours of the ray say as much.
bool passes_by(const TracedRay& ray, const pathtracer::Scene& scene, std::uint32_t triangle, std::uint32_t exact,
               double distance) {
  if (triangle >= scene.triangles.size()) return false;
  const Corners t = corners_of(scene, triangle);
  const glm::dvec3 origin(ray.origin);
  double reach = std::numeric_limits<double>::infinity();  // to the exact hit
  if (exact != pathtracer::no_primitive) {
    const std::optional<glm::dvec3> hit = point_on(ray, scene, exact);
    if (!hit) return false;
    if (glm::distance(closest_point(t, *hit), *hit) <= distance) return true;
    reach = glm::distance(*hit, origin);
  }
  for (const auto& [from, to] : {std::pair(t[0], t[1]), std::pair(t[1], t[2]), std::pair(t[2], t[0])}) {
    const auto [on_ray, on_edge] = closest_points(geometry_ray(ray), double{ray.t_max}, from, to);
    if (glm::distance(on_ray, on_edge) <= distance && glm::distance(on_ray, origin) <= reach + distance) return true;
  }
  return false;
}

}  // namespace

const char* name(Ruling ruling) {
  switch (ruling) {
    case Ruling::a_right:
      return "a is right";
    case Ruling::b_right:
      return "b is right";
    case Ruling::both_wrong:
      return "both are wrong";
    case Ruling::tie:
      return "tie";
  }
  return "";
}

std::vector<Arbitration> arbitrate(std::span<const Dispute> disputes, const pathtracer::Scene& scene,
                                   const ExactTracer& trace) {
  std::vector<TracedRay> rays;
  for (const Dispute& dispute : disputes) rays.push_back(dispute.ray);
  const std::vector<std::uint32_t> exact = trace(rays);

  const double scene_magnitude = magnitude_of(scene);
  // All neighbours in one go: a device is slow to start.
  std::vector<TracedRay> moved;
  std::vector<std::size_t> first_moved;
  std::vector<double> distances;
  for (std::size_t i = 0; i < disputes.size(); ++i) {
    const TracedRay& ray = disputes[i].ray;
    // The answer to a shadow ray names no primitive.
    const std::uint32_t primitive = ray.kind == RayKind::closest ? exact[i] : pathtracer::no_primitive;
    distances.push_back(tolerated_distance(ray, scene, scene_magnitude, primitive));
    double reach = ray.kind == RayKind::occlusion ? double{ray.t_max} : 0.0;
    if (const auto hit = point_on(ray, scene, primitive))
      reach = glm::distance(*hit, glm::dvec3(ray.origin)) / glm::length(glm::dvec3(ray.direction));
    first_moved.push_back(moved.size());
    const std::vector<TracedRay> around = neighbours(ray, distances.back(), reach);
    moved.insert(moved.end(), around.begin(), around.end());
  }
  first_moved.push_back(moved.size());
  const std::vector<std::uint32_t> moved_answers = trace(moved);

  std::vector<Arbitration> arbitrations;
  for (std::size_t i = 0; i < disputes.size(); ++i) {
    const Dispute& dispute = disputes[i];
    const auto is_right = [&](std::uint32_t answer) {
      if (answer == exact[i]) return true;
      const auto begin = moved_answers.begin() + static_cast<std::ptrdiff_t>(first_moved[i]);
      const auto end = moved_answers.begin() + static_cast<std::ptrdiff_t>(first_moved[i + 1]);
      if (std::find(begin, end, answer) != end) return true;
      return dispute.ray.kind == RayKind::closest && passes_by(dispute.ray, scene, answer, exact[i], distances[i]);
    };
    const bool a = is_right(dispute.answer_a), b = is_right(dispute.answer_b);
    arbitrations.push_back(
        {.ruling = a && b ? Ruling::tie : (a ? Ruling::a_right : (b ? Ruling::b_right : Ruling::both_wrong)),
         .exact_answer = exact[i]});
  }
  return arbitrations;
}

}  // namespace tandem::compare
