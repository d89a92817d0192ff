#include "compare/image/flip/linear_flip.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>

#include "compare/image/flip/color_space.hpp"
#include "compare/image/flip/filters.hpp"
#include "compare/image/image_pair.hpp"

namespace tandem::compare {
namespace {

/// [LDR] section 4.1: the exponent that compresses large colour differences.
constexpr double color_exponent = 0.7;
/// [LDR] section 4.1: differences up to this part of the largest one are spread over errors up to ...
constexpr double knee = 0.4;
/// ... this one.
constexpr double error_at_knee = 0.95;
/// [LDR] section 4.2: the exponent of the feature difference.
constexpr double feature_exponent = 0.5;

/// What is compared of a picture.
struct Look {
  std::vector<glm::dvec3> colors;  ///< as an eye sees them from the distance, in CIELAB after Hunt
  Features features;
};

Look look_at(const LinearPicture& picture, double pixels_per_degree) {
  const auto plane = [&] {
    return Plane{
        .width = picture.width, .height = picture.height, .values = std::vector<double>(picture.pixels.size())};
  };
  Plane y = plane();
  Plane cx = plane();
  Plane cz = plane();
  Plane achromatic = plane();
  for (std::size_t index = 0; index < picture.pixels.size(); ++index) {
    const glm::dvec3 color = ycxcz_of_linear_rgb(picture.pixels[index]);
    y.values[index] = color.x;
    cx.values[index] = color.y;
    cz.values[index] = color.z;
    achromatic.values[index] = (color.x + 16.0) / 116.0;
  }
  const Plane seen_y = seen(y, achromatic_sensitivity(), pixels_per_degree);
  const Plane seen_cx = seen(cx, red_green_sensitivity(), pixels_per_degree);
  const Plane seen_cz = seen(cz, blue_yellow_sensitivity(), pixels_per_degree);
  Look look{.colors = {}, .features = features(achromatic, pixels_per_degree)};
  look.colors.reserve(picture.pixels.size());
  for (std::size_t index = 0; index < picture.pixels.size(); ++index) {
    // The filters of the three channels differ, so what comes out need not be a colour that a screen can show.
    const glm::dvec3 rgb = linear_rgb_of_ycxcz({seen_y.values[index], seen_cx.values[index], seen_cz.values[index]});
    look.colors.push_back(hunt_lab_of_linear_rgb(glm::clamp(rgb, 0.0, 1.0)));
  }
  return look;
}

/// From 0 to 1.
double color_error(const glm::dvec3& a, const glm::dvec3& b) {
  static const double largest =
      std::pow(hyab_distance(hunt_lab_of_linear_rgb({0, 1, 0}), hunt_lab_of_linear_rgb({0, 0, 1})), color_exponent);
  const double difference = std::pow(hyab_distance(a, b), color_exponent);
  const double at_knee = knee * largest;
  if (difference < at_knee) return error_at_knee / at_knee * difference;
  return error_at_knee + (difference - at_knee) / (largest - at_knee) * (1.0 - error_at_knee);
}

}  // namespace

LinearPicture finite_pixels(const pathtracer::Image& image, const pathtracer::Image& other) {
  LinearPicture picture{.width = image.width, .height = image.height, .pixels = {}};
  picture.pixels.reserve(image.pixels.size());
  for (std::size_t index = 0; index < image.pixels.size(); ++index) {
    const bool finite = is_finite(image.pixels[index]) && is_finite(other.pixels[index]);
    picture.pixels.push_back(finite ? glm::dvec3(image.pixels[index]) : glm::dvec3(0.0));
  }
  return picture;
}

std::vector<float> linear_flip(const LinearPicture& a, const LinearPicture& b, const ViewingConditions& viewing) {
  const Look look_a = look_at(a, viewing.pixels_per_degree);
  const Look look_b = look_at(b, viewing.pixels_per_degree);
  std::vector<float> errors;
  errors.reserve(a.pixels.size());
  for (std::size_t index = 0; index < a.pixels.size(); ++index) {
    const double edges = std::abs(look_a.features.edges.values[index] - look_b.features.edges.values[index]);
    const double points = std::abs(look_a.features.points.values[index] - look_b.features.points.values[index]);
    const double feature = std::pow(std::max(edges, points) / std::sqrt(2.0), feature_exponent);
    // [LDR] section 4.3: a difference of features lifts the difference of colours, and alone is none.
    const double error = std::pow(color_error(look_a.colors[index], look_b.colors[index]), 1.0 - feature);
    errors.push_back(static_cast<float>(std::clamp(error, 0.0, 1.0)));
  }
  return errors;
}

FlipErrors summarized(const pathtracer::Image& a, const pathtracer::Image& b, std::vector<float> errors) {
  FlipErrors result{.width = a.width, .height = a.height, .errors = std::move(errors)};
  double sum = 0.0;
  for (std::size_t index = 0; index < result.errors.size(); ++index) {
    float& error = result.errors[index];
    if (!is_finite(a.pixels[index]) || !is_finite(b.pixels[index])) error = 1.0F;
    sum += error;
    result.largest = std::max<double>(result.largest, error);
  }
  result.mean = sum / static_cast<double>(result.errors.size());
  return result;
}

}  // namespace tandem::compare
