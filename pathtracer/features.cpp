#include "pathtracer/features.hpp"

#include <algorithm>

namespace tandem::pathtracer {
namespace {

/// By ascending cost. shaders/CMakeLists.txt must list the same.
constexpr Features built[] = {
    0,
    feature::transparency,
    feature::textures | feature::materials | feature::lights | feature::cameras | feature::samplers | feature::options,
    feature::all,
};

bool is_basic(MaterialModel model) {
  return model == MaterialModel::diffuse || model == MaterialModel::mirror || model == MaterialModel::dielectric;
}

bool has_texture(const GpuMaterial& material) {
  const std::uint32_t textures[] = {
      material.base_color_texture,    material.emission_texture, material.reflectance_texture,
      material.roughness_texture,     material.metallic_texture, material.transmission_texture,
      material.transmittance_texture, material.specular_texture, material.exponent_texture,
      material.normal_texture,        material.bump_texture};
  return std::ranges::any_of(textures, [](std::uint32_t texture) { return texture != no_texture; });
}

}  // namespace

Features features_of(const Scene& scene) {
  Features features = 0;
  for (const GpuMaterial& material : scene.materials) {
    if (is_transparent(material)) features |= feature::transparency;
    if (has_texture(material)) features |= feature::textures;
    // Images as opacities need no more than transparency.
    if (material.alpha_texture != no_texture && scene.textures[material.alpha_texture].gpu.kind != TextureKind::image)
      features |= feature::textures;
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
