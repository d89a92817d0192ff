#include "compare/image/flip/flip.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <glm/common.hpp>

#include "base/srgb.hpp"
#include "compare/image/flip/linear_flip.hpp"
#include "compare/image/image_pair.hpp"

namespace tandem::compare {
namespace {

LinearPicture clamped(LinearPicture picture) {
  for (glm::dvec3& pixel : picture.pixels) pixel = glm::clamp(pixel, 0.0, 1.0);
  return picture;
}

}  // namespace

FlipErrors flip(const pathtracer::Image& a, const pathtracer::Image& b, const ViewingConditions& viewing) {
  check_pair(a, b);
  return summarized(a, b, linear_flip(clamped(finite_pixels(a, b)), clamped(finite_pixels(b, a)), viewing));
}

pathtracer::Image error_map(const FlipErrors& errors) {
  // Nine evenly spaced colours of matplotlib's "magma" in sRGB, straight lines between them.
  static constexpr std::array<glm::vec3, 9> colors = {
      glm::vec3(0, 0, 4),      glm::vec3(28, 16, 68),    glm::vec3(79, 18, 123),
      glm::vec3(129, 37, 129), glm::vec3(181, 54, 122),  glm::vec3(229, 80, 100),
      glm::vec3(251, 135, 97), glm::vec3(254, 194, 135), glm::vec3(252, 253, 191)};
  pathtracer::Image image{.width = errors.width, .height = errors.height, .pixels = {}};
  image.pixels.reserve(errors.errors.size());
  for (const float error : errors.errors) {
    const float position = error * static_cast<float>(colors.size() - 1);
    const auto below = std::min(static_cast<std::size_t>(position), colors.size() - 2);
    const glm::vec3 color = glm::mix(colors[below], colors[below + 1], position - static_cast<float>(below)) / 255.0F;
    image.pixels.emplace_back(srgb_decode(color.x), srgb_decode(color.y), srgb_decode(color.z));
  }
  return image;
}

}  // namespace tandem::compare
