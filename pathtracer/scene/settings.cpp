#include "pathtracer/scene/settings.hpp"

namespace tandem::pathtracer {

SceneSettings merged(const SceneSettings& first, const SceneSettings& second) {
  SceneSettings result = first;
  const auto fill = [](auto& member, const auto& other) {
    if (!member) member = other;
  };
  fill(result.width, second.width);
  fill(result.height, second.height);
  fill(result.samples, second.samples);
  fill(result.max_depth, second.max_depth);
  fill(result.seed, second.seed);
  fill(result.background, second.background);
  fill(result.integrator, second.integrator);
  fill(result.sampler, second.sampler);
  fill(result.light_sampling, second.light_sampling);
  fill(result.mis, second.mis);
  fill(result.bsdf_sampling, second.bsdf_sampling);
  fill(result.roulette, second.roulette);
  fill(result.max_diffuse_depth, second.max_diffuse_depth);
  fill(result.max_glossy_depth, second.max_glossy_depth);
  fill(result.max_specular_depth, second.max_specular_depth);
  fill(result.clamp_direct, second.clamp_direct);
  fill(result.clamp_indirect, second.clamp_indirect);
  fill(result.occlusion_length, second.occlusion_length);
  fill(result.terminator_offset, second.terminator_offset);
  return result;
}

std::span<const Named<Integrator>> integrator_names() {
  static constexpr Named<Integrator> names[] = {{Integrator::path, "path"},
                                                {Integrator::direct, "direct"},
                                                {Integrator::ambient_occlusion, "ambient-occlusion"},
                                                {Integrator::metropolis, "metropolis"}};
  return names;
}

std::span<const Named<SamplerKind>> sampler_names() {
  static constexpr Named<SamplerKind> names[] = {{SamplerKind::independent, "independent"},
                                                 {SamplerKind::stratified, "stratified"},
                                                 {SamplerKind::halton, "halton"},
                                                 {SamplerKind::hammersley, "hammersley"},
                                                 {SamplerKind::sobol, "sobol"},
                                                 {SamplerKind::blue_noise, "blue-noise"}};
  return names;
}

std::span<const Named<Mis>> mis_names() {
  static constexpr Named<Mis> names[] = {{Mis::none, "none"}, {Mis::balance, "balance"}, {Mis::power, "power"}};
  return names;
}

std::span<const Named<BsdfSampling>> bsdf_sampling_names() {
  static constexpr Named<BsdfSampling> names[] = {
      {BsdfSampling::bsdf, "bsdf"}, {BsdfSampling::cosine, "cosine"}, {BsdfSampling::uniform, "uniform"}};
  return names;
}

std::span<const Named<CameraKind>> camera_names() {
  static constexpr Named<CameraKind> names[] = {{CameraKind::perspective, "perspective"},
                                                {CameraKind::orthographic, "orthographic"},
                                                {CameraKind::equirectangular, "equirectangular"}};
  return names;
}

}  // namespace tandem::pathtracer
