#include "compare/cause/class_map.hpp"

#include <cstddef>
#include <cstring>

#include "base/srgb.hpp"

namespace tandem::compare {
namespace {

glm::vec3 linear(std::uint32_t srgb) {
  const auto channel = [&](unsigned shift) {
    return srgb_decode(static_cast<float>((srgb >> shift) & 0xffu) / 255.0f);
  };
  return {channel(16), channel(8), channel(0)};
}

}  // namespace

pathtracer::Image class_map(const Classification& classification, const pathtracer::Image& a,
                            const pathtracer::Image& b) {
  pathtracer::Image map{.width = a.width, .height = a.height, .pixels = {}};
  map.pixels.resize(a.pixels.size(), glm::vec3(0));
  for (std::size_t i = 0; i < map.pixels.size(); ++i)
    if (std::memcmp(&a.pixels[i], &b.pixels[i], sizeof(glm::vec3)) != 0) map.pixels[i] = linear(0x606060);
  for (const ClassifiedPixel& pixel : classification.pixels)
    map.pixels[std::size_t{pixel.pixel.y} * map.width + pixel.pixel.x] = linear(color(pixel.difference_class));
  return map;
}

}  // namespace tandem::compare
