#include "tests/compare/statistics/noise.hpp"

#include <cmath>

#include "tests/shaders/random_source.hpp"

namespace tandem::test {
namespace {

double sample(NoiseKind kind, RandomSource& random) {
  if (kind == NoiseKind::uniform) return random.uniform(0.8, 1.2);
  if (kind == NoiseKind::rare) return random.uniform(0, 1) < 0.01 ? 100 : 0;
  const double base = random.uniform(0, 1);
  if (random.uniform(0, 1) >= 0.001) return base;
  constexpr double shape = 1.5;
  constexpr double least = 500 * (shape - 1) / shape;  // of a variate with mean 500
  return base + least * std::pow(1 - random.uniform(0, 1), -1 / shape);
}

}  // namespace

std::vector<pathtracer::Image> noise(NoiseKind kind, std::uint32_t seed, std::uint32_t side, std::uint32_t count) {
  RandomSource random(seed);
  std::vector<pathtracer::Image> pictures(count, {.width = side, .height = side, .pixels = {}});
  for (pathtracer::Image& picture : pictures)
    for (std::uint32_t i = 0; i < side * side; ++i) {
      const double red = sample(kind, random), green = sample(kind, random), blue = sample(kind, random);
      picture.pixels.emplace_back(red, 0.5 * green, 0.25 * blue);
    }
  return pictures;
}

std::vector<pathtracer::Image> scaled(std::vector<pathtracer::Image> pictures, const compare::Tile& tile,
                                      double factor) {
  for (pathtracer::Image& picture : pictures)
    for (std::uint32_t y = tile.top; y < tile.top + tile.height; ++y)
      for (std::uint32_t x = tile.left; x < tile.left + tile.width; ++x)
        picture.pixels[std::size_t{y} * picture.width + x] *= static_cast<float>(factor);
  return pictures;
}

}  // namespace tandem::test
