#include "compare/statistics/bias_test.hpp"

#include <cmath>
#include <cstddef>
#include <vector>

#include <doctest/doctest.h>

#include "base/error.hpp"
#include "tests/compare/statistics/noise.hpp"

namespace tandem::compare {
namespace {

using test::noise;
using test::NoiseKind;
using test::scaled;

constexpr double level = 1e-3;

/// How many of `trials` p-values of two estimates of the same means lie below `below`.
int alarms(NoiseKind a, NoiseKind b, std::uint32_t batches, int trials, double below) {
  int count = 0;
  for (int i = 0; i < trials; ++i) {
    const auto seed = static_cast<std::uint32_t>(2 * i);
    const BiasTest test =
        test_bias(batched(noise(a, seed, 16, batches), 8), batched(noise(b, seed + 1, 16, batches), 8));
    count += test.p_value < below ? 1 : 0;
  }
  return count;
}

TEST_CASE("estimates of the same picture fail as often as the p-value says, or less, with fireflies too") {
  constexpr NoiseKind uniform = NoiseKind::uniform, fireflies = NoiseKind::fireflies;
  // Of 1000 trials at 0.05 fewer than 50 are expected to fail; 70 is three standard deviations more.
  CHECK(alarms(uniform, uniform, 8, 1000, 0.05) <= 70);
  CHECK(alarms(fireflies, fireflies, 8, 1000, 0.05) <= 70);
  CHECK(alarms(fireflies, fireflies, 32, 300, 0.05) <= 26);
  // But not never: the tests are many and partly dependent, which may cost a factor of some three.
  CHECK(alarms(uniform, uniform, 8, 1000, 0.05) >= 10);
}

TEST_CASE("estimates of which one is lit by rare events fail no more often") {
  // Ten events are expected in a tile; where there are far fewer, their number alone does not say how few they are.
  CHECK(alarms(NoiseKind::uniform, NoiseKind::rare, 16, 300, 0.05) <= 26);
  CHECK(alarms(NoiseKind::rare, NoiseKind::uniform, 16, 300, 0.001) <= 3);
}

TEST_CASE("the tile and the channel that differ are named, and so is the whole picture") {
  const std::vector<pathtracer::Image> a = noise(NoiseKind::uniform, 1, 32, 16);
  const Tile odd{.left = 8, .top = 16, .width = 8, .height = 8};
  const BiasTest tile = test_bias(batched(a, 8), batched(scaled(noise(NoiseKind::uniform, 2, 32, 16), odd, 1.1), 8));
  CHECK(tile.p_value < 1e-6);
  CHECK(tile.tiles_p_value < 1e-6);
  CHECK(tile.worst_tile.tile.left == odd.left);
  CHECK(tile.worst_tile.tile.top == odd.top);
  CHECK(tile.worst_tile.relative_difference() == doctest::Approx(0.1).epsilon(0.1));
  CHECK(tile.tile_tests == 16 * 4);

  std::vector<pathtracer::Image> b = noise(NoiseKind::uniform, 3, 32, 16);
  for (pathtracer::Image& picture : b)
    for (glm::vec3& pixel : picture.pixels) pixel.y *= 1.01f;
  const BiasTest whole = test_bias(batched(a, 8), batched(b, 8));
  CHECK(whole.picture_p_value < 1e-4);
  CHECK(whole.worst_mean.channel == Channel::green);
  CHECK(whole.worst_mean.relative_difference() == doctest::Approx(0.01).epsilon(0.1));
  CHECK(whole.worst_mean.tile.width == 32);
}

TEST_CASE("a firefly in one batch is no bias") {
  std::vector<pathtracer::Image> b = noise(NoiseKind::uniform, 2, 16, 16);
  b[3].pixels[100] = glm::vec3(1e5f);
  CHECK(test_bias(batched(noise(NoiseKind::uniform, 1, 16, 16), 8), batched(b, 8)).p_value > 0.01);
}

TEST_CASE("pictures without noise agree when they are equal, and differ when they are not") {
  const std::vector<pathtracer::Image> a(8, {.width = 4, .height = 4, .pixels = std::vector(16, glm::vec3(0.5f))});
  std::vector<pathtracer::Image> b = a;
  CHECK(test_bias(batched(a, 4), batched(b, 4)).p_value == 1.0);
  CHECK(test_bias(batched(a, 4), batched(b, 4)).rmse == 0.0);
  for (pathtracer::Image& picture : b) picture.pixels[3].x = 0.6f;
  CHECK(test_bias(batched(a, 4), batched(b, 4)).p_value == 0.0);
  const BiasPower power = bias_power(batched(a, 4), batched(b, 4), level);
  CHECK(power.picture == 0.0);
  CHECK(power.median_tile == 0.0);
}

TEST_CASE("estimates of other sizes or tiles are refused") {
  const BatchedEstimate a(8, 8, 4);
  CHECK_THROWS_AS(test_bias(a, BatchedEstimate(8, 4, 4)), tandem::Error);
  CHECK_THROWS_AS(test_bias(a, BatchedEstimate(8, 8, 8)), tandem::Error);
}

/// The fraction of trials in which a bias is found that is `share` of the one stated as detectable.
double found(NoiseKind kind, double share, bool in_tile, int trials) {
  int count = 0;
  for (int i = 0; i < trials; ++i) {
    const auto seed = static_cast<std::uint32_t>(2 * i);
    const BatchedEstimate a = batched(noise(kind, seed, 32, 16), 8);
    const std::vector<pathtracer::Image> b = noise(kind, seed + 1, 32, 16);
    const BiasPower power = bias_power(a, batched(b, 8), level);
    const Tile all{.left = 0, .top = 0, .width = 32, .height = 32};
    const auto biased =
        in_tile ? scaled(b, power.tile, 1 + share * power.median_tile) : scaled(b, all, 1 + share * power.picture);
    count += test_bias(a, batched(biased, 8)).p_value < level ? 1 : 0;
  }
  return count / double(trials);
}

TEST_CASE("a bias of the stated size is found as often as stated, half of it seldom") {
  // 0.9 of 200 trials, with a standard deviation of 0.02. A little more is found, as any of four channels will do; a
  // little less, as the noise grows with the radiance.
  for (const bool in_tile : {true, false}) {
    CAPTURE(in_tile);
    CHECK(found(NoiseKind::uniform, 1.0, in_tile, 200) == doctest::Approx(0.9).epsilon(0.07));
    CHECK(found(NoiseKind::uniform, 0.5, in_tile, 200) < 0.3);
  }
}

}  // namespace
}  // namespace tandem::compare
