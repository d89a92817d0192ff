#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <optional>

#include "compare/image/flip/flip.hpp"
#include "compare/image/flip/linear_flip.hpp"
#include "compare/image/image_pair.hpp"
#include "pathtracer/scene/lights.hpp"

namespace tandem::compare {
namespace {

/// The ACES film curve (k0 x^2 + k1 x + k2) / (k3 x^2 + k4 x + k5) by Narkowicz, 2015, with his factor of 0.6 before it
/// that makes it as bright as the original.
struct AcesCurve {
  static constexpr double scale = 0.6;
  static constexpr double k0 = scale * scale * 2.51;
  static constexpr double k1 = scale * 0.03;
  static constexpr double k2 = 0.0;
  static constexpr double k3 = scale * scale * 2.43;
  static constexpr double k4 = scale * 0.59;
  static constexpr double k5 = 0.14;

  static double of(double x) { return std::clamp((k0 * x * x + k1 * x + k2) / (k3 * x * x + k4 * x + k5), 0.0, 1.0); }

  /// The positive x at which the curve has the value y, which must be above 0 and below k0 / k3.
  static double inverse(double y) {
    const double a = k0 - y * k3;
    const double b = k1 - y * k4;
    const double c = k2 - y * k5;
    return (-b + std::sqrt(b * b - 4.0 * a * c)) / (2.0 * a);
  }
};

/// [HDR] section 2.1: the exposures at which the brightest and the median pixel of the reference have this tone.
constexpr double well_shown = 0.85;

struct Range {
  double first = 0.0;
  double last = 0.0;
};

/// None for a picture without light.
std::optional<Range> exposure_range(const LinearPicture& reference) {
  std::vector<double> luminances;
  for (const glm::dvec3& pixel : reference.pixels) {
    const double luminance = pathtracer::luminance(glm::vec3(pixel));
    if (luminance > 0.0) luminances.push_back(luminance);
  }
  if (luminances.empty()) return std::nullopt;
  std::sort(luminances.begin(), luminances.end());
  const std::size_t middle = luminances.size() / 2;
  const double median =
      luminances.size() % 2 == 1 ? luminances[middle] : 0.5 * (luminances[middle - 1] + luminances[middle]);
  const double shown = AcesCurve::inverse(well_shown);
  return Range{.first = std::log2(shown / luminances.back()), .last = std::log2(shown / median)};
}

LinearPicture without_negatives(LinearPicture picture) {
  for (glm::dvec3& pixel : picture.pixels) pixel = glm::max(pixel, 0.0);
  return picture;
}

LinearPicture tone_mapped(const LinearPicture& picture, double exposure) {
  const double factor = std::exp2(exposure);
  LinearPicture result = picture;
  for (glm::dvec3& pixel : result.pixels) {
    pixel = {AcesCurve::of(pixel.x * factor), AcesCurve::of(pixel.y * factor), AcesCurve::of(pixel.z * factor)};
  }
  return result;
}

}  // namespace

HdrFlipErrors hdr_flip(const pathtracer::Image& a, const pathtracer::Image& b, const ViewingConditions& viewing) {
  check_pair(a, b);
  const LinearPicture reference = without_negatives(finite_pixels(a, b));
  const LinearPicture test = without_negatives(finite_pixels(b, a));
  HdrFlipErrors result;
  result.exposures = 1;
  if (const std::optional<Range> range = exposure_range(reference)) {
    result.first_exposure = range->first;
    result.last_exposure = range->last;
    // [HDR] section 2.1: about one exposure for each stop.
    result.exposures = static_cast<std::uint32_t>(std::max(2.0, std::ceil(range->last - range->first)));
  }
  std::vector<float> errors(a.pixels.size(), 0.0F);
  for (std::uint32_t index = 0; index < result.exposures; ++index) {
    const double position = result.exposures == 1 ? 0.0 : static_cast<double>(index) / (result.exposures - 1);
    const double exposure = std::lerp(result.first_exposure, result.last_exposure, position);
    const std::vector<float> of_exposure =
        linear_flip(tone_mapped(reference, exposure), tone_mapped(test, exposure), viewing);
    std::transform(errors.begin(), errors.end(), of_exposure.begin(), errors.begin(),
                   [](float so_far, float error) { return std::max(so_far, error); });
  }
  result.errors = summarized(a, b, std::move(errors));
  return result;
}

}  // namespace tandem::compare
