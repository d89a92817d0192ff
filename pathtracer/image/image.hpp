#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
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

/// Numbers that a picture has beside its colours, one for each pixel: floats, or whole numbers of 32 bits.
struct ImageChannel {
  std::string name;  ///< "layer.channel", as OpenEXR has it
  bool is_integer = false;
  std::vector<std::uint32_t> words;  ///< the whole numbers, or the bits of the floats
};

}  // namespace tandem::pathtracer
