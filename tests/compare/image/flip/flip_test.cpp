#include "compare/image/flip/flip.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <string>

#include "compare/image/flip/color_space.hpp"
#include "compare/image/flip/filters.hpp"
#include "pathtracer/image/image_io.hpp"
#include "tests/compare/image/images.hpp"
#include "tests/support/run_summary.hpp"

namespace tandem::compare {
namespace {

const glm::vec3 black(0.0F);
const glm::vec3 white(1.0F);
const glm::vec3 red(1.0F, 0.0F, 0.0F);
const glm::vec3 green(0.0F, 1.0F, 0.0F);
const glm::vec3 blue(0.0F, 0.0F, 1.0F);

/// Errors are floats of filtered doubles.
constexpr double rounding = 1e-6;

pathtracer::Image scaled(pathtracer::Image image, float factor) {
  for (glm::vec3& pixel : image.pixels) pixel *= factor;
  return image;
}

/// The errors of a pair of constant pictures, which must be the same everywhere.
double constant_error(const glm::vec3& a, const glm::vec3& b) {
  const FlipErrors errors = flip(constant_image(24, 17, a), constant_image(24, 17, b));
  const auto [least, most] = std::minmax_element(errors.errors.begin(), errors.errors.end());
  CHECK(*most - *least < rounding);
  CHECK(errors.largest == *most);
  CHECK(errors.mean == doctest::Approx(*most).epsilon(rounding));
  return errors.mean;
}

TEST_CASE("colours are those that CIELAB is known to have") {
  struct Known {
    glm::vec3 rgb;
    glm::dvec3 lab;
  };
  // CIELAB of the primaries of sRGB under D65 as colour calculators print them; they differ in the third decimal, by
  // how many digits of the white point they take.
  for (const Known& known : {Known{black, {0, 0, 0}}, Known{white, {100, 0, 0}}, Known{red, {53.241, 80.092, 67.203}},
                             Known{green, {87.735, -86.183, 83.179}}, Known{blue, {32.297, 79.188, -107.860}}}) {
    const glm::dvec3 lab = lab_of_linear_rgb(known.rgb);
    for (int channel = 0; channel < 3; ++channel) CHECK(std::abs(lab[channel] - known.lab[channel]) < 0.02);
    const glm::dvec3 back = linear_rgb_of_ycxcz(ycxcz_of_linear_rgb(known.rgb));
    for (int channel = 0; channel < 3; ++channel) CHECK(std::abs(back[channel] - known.rgb[channel]) < 1e-12);
  }
  // Grays have no colour; their lightness is 116 Y^(1/3) - 16, or the straight line 24389/27 Y when dark.
  CHECK(lab_of_linear_rgb(glm::dvec3(0.18)).x == doctest::Approx(116 * std::cbrt(0.18) - 16).epsilon(1e-12));
  CHECK(lab_of_linear_rgb(glm::dvec3(0.005)).x == doctest::Approx(24389.0 / 27 * 0.005).epsilon(1e-12));
  CHECK(std::abs(lab_of_linear_rgb(glm::dvec3(0.18)).y) < 1e-9);
}

TEST_CASE("the viewer sits where the paper puts them") {
  CHECK(ViewingConditions{}.pixels_per_degree == doctest::Approx(67.0206).epsilon(1e-6));
}

TEST_CASE("equal pictures have no visible error") {
  const pathtracer::Image a = noise_image(31, 20, 1);
  CHECK(flip(a, a).largest == 0.0);
  CHECK(hdr_flip(a, a).errors.largest == 0.0);
}

TEST_CASE("errors of constant pictures are those worked out by hand") {
  // Without features the error is that of the colours: the distance HyAB of their CIELAB values with a* and b* times
  // L* / 100, to the power 0.7; the largest is that of green and blue, 41.275. Below 0.4 of it the error is the
  // fraction of 0.4 times 0.95; above it goes on linearly to 1. Worked out from the CIELAB values above, good to 1e-4.
  CHECK(constant_error(black, white) == doctest::Approx(0.967381).epsilon(1e-4));
  CHECK(constant_error(green, blue) == doctest::Approx(1.0).epsilon(1e-6));
  CHECK(constant_error(red, green) == doctest::Approx(0.986662).epsilon(1e-4));
  CHECK(constant_error(black, blue) == doctest::Approx(0.958329).epsilon(1e-4));
  // Grays: 116 (0.25^(1/3) - 0.2^(1/3)) to the power 0.7, over 41.275, times 0.95 / 0.4.
  CHECK(constant_error(glm::vec3(0.2F), glm::vec3(0.25F)) == doctest::Approx(0.183400).epsilon(1e-4));
}

TEST_CASE("a step has all of an edge at it, and a band as wide as the eye's filter all of a line") {
  constexpr std::uint32_t size = 41;
  const double ppd = ViewingConditions{}.pixels_per_degree;
  const auto plane = [](const auto& value) {
    Plane result{.width = size, .height = size, .values = {}};
    for (int y = 0; y < int{size}; ++y) {
      for (int x = 0; x < int{size}; ++x) result.values.push_back(value(x - 20, y - 20));
    }
    return result;
  };
  constexpr std::size_t middle = std::size_t{20} * size + 20;
  const Features step = features(plane([](int x, int) { return x >= 0 ? 1.0 : 0.0; }), ppd);
  CHECK(step.edges.values[middle] == doctest::Approx(1.0).epsilon(1e-12));
  CHECK(step.edges.values[middle - 1] == doctest::Approx(1.0).epsilon(1e-12));
  CHECK(step.edges.values[middle + 1] < 0.99);
  CHECK(step.edges.values[middle + 15] < 1e-12);
  // The second derivative of the Gaussian is negative within one standard deviation, 0.041 degrees or 2.75 pixels.
  for (const bool upright : {false, true}) {
    const Features band =
        features(plane([&](int x, int y) { return std::abs(upright ? x : y) <= 2 ? 1.0 : 0.0; }), ppd);
    CHECK(band.points.values[middle] == doctest::Approx(1.0).epsilon(1e-12));
    CHECK(band.edges.values[middle] < 1e-12);
  }
  const Features constant = features(plane([](int, int) { return 0.7; }), ppd);
  CHECK(*std::max_element(constant.edges.values.begin(), constant.edges.values.end()) < 1e-12);
  CHECK(*std::max_element(constant.points.values.begin(), constant.points.values.end()) < 1e-12);
}

TEST_CASE("what an eye sees of a pixel is the sum of Gaussians of the paper") {
  constexpr int size = 51;
  const double ppd = ViewingConditions{}.pixels_per_degree;
  Plane pixel{.width = size, .height = size, .values = std::vector<double>(std::size_t{size} * size)};
  pixel.values[std::size_t{25} * size + 25] = 1.0;
  const Plane seen_pixel = seen(pixel, blue_yellow_sensitivity(), ppd);
  // The kernel in two dimensions, not taken apart: radius 3 standard deviations of the widest Gaussian, 10 pixels.
  const auto weight = [&](int x, int y) {
    const double squared = (x * x + y * y) / (ppd * ppd);
    const double pi = 3.14159265358979;
    const double wide = 34.1 * std::sqrt(pi / 0.04) * std::exp(-pi * pi * squared / 0.04);
    return wide + 13.5 * std::sqrt(pi / 0.025) * std::exp(-pi * pi * squared / 0.025);
  };
  double sum = 0.0;
  for (int y = -10; y <= 10; ++y) {
    for (int x = -10; x <= 10; ++x) sum += weight(x, y);
  }
  for (int y = -12; y <= 12; ++y) {
    for (int x = -12; x <= 12; ++x) {
      const bool inside = std::abs(x) <= 10 && std::abs(y) <= 10;
      const double expected = inside ? weight(x, y) / sum : 0.0;
      CHECK(std::abs(seen_pixel.values[static_cast<std::size_t>((25 + y) * size + 25 + x)] - expected) < 1e-12);
    }
  }
}

TEST_CASE("visible errors are symmetric and move with the picture") {
  const pathtracer::Image a = noise_image(60, 40, 1);
  pathtracer::Image b = a;
  for (std::uint32_t y = 15; y < 20; ++y) {
    for (std::uint32_t x = 15; x < 22; ++x) b.pixels[y * 60 + x] = glm::vec3(0.2F, 0.9F, 0.1F);
  }
  const FlipErrors errors = flip(a, b);
  CHECK(errors.largest > 0.2);
  CHECK(errors.errors == flip(b, a).errors);

  // Both pictures ten pixels to the right and five down. No filter reaches further than 10 pixels.
  const auto moved = [](const pathtracer::Image& source) {
    pathtracer::Image result = source;
    for (std::uint32_t y = 5; y < 40; ++y) {
      for (std::uint32_t x = 10; x < 60; ++x) result.pixels[y * 60 + x] = source.at(x - 10, y - 5);
    }
    return result;
  };
  const FlipErrors moved_errors = flip(moved(a), moved(b));
  for (std::uint32_t y = 20; y < 30; ++y) {
    for (std::uint32_t x = 20; x < 50; ++x) {
      CHECK(moved_errors.errors[y * 60 + x] == errors.errors[(y - 5) * 60 + x - 10]);
    }
  }
}

TEST_CASE("from further away a difference of single pixels is seen less") {
  const pathtracer::Image a = constant_image(40, 40, glm::vec3(0.5F));
  pathtracer::Image b = a;
  b.pixels[20 * 40 + 20] = black;
  CHECK(flip(a, b, {.pixels_per_degree = 120.0}).largest < 0.8 * flip(a, b, {.pixels_per_degree = 30.0}).largest);
}

TEST_CASE("exposures lead from the brightest pixel to the median one") {
  // 0.85 is the tone of 2.1188723 = 2^1.0832967, the root of the curve's quadratic equation with the coefficients of
  // the paper.
  pathtracer::Image a = constant_image(5, 1, glm::vec3(0.5F));
  a.pixels[0] = glm::vec3(0.1F);
  a.pixels[4] = glm::vec3(64.0F);
  const HdrFlipErrors errors = hdr_flip(a, a);
  CHECK(errors.first_exposure == doctest::Approx(1.0832967 - 6.0).epsilon(1e-6));
  CHECK(errors.last_exposure == doctest::Approx(1.0832967 + 1.0).epsilon(1e-6));
  CHECK(errors.exposures == 7);
  const HdrFlipErrors even = hdr_flip(constant_image(4, 4, glm::vec3(0.5F)), constant_image(4, 4, glm::vec3(0.5F)));
  CHECK(even.exposures == 2);
}

TEST_CASE("errors in high dynamic range do not depend on how bright both images are") {
  const pathtracer::Image a = scaled(noise_image(24, 20, 1), 3.0F);
  const pathtracer::Image b = scaled(noise_image(24, 20, 2), 3.0F);
  const HdrFlipErrors errors = hdr_flip(a, b);
  const HdrFlipErrors brighter = hdr_flip(scaled(a, 1024.0F), scaled(b, 1024.0F));
  CHECK(brighter.first_exposure == doctest::Approx(errors.first_exposure - 10.0).epsilon(1e-6));
  CHECK(brighter.exposures == errors.exposures);
  CHECK(errors.errors.mean > 0.1);
  // The exposures are rounded differently.
  CHECK(brighter.errors.mean == doctest::Approx(errors.errors.mean).epsilon(1e-5));
}

TEST_CASE("high dynamic range finds what clamping hides, in lights and in the dark") {
  pathtracer::Image a = constant_image(30, 30, glm::vec3(0.0001F));
  for (std::size_t index = 0; index < 300; ++index) a.pixels[index] = glm::vec3(50.0F);
  pathtracer::Image brighter_light = a;
  for (std::size_t index = 0; index < 300; ++index) brighter_light.pixels[index] = glm::vec3(100.0F);
  CHECK(flip(a, brighter_light).largest == 0.0);
  CHECK(hdr_flip(a, brighter_light).errors.largest > 0.1);
  pathtracer::Image other_dark = a;
  for (std::size_t index = 300; index < 900; ++index) other_dark.pixels[index] = glm::vec3(0.0002F);
  CHECK(flip(a, other_dark).errors[29 * 30 + 15] < 0.02F);
  CHECK(hdr_flip(a, other_dark).errors.errors[29 * 30 + 15] > 0.1F);
}

TEST_CASE("black references and pictures of one pixel have errors, too") {
  CHECK(hdr_flip(constant_image(3, 3, black), constant_image(3, 3, black)).errors.largest == 0.0);
  const HdrFlipErrors lit = hdr_flip(constant_image(3, 3, black), constant_image(3, 3, white));
  CHECK(lit.exposures == 1);
  CHECK(lit.errors.mean > 0.5);
  CHECK(flip(constant_image(1, 1, black), constant_image(1, 1, white)).mean == doctest::Approx(0.967381).epsilon(1e-4));
}

TEST_CASE("pixels that are not finite have the error 1 and hide nothing around them") {
  const pathtracer::Image a = noise_image(40, 30, 1);
  pathtracer::Image broken = a;
  broken.pixels[3 * 40 + 3].x = std::numeric_limits<float>::quiet_NaN();
  broken.pixels[20 * 40 + 30].y = std::numeric_limits<float>::infinity();
  for (const FlipErrors& errors : {flip(a, broken), flip(broken, broken), hdr_flip(a, broken).errors}) {
    CHECK(errors.mean == doctest::Approx(2.0 / 1200).epsilon(rounding));
    CHECK(errors.errors[3 * 40 + 3] == 1.0F);
    CHECK(errors.errors[20 * 40 + 30] == 1.0F);
    CHECK(errors.errors[3 * 40 + 4] == 0.0F);
  }
  const pathtracer::Image negative = constant_image(4, 4, glm::vec3(-5.0F));
  CHECK(flip(negative, constant_image(4, 4, black)).largest == 0.0);
  CHECK(hdr_flip(constant_image(4, 4, black), negative).errors.largest == 0.0);
}

TEST_CASE("the map of errors goes from black to pale yellow") {
  const pathtracer::Image map = error_map({.width = 3, .height = 1, .errors = {0.0F, 0.5F, 1.0F}});
  REQUIRE(map.pixels.size() == 3);
  CHECK(map.pixels[0].r == 0.0F);
  CHECK(map.pixels[1].r > map.pixels[1].g);
  CHECK(map.pixels[2].g > 0.95F);
}

TEST_CASE("mean errors of published pairs of images are those published") {
  const char* const folder = std::getenv("TANDEM_FLIP_IMAGES");
  if (folder == nullptr)
    TANDEM_SKIP("TANDEM_FLIP_IMAGES does not name a folder with the images (docs/guide/metrics.md says which)");
  struct Pair {
    std::string reference;
    std::string test;
    bool hdr;
    double mean;
    double tolerance;  ///< what is published is rounded, and computed in single precision
  };
  int checked = 0;
  for (const Pair& pair : {Pair{"reference.png", "test.png", false, 0.159691, 2e-5},
                           Pair{"reference.exr", "test.exr", true, 0.283478, 2e-5},
                           Pair{"tree-ref.png", "tree-test.png", false, 0.133285, 2e-5}}) {
    const std::filesystem::path reference = std::filesystem::path(folder) / pair.reference;
    const std::filesystem::path test = std::filesystem::path(folder) / pair.test;
    if (!std::filesystem::exists(reference) || !std::filesystem::exists(test)) {
      MESSAGE("not checked: no ", pair.reference, " and ", pair.test, " in ", std::string(folder));
      continue;
    }
    const pathtracer::Image a = pathtracer::read_image(reference);
    const pathtracer::Image b = pathtracer::read_image(test);
    const double mean = pair.hdr ? hdr_flip(a, b).errors.mean : flip(a, b).mean;
    MESSAGE(pair.reference, ": mean ", mean, ", published ", pair.mean);
    CHECK(std::abs(mean - pair.mean) < pair.tolerance);
    ++checked;
  }
  CHECK(checked > 0);
}

}  // namespace
}  // namespace tandem::compare
