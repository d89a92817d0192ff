#pragma once

#include <cstdint>
#include <optional>

#include <glm/vec3.hpp>

#include "pathtracer/render/features.hpp"
#include "pathtracer/render/metropolis_settings.hpp"
#include "pathtracer/scene/buffers.hpp"
#include "pathtracer/scene/camera.hpp"
#include "pathtracer/scene/settings.hpp"

namespace tandem::pathtracer {

/// How a scene is rendered. Everything but the size has a default that is right for most scenes.
struct RenderSettings {
  std::uint32_t width = 512;
  std::uint32_t height = 512;
  std::uint32_t max_depth = 8;  ///< path segments from the camera on: 1 sees emission only, 2 adds direct light
  std::uint32_t seed = 0;
  /// Absent: the scene's, automatic_camera, or the one in use when restarting.
  std::optional<Camera> camera = {};
  /// Radiance of rays that leave the scene. Absent: the scene's, or 0, or 1 when nothing emits.
  std::optional<glm::vec3> background = {};

  Integrator integrator = Integrator::path;
  MetropolisSettings metropolis = {};  ///< of Integrator::metropolis
  SamplerKind sampler = SamplerKind::independent;
  /// Samples of a pixel that will be taken in all: what Hammersley points and strata are laid out for.
  std::uint32_t planned_samples = 16;
  bool light_sampling = true;  ///< next event estimation
  Mis mis = Mis::power;        ///< how next event estimation and scattering share the light
  BsdfSampling bsdf_sampling = BsdfSampling::bsdf;
  bool roulette = true;
  /// Scattering events of a path by lobes of each kind; absent: as many as max_depth allows.
  std::optional<std::uint32_t> max_diffuse_depth = {};
  std::optional<std::uint32_t> max_glossy_depth = {};
  std::optional<std::uint32_t> max_specular_depth = {};
  float clamp_direct = 0;  ///< largest channel that one sample adds at its first vertex; 0: no bound
  float clamp_indirect = 0;
  float occlusion_length = 1e30f;  ///< of the rays of ambient occlusion, in units of the scene
  /// Rays leave smooth triangles from the round surface that their normals mean, so that the border of a shadow does
  /// not follow the faces. Light may then come through meshes that are not closed (docs/decisions/0020).
  bool terminator_offset = false;

  /// Of the shaders, beyond those that scene and settings need: they cost time and change no bit of the picture.
  Features further_features = 0;

  /// Seconds that one submission should take at most; it may take several times as long where the scene is uneven.
  double submission_seconds = 0.25;
  /// Side of the largest tile of one submission in pixels, 0 for no bound. It never changes the picture.
  std::uint32_t maximum_tile = 0;

  bool operator==(const RenderSettings&) const = default;
};

/// Throws Error for a size or depth of 0 or one that no device can take, and for numbers out of range; a camera is
/// checked when it is used.
void check(const RenderSettings& settings);

/// The settings with what is given, the rest as by default.
RenderSettings render_settings(const SceneSettings& given);

/// What the shaders must be able to do for the settings.
Features features_of(const RenderSettings& settings);

/// Sets the members that are settings, but those of the camera and the background.
void set_options(RenderConstants& constants, const RenderSettings& settings);

}  // namespace tandem::pathtracer
