#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "pathtracer/image/image.hpp"

namespace tandem::compare {

inline pathtracer::Image image(std::uint32_t width, std::uint32_t height, std::vector<glm::vec3> pixels) {
  return {.width = width, .height = height, .pixels = std::move(pixels)};
}

inline pathtracer::Image constant_image(std::uint32_t width, std::uint32_t height, glm::vec3 color) {
  return image(width, height, std::vector<glm::vec3>(std::size_t{width} * height, color));
}

/// Values in [0, 1) without structure, the same for the same seed.
inline pathtracer::Image noise_image(std::uint32_t width, std::uint32_t height, std::uint32_t seed) {
  pathtracer::Image result = constant_image(width, height, glm::vec3(0.0F));
  std::uint32_t state = seed;
  const auto next = [&state] {
    state = state * 747796405U + 2891336453U;
    return static_cast<float>(state >> 8U) * 0x1p-24F;
  };
  for (glm::vec3& pixel : result.pixels) pixel = {next(), next(), next()};
  return result;
}

}  // namespace tandem::compare
