#include "pathtracer/image/tone_map.hpp"

#include <algorithm>
#include <cmath>

#include "base/srgb.hpp"
#include "pathtracer/scene/lights.hpp"

namespace tandem::pathtracer {
namespace {

/// Beyond any radiance that a curve tells apart, and far from where its products overflow.
constexpr float brightest = 1e8f;

float positive(float value) { return value > 0 ? std::min(value, brightest) : 0.0f; }

float filmic(float x) { return (x * (2.51f * x + 0.03f)) / (x * (2.43f * x + 0.59f) + 0.14f); }

glm::vec3 per_channel(const glm::vec3& color, float (*curve)(float)) {
  return {curve(color.x), curve(color.y), curve(color.z)};
}

float gamma(float value) { return std::pow(std::min(value, 1.0f), 1 / 2.2f); }

}  // namespace

glm::vec3 tone_mapped(const glm::vec3& radiance, const Tone& tone) {
  const float factor = static_cast<float>(std::exp2(tone.exposure));
  glm::vec3 color(positive(radiance.x * factor), positive(radiance.y * factor), positive(radiance.z * factor));
  switch (tone.curve) {
    case ToneCurve::gamma:
      return per_channel(color, &gamma);
    case ToneCurve::reinhard:
      color /= 1 + static_cast<float>(luminance(color));
      break;
    case ToneCurve::filmic:
      color = per_channel(color, &filmic);
      break;
    case ToneCurve::srgb:
      break;
  }
  return per_channel(color, &srgb_encode);
}

std::span<const Named<ToneCurve>> tone_curve_names() {
  static constexpr Named<ToneCurve> names[] = {{ToneCurve::srgb, "srgb"},
                                               {ToneCurve::gamma, "gamma"},
                                               {ToneCurve::reinhard, "reinhard"},
                                               {ToneCurve::filmic, "filmic"}};
  return names;
}

}  // namespace tandem::pathtracer
