#include "pathtracer/render/features.hpp"

#include <algorithm>

namespace tandem::pathtracer {
namespace {

/// By ascending cost. shaders/CMakeLists.txt must list the same.
constexpr Features built[] = {
    0,
    feature::transparency,
    feature::transparency | feature::spheres | feature::cameras,
    feature::textures | feature::materials | feature::lights | feature::cameras | feature::samplers | feature::options,
    feature::all,
};

bool is_basic(MaterialModel model) {
  return model == MaterialModel::diffuse || model == MaterialModel::mirror || model == MaterialModel::dielectric;
}

/// Opacities alone, where they are images, need no more than transparency.
bool needs_textures(const Scene& scene, GpuMaterial material) {
  const std::uint32_t alpha = material.alpha_texture;
  if (alpha != no_texture && scene.textures[alpha].gpu.kind == TextureKind::image) material.alpha_texture = no_texture;
  return has_texture(material);
}

}  // namespace

Features features_of(const Scene& scene) {
  Features features = 0;
  for (const GpuMaterial& material : scene.materials) {
    if (is_transparent(material)) features |= feature::transparency;
    if (needs_textures(scene, material) || material.attributes != 0) features |= feature::textures;
    if (material.model == MaterialModel::boundary)
      features |= feature::media;
    else if (!is_basic(material.model))
      features |= feature::materials;
  }
  if (!scene.spheres.empty()) features |= feature::spheres;
  if (!scene.lights.empty() || scene.environment) features |= feature::lights;
  const bool emits = std::ranges::any_of(scene.spheres, [&](const GpuSphere& sphere) {
    return scene.materials[sphere.material].emission != glm::vec3(0);
  });
  if (emits) features |= feature::lights;
  if (!scene.media.empty()) features |= feature::media;
  return features;
}

Features built_features(Features needed) {
  return *std::ranges::find_if(built, [&](Features features) { return (needed & ~features) == 0; });
}

std::vector<rhi::SpecializationValue> specialization(Features features) {
  std::vector<rhi::SpecializationValue> values;
  for (std::uint32_t id = 0; id < feature::count; ++id) values.push_back({.id = id, .value = features >> id & 1u});
  return values;
}

}  // namespace tandem::pathtracer
