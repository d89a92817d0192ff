#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

namespace tandem::pathtracer {

/// Linear RGB radiance, row by row from the top left.
struct Image {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::vector<glm::vec3> pixels;  ///< width * height

  const glm::vec3& at(std::uint32_t x, std::uint32_t y) const { return pixels[std::size_t{y} * width + x]; }
};

}  // namespace tandem::pathtracer
