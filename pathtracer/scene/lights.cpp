#include "pathtracer/scene/lights.hpp"

#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>
#include <string>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <glm/vector_relational.hpp>

#include "base/error.hpp"
#include "pathtracer/scene/alias_table.hpp"
#include "pathtracer/scene/environment.hpp"
#include "pathtracer/scene/texel.hpp"

namespace tandem::pathtracer {
namespace {

constexpr double pi = std::numbers::pi;

/// The mean luminance of what each material emits, computed where it is asked for.
class MeanEmission {
 public:
  explicit MeanEmission(const Scene& scene) : scene_(scene), luminances_(scene.materials.size()) {}

  double of(std::uint32_t material) {
    std::optional<double>& known = luminances_[material];
    if (known) return *known;
    const GpuMaterial& values = scene_.materials[material];
    glm::vec3 emission = values.emission;
    if (emission != glm::vec3(0) && values.emission_texture != no_texture)
      emission *= mean_color(scene_, scene_.textures[values.emission_texture]);
    known = luminance(emission);
    return *known;
  }

 private:
  const Scene& scene_;
  std::vector<std::optional<double>> luminances_;
};

Emitter punctual_emitter(const PunctualLight& light, const std::string& label, double radius) {
  const auto is_finite = [](glm::vec3 v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); };
  if (!is_finite(light.radiance) || glm::any(glm::lessThan(light.radiance, glm::vec3(0))))
    throw Error(label + ": its intensity is not finite and at least 0");
  if (!is_finite(light.position)) throw Error(label + ": its position is not finite");
  if (light.kind != LightKind::point && light.kind != LightKind::spot && light.kind != LightKind::directional)
    throw Error(label + ": it has an extent");
  const double power = luminance(light.radiance);
  Emitter emitter{.light = {.kind = light.kind, .position = light.position, .radiance = light.radiance}};
  if (light.kind == LightKind::point) {
    emitter.power = 4 * pi * power;
    return emitter;
  }
  const glm::dvec3 direction(light.direction);
  const double length = glm::length(direction);
  if (!(length > 0) || !std::isfinite(length)) throw Error(label + ": its direction is zero or not finite");
  emitter.light.direction = glm::vec3(direction / length);
  if (light.kind == LightKind::directional) {
    emitter.power = pi * radius * radius * power;
    return emitter;
  }
  if (!(light.inner_angle >= 0 && light.inner_angle < light.outer_angle && light.outer_angle <= 90))
    throw Error(fmt::format("{}: the angles of a spot light, {} and {} degrees, are not ascending from 0 to 90", label,
                            light.inner_angle, light.outer_angle));
  const double inner = std::cos(glm::radians(double{light.inner_angle}));
  const double outer = std::cos(glm::radians(double{light.outer_angle}));
  emitter.light.cosine_inner = static_cast<float>(inner);
  emitter.light.cosine_outer = static_cast<float>(outer);
  // The integral of the falloff over all directions.
  emitter.power = 2 * pi * ((1 - inner) + (inner - outer) / 3) * power;
  return emitter;
}

}  // namespace

double luminance(glm::vec3 rgb) { return 0.2126 * double{rgb.x} + 0.7152 * double{rgb.y} + 0.0722 * double{rgb.z}; }

double scene_radius(const Scene& scene) {
  const Bounds box = bounds(scene);
  const double radius = 0.5 * glm::length(glm::dvec3(box.maximum) - glm::dvec3(box.minimum));
  return radius > 0 ? radius : 1;
}

std::vector<Emitter> scene_emitters(const Scene& scene) {
  std::vector<Emitter> emitters;
  MeanEmission emission(scene);
  const auto add = [&](LightKind kind, std::size_t primitive, double area, double radiance) {
    if (!(area * radiance > 0)) return;
    emitters.push_back({.light = {.primitive = static_cast<std::uint32_t>(primitive), .kind = kind},
                        .power = pi * area * radiance,
                        .area = area});
  };
  for (std::size_t i = 0; i < scene.triangles.size(); ++i) {
    const GpuTriangle& triangle = scene.triangles[i];
    const double radiance = emission.of(triangle.material & ~triangle_smooth);
    if (radiance > 0) add(LightKind::triangle, i, triangle_area(scene, triangle), radiance);
  }
  for (std::size_t i = 0; i < scene.spheres.size(); ++i) {
    const double radius = scene.spheres[i].radius;
    add(LightKind::sphere, scene.triangles.size() + i, 4 * pi * radius * radius,
        emission.of(scene.spheres[i].material));
  }
  const double environment = environment_luminance(scene);
  if (environment > 0) {
    const double radius = scene_radius(scene);
    emitters.push_back({.light = {.kind = LightKind::environment}, .power = pi * radius * radius * environment});
  }
  return emitters;
}

std::vector<Emitter> punctual_emitters(std::span<const PunctualLight> lights, const std::string& scene_name,
                                       double radius) {
  std::vector<Emitter> emitters;
  for (std::size_t i = 0; i < lights.size(); ++i) {
    const Emitter emitter = punctual_emitter(lights[i], fmt::format("light {} of {}", i, scene_name), radius);
    if (emitter.power > 0) emitters.push_back(emitter);
  }
  return emitters;
}

std::vector<GpuLight> light_table(std::span<const Emitter> emitters) {
  if (emitters.empty()) return {};
  std::vector<double> powers;
  for (const Emitter& emitter : emitters) powers.push_back(emitter.power);
  const std::vector<AliasEntry> table = build_alias_table(powers);
  const std::vector<double> probabilities = alias_probabilities(table);
  std::vector<GpuLight> lights;
  for (std::size_t i = 0; i < emitters.size(); ++i) {
    GpuLight light = emitters[i].light;
    light.alias = table[i].alias;
    light.threshold = table[i].threshold;
    light.probability = static_cast<float>(probabilities[i]);
    if (emitters[i].area > 0) light.area_density = static_cast<float>(probabilities[i] / emitters[i].area);
    lights.push_back(light);
  }
  return lights;
}

std::vector<GpuLight> build_lights(const Scene& scene) {
  std::vector<Emitter> emitters = scene_emitters(scene);
  const std::vector<Emitter> punctual = punctual_emitters(scene.lights, scene.name, scene_radius(scene));
  emitters.insert(emitters.end(), punctual.begin(), punctual.end());
  return light_table(emitters);
}

std::vector<double> light_probabilities(const std::vector<GpuLight>& lights) {
  std::vector<AliasEntry> table;
  for (const GpuLight& light : lights) table.push_back({.threshold = light.threshold, .alias = light.alias});
  return alias_probabilities(table);
}

}  // namespace tandem::pathtracer
