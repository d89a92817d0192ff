#include "compare/image/image_pair.hpp"

#include <bit>
#include <cmath>
#include <cstdint>
#include <string>

#include "base/error.hpp"

namespace tandem::compare {
namespace {

std::string size_text(const pathtracer::Image& image) {
  return std::to_string(image.width) + "x" + std::to_string(image.height);
}

}  // namespace

void check_pair(const pathtracer::Image& a, const pathtracer::Image& b) {
  if (a.width != b.width || a.height != b.height) {
    throw Error("images of " + size_text(a) + " and " + size_text(b) + " pixels cannot be compared");
  }
  const std::size_t pixels = std::size_t{a.width} * a.height;
  if (pixels == 0) throw Error("images without pixels cannot be compared");
  if (a.pixels.size() != pixels || b.pixels.size() != pixels) {
    throw Error("an image does not hold width * height pixels");
  }
}

bool is_finite(const glm::vec3& value) {
  return std::isfinite(value.x) && std::isfinite(value.y) && std::isfinite(value.z);
}

bool is_bit_equal(const glm::vec3& a, const glm::vec3& b) {
  for (int channel = 0; channel < 3; ++channel) {
    if (std::bit_cast<std::uint32_t>(a[channel]) != std::bit_cast<std::uint32_t>(b[channel])) return false;
  }
  return true;
}

}  // namespace tandem::compare
