#include "pathtracer/scene/studio.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>

#include "pathtracer/scene/lights.hpp"

namespace tandem::pathtracer {
namespace {

constexpr double pi = std::numbers::pi;

/// Whether all that emits are surfaces whose emission is a texture.
bool emits_by_textures(const Scene& scene, const std::vector<Emitter>& emitters) {
  return std::ranges::all_of(emitters, [&](const Emitter& emitter) {
    if (emitter.light.kind != LightKind::triangle) return false;
    const std::uint32_t material = scene.triangles[emitter.light.primitive].material & ~triangle_smooth;
    return scene.materials[material].emission_texture != no_texture;
  });
}

/// The radiance that arrives from a direction.
float studio_radiance(const glm::dvec3& direction) {
  const auto lamp = [&](glm::dvec3 towards, double radiance, double exponent) {
    return radiance * std::pow(std::max(0.0, glm::dot(direction, glm::normalize(towards))), exponent);
  };
  const double grey = 0.2 + 0.08 * direction.y;
  return static_cast<float>(grey + lamp({-0.6, 0.9, 0.8}, 6.5, 20) + lamp({1, 0.15, 0.2}, 0.8, 8));
}

}  // namespace

OwnLight own_light(const Scene& scene) {
  if (scene.environment || !scene.lights.empty()) return OwnLight::sufficient;
  const std::vector<Emitter> emitters = scene_emitters(scene);
  if (emitters.empty()) return OwnLight::none;
  double power = 0;
  for (const Emitter& emitter : emitters) power += emitter.power;
  const double radius = scene_radius(scene);
  const double radiance = power / (4 * pi * radius * radius) / pi;
  return radiance < (emits_by_textures(scene, emitters) ? 0.05 : 0.01) ? OwnLight::negligible : OwnLight::sufficient;
}

void add_studio(Scene& scene) {
  constexpr std::uint32_t width = 64, height = 32;
  TextureImage image{.name = "studio", .format = TexelFormat::float32, .width = width, .height = height, .texels = {}};
  for (std::uint32_t row = 0; row < height; ++row)
    for (std::uint32_t column = 0; column < width; ++column) {
      const double polar = pi * (row + 0.5) / height;
      const double azimuth = 2 * pi * ((column + 0.5) / width - 0.5);  // 0 at -z, growing towards +x
      const float radiance =
          studio_radiance({std::sin(polar) * std::sin(azimuth), std::cos(polar), -std::sin(polar) * std::cos(azimuth)});
      const float texel[4] = {radiance, radiance, radiance, 1};
      const auto* const bytes = reinterpret_cast<const std::byte*>(texel);
      image.texels.insert(image.texels.end(), bytes, bytes + sizeof texel);
    }
  if (scene.textures.empty()) scene.texture_coordinates.assign(scene.positions.size(), glm::vec2(0));
  scene.environment = Environment{.texture = add_texture(scene, std::move(image)), .radiance = glm::vec3(1)};
  scene.textures.back().gpu.address =
      static_cast<std::uint32_t>(TextureAddress::repeat) | static_cast<std::uint32_t>(TextureAddress::clamp) << 8;
}

}  // namespace tandem::pathtracer
