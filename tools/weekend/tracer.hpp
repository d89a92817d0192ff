#pragma once

#include <cstdint>

#include "base/progress.hpp"
#include "pathtracer/image/image.hpp"
#include "pathtracer/scene/camera.hpp"
#include "tools/weekend/world.hpp"

namespace tandem::weekend {

struct TraceSettings {
  std::uint32_t width = 512;
  std::uint32_t height = 512;
  std::uint32_t samples = 16;    ///< per pixel
  std::uint32_t max_depth = 10;  ///< path segments, as RenderSettings::max_depth
  std::uint64_t seed = 0;
};

struct Traced {
  pathtracer::Image image;  ///< linear radiance: the mean of the samples
  double milliseconds = 0;  ///< of tracing alone, by the host's clock
  std::uint64_t rays = 0;
};

/// Renders on the calling thread, as The Rest of Your Life (2020), chapters 9 to 12, does: one direction after each
/// scattering, from an equal mixture of the lights' directions and the material's; no roulette, no shadow rays but
/// those of lights without extent. What it converges to is what Tandem's path tracer converges to by default.
/// Throws Error for a camera that is no pinhole, and Cancelled.
Traced trace(const World& world, const pathtracer::Camera& camera, const TraceSettings& settings,
             const Progress& progress = {});

}  // namespace tandem::weekend
