#pragma once

#include <cstdint>

#include "pathtracer/render/renderer.hpp"

namespace tandem::pathtracer {

/// How a picture grows while somebody looks at it.
struct AccumulationSettings {
  std::uint32_t samples_per_frame = 1;   ///< of a pixel, at least 1
  std::uint32_t maximum_samples = 4096;  ///< after which a picture is finished, at least 1
  bool accumulate = true;                ///< false: every frame begins anew, with other random numbers
};

/// Shows a scene frame by frame: samples add up as long as nothing changes, and begin anew when the camera, a setting
/// or the lights do.
class Accumulation {
 public:
  /// @param renderer outlives this
  explicit Accumulation(Renderer& renderer) : renderer_(&renderer) {}

  /// Renders the next frame. Settings that change no picture (submission_seconds, maximum_tile) restart nothing. False
  /// when the picture has all its samples already, and nothing was done. Throws Error as Renderer::restart does.
  bool next_frame(const RenderSettings& settings, const AccumulationSettings& accumulation);

 private:
  Renderer* renderer_;
  std::uint32_t frames_ = 0;  ///< since the last change: what tells the random numbers of unaccumulated frames apart
};

}  // namespace tandem::pathtracer
