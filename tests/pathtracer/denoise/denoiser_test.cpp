#include "pathtracer/denoise/denoiser.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <vector>

#include <doctest/doctest.h>

#include "base/error.hpp"
#include "tests/support/device_test.hpp"

using namespace tandem;
using namespace tandem::pathtracer;

namespace {

/// White, flat, seen from the front: every pixel alike.
NoisyPicture flat_picture(std::uint32_t width, std::uint32_t height, float radiance, float variance) {
  const std::size_t pixels = std::size_t{width} * height;
  return {.radiance = {width, height, std::vector<glm::vec3>(pixels, glm::vec3(radiance))},
          .variance = std::vector<glm::vec3>(pixels, glm::vec3(variance)),
          .sampled_albedo = std::vector<glm::vec3>(pixels, glm::vec3(1)),
          .sampled_emission = std::vector<glm::vec3>(pixels, glm::vec3(0)),
          .albedo = std::vector<glm::vec3>(pixels, glm::vec3(1)),
          .emission = std::vector<glm::vec3>(pixels, glm::vec3(0)),
          .normal = std::vector<glm::vec3>(pixels, glm::vec3(0, 0, 1)),
          .depth = std::vector<float>(pixels, 10),
          .coverage = std::vector<float>(pixels, 1)};
}

/// Adds grey noise of this standard deviation, and its variance.
void add_noise(NoisyPicture& picture, float deviation) {
  std::mt19937 random(7);
  std::normal_distribution<float> normal(0, deviation);
  for (glm::vec3& pixel : picture.radiance.pixels) pixel += normal(random);
  for (glm::vec3& variance : picture.variance) variance = glm::vec3(deviation * deviation);
}

/// A level that looks at nothing but distance.
DenoiseSettings linear_filter(std::uint32_t levels) {
  return {.levels = levels,
          .luminance_deviations = 1e6f,
          .depth_slopes = 1e6f,
          .albedo_difference = 1e6f,
          .firefly_deviations = 0};
}

/// Means of a band of columns, of the red channel.
struct Moments {
  double mean = 0;
  double variance = 0;
};

Moments moments(const Image& image, std::uint32_t margin) {
  double sum = 0, squares = 0, count = 0;
  for (std::uint32_t y = margin; y < image.height - margin; ++y) {
    for (std::uint32_t x = margin; x < image.width - margin; ++x) {
      const double value = image.at(x, y).x;
      sum += value;
      squares += value * value;
      ++count;
    }
  }
  return {sum / count, squares / count - sum / count * (sum / count)};
}

bool same_bits(const Image& a, const Image& b) {
  return a.pixels.size() == b.pixels.size() &&
         std::memcmp(a.pixels.data(), b.pixels.data(), a.pixels.size() * sizeof(glm::vec3)) == 0;
}

/// Everything that a picture may hold: noise, edges of all guides, background, a firefly, pixels that are no numbers.
NoisyPicture crowded_picture() {
  NoisyPicture picture = flat_picture(37, 23, 1, 0);
  add_noise(picture, 0.3f);
  for (std::uint32_t y = 0; y < 23; ++y) {
    for (std::uint32_t x = 0; x < 37; ++x) {
      const std::size_t i = y * 37 + x;
      if (x > 12) picture.normal[i] = {0.6f, 0.1f * static_cast<float>(y), 0.8f};
      if (x > 20) picture.sampled_albedo[i] = picture.albedo[i] = {0.7f, 0.2f + 0.01f * static_cast<float>(x), 0.05f};
      picture.depth[i] = 5 + 0.13f * static_cast<float>(x) + (y > 11 ? 3.0f : 0.0f);
      if (x + y < 9) {
        picture.coverage[i] = 0;
        picture.sampled_albedo[i] = picture.albedo[i] = picture.normal[i] = glm::vec3(0);
        picture.sampled_emission[i] = picture.emission[i] = {0.1f, 0.2f, 0.9f};
        picture.depth[i] = 0;
      }
    }
  }
  picture.radiance.pixels[400] = glm::vec3(500);
  picture.variance[400] = glm::vec3(250000);
  picture.radiance.pixels[500].y = std::numeric_limits<float>::quiet_NaN();
  picture.radiance.pixels[600].x = std::numeric_limits<float>::infinity();
  picture.variance[300] = glm::vec3(-1);
  return picture;
}

}  // namespace

TANDEM_DEVICE_TEST("A picture without differences stays as it is") {
  Denoiser denoiser(device_handle);
  NoisyPicture picture = flat_picture(20, 13, 0.7f, 0.1f);
  CHECK(same_bits(denoiser.denoise(picture), picture.radiance));
  // Division by albedo and the product with it round once each.
  for (glm::vec3& albedo : picture.albedo) albedo = {0.3f, 0.6f, 0.9f};
  picture.sampled_albedo = picture.albedo;
  for (const glm::vec3& pixel : denoiser.denoise(picture).pixels)
    for (int c = 0; c < 3; ++c) CHECK(pixel[c] == doctest::Approx(0.7f).epsilon(3e-7));
}

TANDEM_DEVICE_TEST("Pictures of one pixel, and of odd sizes, have their size") {
  Denoiser denoiser(device_handle);
  for (const glm::uvec2 size : {glm::uvec2(1, 1), glm::uvec2(1, 9), glm::uvec2(17, 3)}) {
    const Image image = denoiser.denoise(flat_picture(size.x, size.y, 2, 1));
    CHECK(image.width == size.x);
    CHECK(image.height == size.y);
    REQUIRE(image.pixels.size() == std::size_t{size.x} * size.y);
    for (const glm::vec3& pixel : image.pixels) CHECK(pixel == glm::vec3(2));
  }
}

TANDEM_DEVICE_TEST("Noise falls as the weights of the kernel say, and the mean stays") {
  Denoiser denoiser(device_handle);
  NoisyPicture picture = flat_picture(96, 96, 10, 0);
  add_noise(picture, 1);
  // The sum of the squares of the kernel: (0.375^2 + 2 * 0.25^2 + 2 * 0.0625^2)^2. The pixels' values are correlated
  // over 5 x 5: 92^2 / 25 independent ones at least tell a variance within 8 % (one deviation).
  const Moments one_level = moments(denoiser.denoise(picture, linear_filter(1)), 2);
  CHECK(one_level.variance == doctest::Approx(0.0747681).epsilon(0.2));
  CHECK(one_level.mean == doctest::Approx(10).epsilon(0.005));  // 4.6 deviations of 1 / 92
  // Guided, the default removes nine tenths of the error at least and moves the mean by less than a fiftieth of one
  // pixel's deviation, of which chance has 1 / 96.
  const Moments guided = moments(denoiser.denoise(picture), 0);
  const Moments before = moments(picture.radiance, 0);
  CHECK(guided.variance < 0.01);
  CHECK(std::abs(guided.mean - before.mean) < 0.02);
}

TANDEM_DEVICE_TEST("Edges of albedo, normal, depth and coverage survive") {
  Denoiser denoiser(device_handle);
  for (const char* guide : {"albedo", "normal", "depth", "coverage"}) {
    CAPTURE(guide);
    NoisyPicture picture = flat_picture(32, 32, 1, 0);
    for (std::uint32_t y = 0; y < 32; ++y) {
      for (std::uint32_t x = 16; x < 32; ++x) {
        const std::size_t i = y * 32 + x;
        picture.radiance.pixels[i] = glm::vec3(2);
        if (guide[0] == 'a') picture.sampled_albedo[i] = picture.albedo[i] = glm::vec3(0.05f);
        if (guide[0] == 'n') picture.normal[i] = {1, 0, 0};
        if (guide[0] == 'd') picture.depth[i] = 20;
        if (guide[0] == 'c') picture.coverage[i] = 0;
      }
    }
    add_noise(picture, 0.5f);
    DenoiseSettings settings;
    settings.luminance_deviations = 1e6f;  // the guide alone tells the sides apart
    settings.firefly_deviations = 0;
    const Image image = denoiser.denoise(picture, settings);
    // exp(-0.95 sqrt(3) / 0.3) of a side is 0.4 %, of exp(-8) less; noise that is left is below 0.05, of 4 deviations.
    double left = 0, right = 0;
    for (std::uint32_t y = 0; y < 32; ++y) {
      left += image.at(15, y).x / 32.0;
      right += image.at(16, y).x / 32.0;
    }
    if (guide[0] == 'a') {
      // Radiance over albedo is 20 times larger on the right, and so are its noise and what it leaves.
      CHECK(left == doctest::Approx(1).epsilon(0.3));
    } else {
      CHECK(left == doctest::Approx(1).epsilon(0.1));
    }
    CHECK(right == doctest::Approx(2).epsilon(0.1));
  }
}

TANDEM_DEVICE_TEST("Textures stay, for they are no part of what is filtered") {
  Denoiser denoiser(device_handle);
  NoisyPicture picture = flat_picture(32, 32, 1, 0);
  add_noise(picture, 0.2f);
  for (std::size_t i = 0; i < picture.albedo.size(); ++i) {
    const float albedo = (i % 32 / 2 + i / 64) % 2 == 0 ? 0.3f : 0.45f;
    picture.sampled_albedo[i] = picture.albedo[i] = glm::vec3(albedo);
    picture.radiance.pixels[i] *= albedo;
    picture.variance[i] *= albedo * albedo;
  }
  const Image image = denoiser.denoise(picture);
  double worst = 0;
  for (std::size_t i = 0; i < image.pixels.size(); ++i)
    worst = std::max(worst, std::abs(double{image.pixels[i].x} / picture.albedo[i].x - 1));
  CHECK(worst < 0.15);  // of noise of 0.2 for one deviation
}

TANDEM_DEVICE_TEST("An edge shows what many first hits say, whatever the few samples met") {
  Denoiser denoiser(device_handle);
  NoisyPicture picture = flat_picture(9, 9, 0, 0);
  std::mt19937 random(3);
  for (std::size_t i = 0; i < picture.radiance.pixels.size(); ++i) {
    // A lamp of radiance 20 over a part of the pixel, a surface of albedo 0.5 in light of 2 over the rest.
    const float share = static_cast<float>(random() % 17) / 16;
    picture.sampled_emission[i] = glm::vec3(20 * share);
    picture.sampled_albedo[i] = glm::vec3(0.5f * (1 - share));
    picture.radiance.pixels[i] = glm::vec3(20 * share + 2 * 0.5f * (1 - share));
    picture.emission[i] = glm::vec3(20 * 0.25f);
    picture.albedo[i] = glm::vec3(0.5f * 0.75f);
  }
  DenoiseSettings settings;
  settings.luminance_deviations = 1e6f;  // a pixel that shows the lamp alone knows nothing of the light on the surface
  for (const glm::vec3& pixel : denoiser.denoise(picture, settings).pixels)
    CHECK(pixel.x == doctest::Approx(20 * 0.25 + 2 * 0.5 * 0.75).epsilon(0.03));
}

TANDEM_DEVICE_TEST("Noise-free differences of brightness survive without any guide") {
  Denoiser denoiser(device_handle);
  NoisyPicture picture = flat_picture(24, 24, 1, 0);
  for (std::size_t i = 0; i < picture.radiance.pixels.size(); ++i)
    if (i % 24 > 9) picture.radiance.pixels[i] = glm::vec3(1.05f);
  CHECK(same_bits(denoiser.denoise(picture), picture.radiance));
}

TANDEM_DEVICE_TEST("A firefly goes, a highlight that every sample sees stays") {
  Denoiser denoiser(device_handle);
  NoisyPicture picture = flat_picture(25, 25, 1, 0);
  add_noise(picture, 0.05f);
  NoisyPicture firefly = picture;
  firefly.radiance.pixels[312] = glm::vec3(1000);
  firefly.variance[312] = glm::vec3(1000 * 1000.0f);
  const Image clean = denoiser.denoise(firefly);
  // Nothing is left of it, in its pixel or around: the rest is noise.
  for (const glm::vec3& pixel : clean.pixels) CHECK(pixel.x == doctest::Approx(1).epsilon(0.2));
  DenoiseSettings keeps;
  keeps.firefly_deviations = 0;
  CHECK(denoiser.denoise(firefly, keeps).pixels[312].x > 2);  // spread over its surroundings
  NoisyPicture highlight = picture;
  for (glm::vec3& variance : highlight.variance) variance = glm::vec3(0);
  highlight.radiance.pixels[312] = glm::vec3(1000);
  CHECK(denoiser.denoise(highlight).pixels[312] == glm::vec3(1000));
}

TANDEM_DEVICE_TEST("A pixel that is no number is filled in, and does not spread") {
  Denoiser denoiser(device_handle);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float infinity = std::numeric_limits<float>::infinity();
  for (const float bad : {nan, infinity, -infinity}) {
    NoisyPicture picture = flat_picture(19, 19, 3, 0.5f);
    picture.radiance.pixels[180] = {3, bad, 3};
    picture.variance[180] = glm::vec3(bad);
    picture.sampled_albedo[40] = picture.albedo[40] = picture.normal[60] = glm::vec3(bad);
    picture.depth[80] = bad;
    const Image image = denoiser.denoise(picture);
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
      CAPTURE(i);
      for (int c = 0; c < 3; ++c) CHECK(std::isfinite(image.pixels[i][c]));
      // The pixel without albedo differs in what it is divided by.
      if (i != 40) CHECK(image.pixels[i].y == doctest::Approx(3).epsilon(0.02));
    }
  }
  // Nothing but such pixels: black.
  NoisyPicture alone = flat_picture(1, 1, nan, 0);
  CHECK(denoiser.denoise(alone).pixels[0] == glm::vec3(0));
}

TANDEM_DEVICE_TEST("Where the variance is unknown, the neighbourhood tells it") {
  Denoiser denoiser(device_handle);
  NoisyPicture picture = flat_picture(48, 48, 4, 0);
  add_noise(picture, 1);
  for (glm::vec3& variance : picture.variance) variance = glm::vec3(-1);
  CHECK(moments(denoiser.denoise(picture), 0).variance < 0.05);
}

TANDEM_DEVICE_TEST("Every device denoises to the same bits") {
  Denoiser denoiser(device_handle);
  Denoiser on_cpu(test::device("cpu"));
  const NoisyPicture picture = crowded_picture();
  for (const std::uint32_t levels : {0u, 1u, 5u}) {
    CAPTURE(levels);
    DenoiseSettings settings;
    settings.levels = levels;
    CHECK(same_bits(denoiser.denoise(picture, settings), on_cpu.denoise(picture, settings)));
  }
}

TANDEM_DEVICE_TEST("Settings out of range and planes of different sizes are refused") {
  Denoiser denoiser(device_handle);
  const NoisyPicture picture = flat_picture(2, 2, 1, 0);
  DenoiseSettings settings;
  settings.levels = 11;
  CHECK_THROWS_WITH_AS(denoiser.denoise(picture, settings), "a denoiser has at most 10 levels, not 11", Error);
  settings = {};
  settings.luminance_deviations = std::numeric_limits<float>::quiet_NaN();
  CHECK_THROWS_AS(denoiser.denoise(picture, settings), Error);
  settings = {};
  settings.firefly_deviations = -1;
  CHECK_THROWS_AS(denoiser.denoise(picture, settings), Error);
  NoisyPicture torn = picture;
  torn.depth.pop_back();
  CHECK_THROWS_WITH_AS(denoiser.denoise(torn), "the planes of a picture to denoise have 4 and 3 pixels", Error);
  CHECK_THROWS_AS(denoiser.denoise(NoisyPicture{}), Error);
}
