#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "compare/statistics/batched_estimate.hpp"
#include "pathtracer/image/image.hpp"

/// Pictures of noise, for tests of tests.
namespace tandem::test {

/// How a channel of a pixel is distributed. All have mean 1.
enum class NoiseKind {
  uniform,    ///< between 0.8 and 1.2
  fireflies,  ///< between 0 and 1; one in a thousand has a Pareto variate of mean 500 more, whose variance is infinite
  rare        ///< 100 once in a hundred, else 0: lights that are found by chance
};

/// `count` independent pictures of side x side pixels, whose channels have the means 1, 0.5 and 0.25.
std::vector<pathtracer::Image> noise(NoiseKind kind, std::uint32_t seed, std::uint32_t side, std::uint32_t count);

/// The pixels of the tile multiplied by `factor` in every picture.
std::vector<pathtracer::Image> scaled(std::vector<pathtracer::Image> pictures, const compare::Tile& tile,
                                      double factor);

}  // namespace tandem::test
