#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include <glm/vec3.hpp>

#include "base/named.hpp"
#include "pathtracer/scene/buffers.hpp"

namespace tandem::pathtracer {

/// How a scene wants to be rendered, or a command line: what is absent is left to whoever comes next, in the end to
/// RenderSettings, which says what each member means.
struct SceneSettings {
  std::optional<std::uint32_t> width;
  std::optional<std::uint32_t> height;
  std::optional<std::uint32_t> samples;  ///< per pixel
  std::optional<std::uint32_t> max_depth;
  std::optional<std::uint32_t> seed;
  std::optional<glm::vec3> background;
  std::optional<Integrator> integrator;
  std::optional<SamplerKind> sampler;
  std::optional<bool> light_sampling;
  std::optional<Mis> mis;
  std::optional<BsdfSampling> bsdf_sampling;
  std::optional<bool> roulette;
  std::optional<std::uint32_t> max_diffuse_depth;
  std::optional<std::uint32_t> max_glossy_depth;
  std::optional<std::uint32_t> max_specular_depth;
  std::optional<float> clamp_direct;
  std::optional<float> clamp_indirect;
  std::optional<float> occlusion_length;
  std::optional<bool> terminator_offset;
};

/// The members of `first`, and those of `second` where it has none.
SceneSettings merged(const SceneSettings& first, const SceneSettings& second);

std::span<const Named<Integrator>> integrator_names();
std::span<const Named<SamplerKind>> sampler_names();
std::span<const Named<Mis>> mis_names();
std::span<const Named<BsdfSampling>> bsdf_sampling_names();
std::span<const Named<CameraKind>> camera_names();

}  // namespace tandem::pathtracer
