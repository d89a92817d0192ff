#pragma once

#include <span>

#include <glm/vec3.hpp>

#include "pathtracer/scene/settings.hpp"

namespace tandem::pathtracer {

/// From linear radiance to what a display is told.
enum class ToneCurve {
  srgb,      ///< clamped to [0, 1], then the transfer function of sRGB (IEC 61966-2-1)
  gamma,     ///< clamped to [0, 1], then to the power of 1 / 2.2
  reinhard,  ///< luminance L becomes L / (1 + L) (Reinhard et al., Photographic Tone Reproduction, 2002), then sRGB
  filmic     ///< per channel a rational fit of the ACES film curve (Narkowicz 2015), then sRGB
};

struct Tone {
  ToneCurve curve = ToneCurve::srgb;
  double exposure = 0;  ///< stops: radiance is multiplied by 2 to this power first
};

/// Values in [0, 1] for a display; NaN becomes 0, and infinity 1.
glm::vec3 tone_mapped(const glm::vec3& radiance, const Tone& tone);

std::span<const Named<ToneCurve>> tone_curve_names();

}  // namespace tandem::pathtracer
