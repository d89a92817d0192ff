#include "compare/image/difference.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "base/error.hpp"

namespace tandem::compare {
namespace {

void require_same_size(const pathtracer::Image& a, const pathtracer::Image& b) {
  if (a.width == b.width && a.height == b.height && a.pixels.size() == b.pixels.size()) return;
  throw Error("images of different sizes have no difference image");
}

/// The pixel-by-pixel image of a function of two pixels.
template <typename Function>
pathtracer::Image combine(const pathtracer::Image& a, const pathtracer::Image& b, Function function) {
  require_same_size(a, b);
  pathtracer::Image result{.width = a.width, .height = a.height, .pixels = {}};
  result.pixels.resize(a.pixels.size());
  std::transform(a.pixels.begin(), a.pixels.end(), b.pixels.begin(), result.pixels.begin(), function);
  return result;
}

glm::vec3 heat(float difference) {
  static constexpr int first_decade = -6;
  static const std::array<glm::vec3, 7> colors = {glm::vec3(0.00F, 0.00F, 0.15F), glm::vec3(0.00F, 0.05F, 0.80F),
                                                  glm::vec3(0.00F, 0.55F, 0.65F), glm::vec3(0.05F, 0.65F, 0.05F),
                                                  glm::vec3(0.95F, 0.80F, 0.00F), glm::vec3(0.90F, 0.03F, 0.00F),
                                                  glm::vec3(1.00F, 1.00F, 1.00F)};
  if (difference == 0.0F) return glm::vec3(0.0F);
  const float last = static_cast<float>(colors.size() - 1);
  const float position = std::clamp(std::log10(difference) - static_cast<float>(first_decade), 0.0F, last);
  const auto below = std::min(static_cast<std::size_t>(position), colors.size() - 2);
  const float fraction = position - static_cast<float>(below);
  return colors[below] * (1.0F - fraction) + colors[below + 1] * fraction;
}

}  // namespace

pathtracer::Image signed_difference(const pathtracer::Image& a, const pathtracer::Image& b) {
  return combine(a, b, [](const glm::vec3& pixel_a, const glm::vec3& pixel_b) { return pixel_a - pixel_b; });
}

pathtracer::Image heat_map(const pathtracer::Image& a, const pathtracer::Image& b) {
  return combine(a, b, [](const glm::vec3& pixel_a, const glm::vec3& pixel_b) {
    float largest = 0.0F;
    for (int channel = 0; channel < 3; ++channel) {
      if (!std::isfinite(pixel_a[channel]) || !std::isfinite(pixel_b[channel])) return glm::vec3(1.0F, 0.0F, 1.0F);
      largest = std::max(largest, std::abs(pixel_a[channel] - pixel_b[channel]));
    }
    return heat(largest);
  });
}

std::vector<glm::uvec2> differing_pixels(const pathtracer::Image& a, const pathtracer::Image& b, std::size_t limit,
                                         std::uint64_t& differing_count) {
  require_same_size(a, b);
  std::vector<glm::uvec2> pixels;
  for (std::size_t i = 0; i < a.pixels.size(); ++i)
    if (std::memcmp(&a.pixels[i], &b.pixels[i], sizeof(a.pixels[i])) != 0)
      pixels.emplace_back(static_cast<std::uint32_t>(i % a.width), static_cast<std::uint32_t>(i / a.width));
  differing_count = pixels.size();
  if (pixels.size() <= limit) return pixels;
  std::vector<glm::uvec2> some;
  for (std::size_t i = 0; i < limit; ++i) some.push_back(pixels[i * pixels.size() / limit]);
  return some;
}

}  // namespace tandem::compare
