#include "pathtracer/render/render_settings.hpp"

#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "base/error.hpp"

namespace tandem::pathtracer {
namespace {

/// Pixel coordinates have 16 bits each in the random number generator's key.
constexpr std::uint32_t maximum_side = 1u << 16;
/// Far beyond use, and far from where the counts of rays could overflow.
constexpr std::uint32_t maximum_depth = 1u << 16;
constexpr std::uint32_t most_chains = 1u << 20;
constexpr std::uint32_t most_bootstrap_paths = 1u << 24;
constexpr std::uint32_t unlimited = std::numeric_limits<std::uint32_t>::max();

/// Of the paths: chains are another matter.
Integrator shader_integrator(const RenderSettings& settings) {
  return settings.integrator == Integrator::metropolis ? Integrator::path : settings.integrator;
}

void check_bound(float value, const char* what) {
  if (!(value >= 0) || !std::isfinite(value))
    throw Error(fmt::format("{} of {} is not finite and at least 0", what, value));
}

void check_metropolis(const RenderSettings& settings) {
  const MetropolisSettings& metropolis = settings.metropolis;
  if (settings.sampler != SamplerKind::independent)
    throw Error(fmt::format("sampler {} has no use in integrator metropolis, whose chains mutate independent numbers",
                            name_of(sampler_names(), settings.sampler)));
  if (metropolis.chains == 0 || metropolis.chains % 2 != 0 || metropolis.chains > most_chains)
    throw Error(fmt::format("{} chains are not an even number between 2 and {}", metropolis.chains, most_chains));
  if (metropolis.bootstrap_paths < 4 || metropolis.bootstrap_paths % 4 != 0 ||
      metropolis.bootstrap_paths > most_bootstrap_paths)
    throw Error(fmt::format("{} bootstrap paths are not a multiple of 4 up to {}", metropolis.bootstrap_paths,
                            most_bootstrap_paths));
  if (!(metropolis.large_step > 0 && metropolis.large_step <= 1))
    throw Error(fmt::format("a probability of large steps of {} is not in (0, 1]", metropolis.large_step));
}

}  // namespace

void check(const RenderSettings& settings) {
  if (settings.width == 0 || settings.height == 0)
    throw Error(fmt::format("a picture of {}x{} has no pixels", settings.width, settings.height));
  if (settings.width > maximum_side || settings.height > maximum_side)
    throw Error(fmt::format("a picture of {}x{} is too large: a side has at most {} pixels", settings.width,
                            settings.height, maximum_side));
  if (settings.max_depth == 0 || settings.max_depth > maximum_depth)
    throw Error(fmt::format("a path depth of {} is not between 1 and {}", settings.max_depth, maximum_depth));
  if (!(settings.submission_seconds > 0)) throw Error("the time of a submission is not positive");
  if (settings.planned_samples == 0) throw Error("no samples are planned");
  check_bound(settings.clamp_direct, "a bound of direct light");
  check_bound(settings.clamp_indirect, "a bound of indirect light");
  if (!(settings.occlusion_length > 0)) throw Error("the length of the rays of ambient occlusion is not positive");
  if (settings.integrator == Integrator::metropolis) check_metropolis(settings);
  if (settings.background)
    for (const float value : {settings.background->x, settings.background->y, settings.background->z})
      if (!(value >= 0) || !std::isfinite(value))
        throw Error(fmt::format("a background of {} {} {} is not finite and at least 0", settings.background->x,
                                settings.background->y, settings.background->z));
}

RenderSettings render_settings(const SceneSettings& given) {
  RenderSettings settings;
  const auto take = [](auto& member, const auto& value) {
    if (value) member = *value;
  };
  take(settings.width, given.width);
  take(settings.height, given.height);
  take(settings.max_depth, given.max_depth);
  take(settings.seed, given.seed);
  settings.background = given.background;
  take(settings.planned_samples, given.samples);
  take(settings.integrator, given.integrator);
  take(settings.sampler, given.sampler);
  take(settings.light_sampling, given.light_sampling);
  take(settings.mis, given.mis);
  take(settings.bsdf_sampling, given.bsdf_sampling);
  take(settings.roulette, given.roulette);
  settings.max_diffuse_depth = given.max_diffuse_depth;
  settings.max_glossy_depth = given.max_glossy_depth;
  settings.max_specular_depth = given.max_specular_depth;
  take(settings.clamp_direct, given.clamp_direct);
  take(settings.clamp_indirect, given.clamp_indirect);
  take(settings.occlusion_length, given.occlusion_length);
  take(settings.terminator_offset, given.terminator_offset);
  return settings;
}

Features features_of(const RenderSettings& settings) {
  Features features = settings.further_features;
  if (settings.sampler != SamplerKind::independent) features |= feature::samplers;
  const bool is_usual = shader_integrator(settings) == Integrator::path && settings.light_sampling &&
                        settings.mis == Mis::power && settings.bsdf_sampling == BsdfSampling::bsdf &&
                        settings.roulette && !settings.max_diffuse_depth && !settings.max_glossy_depth &&
                        !settings.max_specular_depth && settings.clamp_direct == 0 && settings.clamp_indirect == 0 &&
                        !settings.terminator_offset;
  if (!is_usual) features |= feature::options;
  if (settings.camera && (settings.camera->kind != CameraKind::perspective || settings.camera->lens_radius != 0 ||
                          settings.camera->motion != glm::vec3(0)))
    features |= feature::cameras;
  return features;
}

void set_options(RenderConstants& constants, const RenderSettings& settings) {
  constants.resolution = {settings.width, settings.height};
  constants.max_depth = settings.max_depth;
  constants.seed = settings.seed;
  constants.sampler_kind = settings.sampler;
  constants.sampler_total = settings.planned_samples;
  constants.integrator = shader_integrator(settings);
  constants.light_sampling = settings.light_sampling ? 1 : 0;
  constants.mis = settings.mis;
  constants.bsdf_sampling = settings.bsdf_sampling;
  constants.roulette = settings.roulette ? 1 : 0;
  constants.max_diffuse_depth = settings.max_diffuse_depth.value_or(unlimited);
  constants.max_glossy_depth = settings.max_glossy_depth.value_or(unlimited);
  constants.max_specular_depth = settings.max_specular_depth.value_or(unlimited);
  constants.clamp_direct = settings.clamp_direct;
  constants.clamp_indirect = settings.clamp_indirect;
  constants.occlusion_length = settings.occlusion_length;
  constants.terminator_offset = settings.terminator_offset ? 1 : 0;
}

}  // namespace tandem::pathtracer
