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

/// How far an edge may be from where it is, for each unit of the distances of its ends from the ray's origin, in a test
/// by the ray's moments about edges: each moment is a sum of products of rounded differences.
constexpr double edge_error = 8 * 0x1p-24;

/// How much of a pixel rounding may move a ray: less than anybody can see. In pictures of usual scenes rounding reaches
/// some thousandths of a pixel; it reaches this where coordinates are thousands of times as large as what is seen.
constexpr double tolerated_pixel = 0.1;

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

/// How far rounding may move a ray or a hit, in world space.
class Tolerance {
 public:
  Tolerance(const pathtracer::Scene& scene, const PixelFootprint& footprint)
      : scene_(scene), footprint_(footprint), scene_magnitude_(magnitude_of(scene)) {}

  /// By the coordinates that a device computes with, wherever the hit is.
  /// @param primitive that is hit; none or unknown: any
  double by_coordinates(const TracedRay& ray, std::uint32_t primitive) const {
    double magnitude = scene_magnitude_;
    if (primitive < scene_.triangles.size()) {
      const Corners t = corners_of(scene_, primitive);
      magnitude = std::max({largest_magnitude(t[0]), largest_magnitude(t[1]), largest_magnitude(t[2])});
    } else if (const pathtracer::GpuSphere* sphere = sphere_of(scene_, primitive)) {
      magnitude = magnitude_of(*sphere);
    }
    magnitude = std::max(magnitude, largest_magnitude(glm::dvec3(ray.origin)));
    return rounding_distance(magnitude);
  }

  /// At a point. Large coordinates excuse only what is small in the picture.
  double at(const TracedRay& ray, std::uint32_t primitive, const glm::dvec3& point) const {
    return std::min(by_coordinates(ray, primitive), in_picture(ray, point));
  }

  /// What is small in the picture: a tenth of a pixel, or the last bits of the distance, where a pixel is smaller than
  /// they are.
  double in_picture(const TracedRay& ray, const glm::dvec3& point) const {
    return std::max(tolerated_pixel * pixel_width(footprint_, point),
                    rounding_distance(glm::distance(glm::dvec3(ray.origin), point)) / 8);
  }

 private:
  const pathtracer::Scene& scene_;
  const PixelFootprint& footprint_;
  double scene_magnitude_;
};

/// Two unit vectors perpendicular to `v` and to each other.
std::pair<glm::dvec3, glm::dvec3> perpendicular(const glm::dvec3& v) {
  const glm::dvec3 axis = std::abs(v.x) < 0.5 * glm::length(v) ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  const glm::dvec3 first = glm::normalize(glm::cross(v, axis));
  return {first, glm::normalize(glm::cross(v, first))};
}

/// A ray beside another one.
struct Neighbour {
  TracedRay ray;
  double distance = 0;  ///< by which they differ
};

/// Adds rays that differ from this one by up to `distance`: moved aside as a whole, tilted about its origin, and with
/// either end moved along it.
void add_neighbours(const TracedRay& ray, double distance, double reach, std::vector<Neighbour>& neighbours) {
  constexpr int directions = 16;
  constexpr double pi = 3.14159265358979323846;
  const glm::dvec3 origin(ray.origin), direction(ray.direction);
  const double length = glm::length(direction);
  const auto [right, up] = perpendicular(direction);
  for (const double fraction : {0.125, 0.5, 1.0}) {
    const auto add = [&](const glm::dvec3& from, const glm::dvec3& along, double t_max) {
      TracedRay moved = ray;
      moved.origin = glm::vec3(from);
      moved.direction = glm::vec3(along);
      moved.t_max = static_cast<float>(t_max);
      neighbours.push_back({.ray = moved, .distance = distance * fraction});
    };
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
}

/// Whether the ray passes a triangle within the tolerance there, in front of what it exactly hits, or not that far
/// behind: an intersection test may then take the triangle to be hit. A triangle that is seen edge-on is hit by no ray
/// exactly. Of a sphere the neighbours of the ray say as much.
bool passes_by(const TracedRay& ray, const pathtracer::Scene& scene, std::uint32_t triangle, std::uint32_t exact,
               const Tolerance& tolerance) {
  if (triangle >= scene.triangles.size()) return false;
  const Corners t = corners_of(scene, triangle);
  const glm::dvec3 origin(ray.origin);
  double reach = std::numeric_limits<double>::infinity();  // to the exact hit
  if (exact != pathtracer::no_primitive) {
    const std::optional<glm::dvec3> hit = point_on(ray, scene, exact);
    if (!hit) return false;
    if (glm::distance(closest_point(t, *hit), *hit) <= tolerance.at(ray, exact, *hit)) return true;
    reach = glm::distance(*hit, origin);
  }
  for (const auto& [from, to] : {std::pair(t[0], t[1]), std::pair(t[1], t[2]), std::pair(t[2], t[0])}) {
    const auto [on_ray, on_edge] = closest_points(geometry_ray(ray), double{ray.t_max}, from, to);
    const double distance = tolerance.at(ray, exact, on_ray);
    if (glm::distance(on_ray, on_edge) <= distance && glm::distance(on_ray, origin) <= reach + distance) return true;
  }
  return false;
}

/// Whether the two triangles meet at an edge or a vertex that the ray passes so closely that single precision may take
/// either side of it for the other. What it takes for which depends on how far the ends of the edge are, however near
/// the ray is to it; but it takes the same for both triangles, so this excuses no device that meets neither.
bool is_across_edge(const TracedRay& ray, const pathtracer::Scene& scene, std::uint32_t exact, std::uint32_t answer) {
  if (exact >= scene.triangles.size() || answer >= scene.triangles.size()) return false;
  const Corners corners = corners_of(scene, exact), others = corners_of(scene, answer);
  std::vector<glm::dvec3> shared;
  for (const glm::dvec3& corner : corners)
    if (std::ranges::find(others, corner) != others.end()) shared.push_back(corner);
  if (shared.empty() || shared.size() > 2) return false;
  const glm::dvec3 origin(ray.origin);
  const double reach = glm::distance(shared.front(), origin) + glm::distance(shared.back(), origin);
  return distance_from_line(geometry_ray(ray), shared.front(), shared.back()) <= edge_error * reach;
}

/// Whether a ray was moved through the plane of what it hits then, by more than the coordinates of its own origin
/// account for. It left that surface at a distance that is safe from rounding, and would never meet it.
bool starts_behind(const TracedRay& ray, const Neighbour& neighbour, const pathtracer::Scene& scene,
                   std::uint32_t triangle) {
  const glm::dvec3 origin(ray.origin);
  if (triangle >= scene.triangles.size() || neighbour.distance <= rounding_distance(largest_magnitude(origin)))
    return false;
  const Corners t = corners_of(scene, triangle);
  const glm::dvec3 normal = glm::cross(t[1] - t[0], t[2] - t[0]);
  return glm::dot(normal, origin - t[0]) * glm::dot(normal, glm::dvec3(neighbour.ray.origin) - t[0]) < 0;
}

/// A ray like this one that tells the first thing that is hit.
TracedRay as_closest(TracedRay ray) {
  ray.kind = RayKind::closest;
  return ray;
}

/// The search for the answers that rays beside a disputed one have.
class Search {
 public:
  /// @param first what the ray hits first, exactly; of an occlusion ray as well
  Search(const Dispute& dispute, std::uint32_t exact, std::uint32_t first, const pathtracer::Scene& scene,
         const Tolerance& tolerance)
      : dispute_(dispute), exact_(exact), scene_(scene), tolerance_(tolerance) {
    const TracedRay& ray = dispute.ray;
    const bool is_closest = ray.kind == RayKind::closest;
    const glm::dvec3 origin(ray.origin);
    double reach = is_closest ? 0.0 : double{ray.t_max};
    // The answer to a shadow ray names no primitive.
    const std::uint32_t primitive = is_closest ? first : pathtracer::no_primitive;
    hit_ = point_on(ray, scene, first);
    if (hit_) {
      if (is_closest) reach = glm::distance(*hit_, origin) / glm::length(glm::dvec3(ray.direction));
      add_neighbours(ray, tolerance.at(ray, primitive, *hit_), reach, neighbours_);
      return;
    }
    // What might be hit may be anywhere along the ray, and the tolerance is what it is there: all sizes are tried.
    const double largest = tolerance.by_coordinates(ray, primitive);
    const double smallest = std::clamp(tolerance.in_picture(ray, origin), largest * 1e-6, largest);
    for (double distance = largest; distance > smallest / 2; distance /= 16)
      add_neighbours(ray, distance, reach, neighbours_);
  }

  const std::vector<Neighbour>& neighbours() const { return neighbours_; }

  /// Takes what the neighbours answer. Those must be asked again, for what they hit, that are added to `again`.
  void take(std::span<const std::uint32_t> answers, std::vector<TracedRay>& again) {
    for (std::size_t i = 0; i < neighbours_.size(); ++i) {
      if (answers[i] == exact_) continue;
      if (dispute_.ray.kind == RayKind::closest) {
        add_if_close(neighbours_[i], answers[i], answers[i]);
      } else if (answers[i] == 0) {
        answers_.push_back(0);
      } else {
        asked_again_.push_back(i);
        again.push_back(as_closest(neighbours_[i].ray));
      }
    }
  }
  std::size_t asked_again() const { return asked_again_.size(); }
  void take_again(std::span<const std::uint32_t> firsts) {
    for (std::size_t i = 0; i < asked_again_.size(); ++i) add_if_close(neighbours_[asked_again_[i]], firsts[i], 1);
  }

  bool is_right(std::uint32_t answer) const {
    if (answer == exact_ || std::ranges::find(answers_, answer) != answers_.end()) return true;
    return dispute_.ray.kind == RayKind::closest && (passes_by(dispute_.ray, scene_, answer, exact_, tolerance_) ||
                                                     is_across_edge(dispute_.ray, scene_, exact_, answer));
  }

 private:
  /// @param first what the neighbour hits
  void add_if_close(const Neighbour& neighbour, std::uint32_t first, std::uint32_t answer) {
    if (starts_behind(dispute_.ray, neighbour, scene_, first)) return;
    const std::optional<glm::dvec3> point = hit_ ? std::nullopt : point_on(neighbour.ray, scene_, first);
    if (!point || neighbour.distance <= tolerance_.in_picture(neighbour.ray, *point)) answers_.push_back(answer);
  }

  const Dispute& dispute_;
  std::uint32_t exact_;
  const pathtracer::Scene& scene_;
  const Tolerance& tolerance_;
  std::optional<glm::dvec3> hit_;  ///< of the ray itself; none: it hits nothing, or it cannot be told where
  std::vector<Neighbour> neighbours_;
  std::vector<std::size_t> asked_again_;
  std::vector<std::uint32_t> answers_;  ///< that a ray within the tolerance has
};

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
                                   const PixelFootprint& footprint, const ExactTracer& trace) {
  // Rays are traced together: a device is slow to start.
  std::vector<TracedRay> rays;
  for (const Dispute& dispute : disputes) rays.push_back(dispute.ray);
  const std::vector<std::uint32_t> exact = trace(rays);
  std::ranges::transform(rays, rays.begin(), as_closest);
  const std::vector<std::uint32_t> first = trace(rays);

  const Tolerance tolerance(scene, footprint);
  std::vector<Search> searches;
  rays.clear();
  for (std::size_t i = 0; i < disputes.size(); ++i) {
    const Search& search = searches.emplace_back(disputes[i], exact[i], first[i], scene, tolerance);
    for (const Neighbour& neighbour : search.neighbours()) rays.push_back(neighbour.ray);
  }
  const std::vector<std::uint32_t> answers = trace(rays);
  rays.clear();
  std::size_t taken = 0;
  for (Search& search : searches) {
    search.take(std::span(answers).subspan(taken, search.neighbours().size()), rays);
    taken += search.neighbours().size();
  }
  if (!rays.empty()) {
    const std::vector<std::uint32_t> again = trace(rays);
    taken = 0;
    for (Search& search : searches) {
      search.take_again(std::span(again).subspan(taken, search.asked_again()));
      taken += search.asked_again();
    }
  }

  std::vector<Arbitration> arbitrations;
  for (std::size_t i = 0; i < disputes.size(); ++i) {
    const bool a = searches[i].is_right(disputes[i].answer_a), b = searches[i].is_right(disputes[i].answer_b);
    arbitrations.push_back(
        {.ruling = a && b ? Ruling::tie : (a ? Ruling::a_right : (b ? Ruling::b_right : Ruling::both_wrong)),
         .exact_answer = exact[i]});
  }
  return arbitrations;
}

}  // namespace tandem::compare
