#include "compare/metrics/relative_error.hpp"

#include <doctest/doctest.h>

#include <limits>

#include "tests/compare/image/images.hpp"

namespace tandem::compare {
namespace {

// A handful of operations on doubles.
constexpr double rounding = 1e-14;

TEST_CASE("percentiles of relative differences are those of nearest rank") {
  // 300 values: 1/k for k = 1 ... 300, all exact in float to 24 bits; a is 1, b is 1 - 1/k, so |a - b| / max = 1/k.
  pathtracer::Image a = constant_image(100, 1, glm::vec3(1.0F));
  pathtracer::Image b = a;
  for (int index = 0; index < 300; ++index) {
    b.pixels[static_cast<std::size_t>(index / 3)][index % 3] = 1.0F - 1.0F / static_cast<float>(index + 1);
  }
  for (const RelativeError& error : {relative_error(a, b), relative_error(b, a)}) {
    // The rank of a fraction f is 300 f rounded up; the value of rank r is 1 / (301 - r). Floats near 1 have steps of
    // 6e-8.
    CHECK(error.percentile_50 == doctest::Approx(1.0 / 151).epsilon(1e-4));
    CHECK(error.percentile_90 == doctest::Approx(1.0 / 31).epsilon(1e-5));
    CHECK(error.percentile_99 == doctest::Approx(1.0 / 4).epsilon(1e-6));
    CHECK(error.percentile_99_9 == 1.0);
    CHECK(error.largest == 1.0);
  }
}

TEST_CASE("relative differences know zeros, signs and the smallest numbers") {
  const auto largest = [](float a, float b) {
    return relative_error(constant_image(1, 1, glm::vec3(a)), constant_image(1, 1, glm::vec3(b))).largest;
  };
  CHECK(largest(0.0F, -0.0F) == 0.0);
  CHECK(largest(0.0F, 1e-45F) == 1.0);
  CHECK(largest(-1.0F, 1.0F) == 2.0);
  CHECK(largest(3e38F, -3e38F) == 2.0);
}

TEST_CASE("the relative mean squared error divides by the reference's square and a hundredth") {
  const pathtracer::Image a = image(2, 1, {glm::vec3(0.0F), glm::vec3(2.0F)});
  const pathtracer::Image b = image(2, 1, {glm::vec3(0.5F), glm::vec3(1.0F)});
  CHECK(relative_error(a, b).rel_mse == doctest::Approx(0.5 * (0.25 / 0.01 + 1.0 / 4.01)).epsilon(rounding));
  CHECK(relative_error(b, a).rel_mse == doctest::Approx(0.5 * (0.25 / 0.26 + 1.0 / 1.01)).epsilon(rounding));
}

TEST_CASE("relative differences leave out pixels that are not finite") {
  const float infinity = std::numeric_limits<float>::infinity();
  const pathtracer::Image a = image(2, 1, {glm::vec3(infinity, 1, 1), glm::vec3(2.0F)});
  const pathtracer::Image b = image(2, 1, {glm::vec3(infinity, 5, 5), glm::vec3(2.0F)});
  CHECK(relative_error(a, b).largest == 0.0);
  CHECK(relative_error(a, b).rel_mse == 0.0);
  const RelativeError none = relative_error(constant_image(1, 1, glm::vec3(infinity)), constant_image(1, 1, {}));
  CHECK(none.largest == 0.0);
  CHECK(none.percentile_50 == 0.0);
}

}  // namespace
}  // namespace tandem::compare
