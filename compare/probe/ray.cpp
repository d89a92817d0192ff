#include "compare/probe/ray.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include "pathtracer/render/path_recorder.hpp"

namespace tandem::compare {
namespace {

/// The nearest hit that counts.
std::optional<Intersection> first_of(std::span<const ProbeHit> hits) {
  std::optional<Intersection> first;
  for (const ProbeHit& hit : hits)
    if (hit.counts && (!first || hit.intersection.t_low < first->t_low)) first = hit.intersection;
  return first;
}

void cut(ProbeRay& ray, Window window, const Intersection& first) {
  // Far enough from the hit that rounding cannot move it over the end, and no farther.
  const double gap = first.t_high - first.t_low;
  const double before = std::max(first.t_low - gap, 0.0), behind = first.t_high + gap;
  switch (window) {
    case Window::whole:
      break;
    case Window::from_before:
      ray.t_min = static_cast<float>(before);
      break;
    case Window::from_behind:
      ray.t_min = std::min(static_cast<float>(behind), ray.t_max);
      break;
    case Window::until_before:
      ray.t_max = static_cast<float>(before);
      break;
    case Window::until_behind:
      ray.t_max = std::min(static_cast<float>(behind), ray.t_max);
      break;
  }
}

}  // namespace

std::vector<PathRay> path_rays(pathtracer::SceneOnDevice& scene, std::size_t count) {
  // A few rays of each of many paths, so that there are rays of every bounce.
  constexpr std::size_t rays_of_path = 4;
  constexpr std::size_t most_at_once = 4096;  // paths, whose events are in memory together
  const glm::uvec2 size(scene.settings().width, scene.settings().height);
  const std::size_t pixel_count = std::size_t{size.x} * size.y;
  const std::size_t path_count = std::min(pixel_count, (count + rays_of_path - 1) / rays_of_path);
  std::vector<pathtracer::PathStart> starts;
  for (std::size_t i = 0; i < path_count; ++i) {
    const std::size_t pixel = i * pixel_count / path_count;
    starts.push_back({.path = {.pixel = {pixel % size.x, pixel / size.x}, .sample = 0}});
  }
  std::vector<PathRay> rays;
  for (std::size_t first = 0; first < starts.size(); first += most_at_once) {
    const auto some = std::span(starts).subspan(first, std::min(most_at_once, starts.size() - first));
    const std::vector<pathtracer::PathEvents> events = pathtracer::record_paths(scene, some);
    for (std::size_t i = 0; i < some.size(); ++i) {
      const std::vector<pathtracer::TracedRay> of_path = pathtracer::rays_of(some[i].path, events[i]);
      for (std::uint32_t index = 0; index < of_path.size(); ++index)
        if (is_askable(of_path[index])) rays.push_back({.path = some[i].path, .index = index, .ray = of_path[index]});
    }
  }
  return spread_evenly(rays, count);
}

bool is_askable(const pathtracer::TracedRay& ray) {
  const auto is_finite = [](const glm::vec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
  };
  return is_finite(ray.origin) && is_finite(ray.direction) && ray.direction != glm::vec3(0) && ray.t_max > 0;
}

std::vector<PathRay> spread_evenly(std::span<const PathRay> rays, std::size_t count) {
  if (rays.size() <= count) return {rays.begin(), rays.end()};
  std::vector<PathRay> chosen;
  for (std::size_t i = 0; i < count; ++i) chosen.push_back(rays[i * rays.size() / count]);
  return chosen;
}

std::vector<ProbeRay> rays_of(const Trial& trial, std::span<const PathRay> rays, const ProbeReference& reference,
                              const pathtracer::Scene& scene) {
  std::vector<AffineMap> maps;
  for (const Placement& placement : placements(trial.instance_setup, scene))
    maps.push_back(map_of(placement.transform));
  const std::vector<ProbeInstance> instances = reference.instances(trial.instance_setup);
  std::vector<ProbeRay> asked;
  asked.reserve(rays.size());
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const AffineMap& map = maps[trial.target == each_in_turn ? i % maps.size() : trial.target];
    const pathtracer::TracedRay& ray = rays[i].ray;
    ProbeRay& moved = asked.emplace_back(ProbeRay{.origin = glm::vec3(map.point(glm::dvec3(ray.origin))),
                                                  .t_min = 0,
                                                  .direction = glm::vec3(map.linear * glm::dvec3(ray.direction)),
                                                  .t_max = ray.t_max});
    if (trial.window == Window::whole) continue;
    if (const std::optional<Intersection> first = first_of(reference.hits(trial, instances, moved)))
      cut(moved, trial.window, *first);
  }
  return asked;
}

}  // namespace tandem::compare
