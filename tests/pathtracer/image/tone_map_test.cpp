#include "pathtracer/image/tone_map.hpp"

#include <cmath>
#include <limits>

#include <doctest/doctest.h>

using namespace tandem::pathtracer;

namespace {

float grey(float radiance, ToneCurve curve, double exposure = 0) {
  const glm::vec3 shown = tone_mapped(glm::vec3(radiance), {.curve = curve, .exposure = exposure});
  CHECK(shown.x == shown.y);
  CHECK(shown.x == shown.z);
  return shown.x;
}

/// The transfer function of sRGB in double precision.
double srgb(double linear) { return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055; }

}  // namespace

TEST_CASE("The curves agree with their formulas") {
  for (const float radiance : {0.001f, 0.02f, 0.18f, 0.5f, 0.9f}) {
    const double x = radiance;
    CAPTURE(x);
    CHECK(grey(radiance, ToneCurve::srgb) == doctest::Approx(srgb(x)).epsilon(1e-5));
    CHECK(grey(radiance, ToneCurve::gamma) == doctest::Approx(std::pow(x, 1 / 2.2)).epsilon(1e-5));
    CHECK(grey(radiance, ToneCurve::reinhard) == doctest::Approx(srgb(x / (1 + x))).epsilon(1e-5));
    const double film = x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14);
    CHECK(grey(radiance, ToneCurve::filmic) == doctest::Approx(srgb(film)).epsilon(1e-5));
  }
}

TEST_CASE("Every curve rises from 0 to at most 1, whatever it is given") {
  for (const auto& [curve, name] : tone_curve_names()) {
    CAPTURE(name);
    float before = -1;
    for (float radiance = 1e-6f; radiance < 1e30f; radiance *= 1.7f) {
      const float shown = grey(radiance, curve);
      CHECK(shown >= before);
      CHECK(shown <= 1);
      before = shown;
    }
    CHECK(grey(std::numeric_limits<float>::infinity(), curve) > 0.999f);
    for (const float nothing : {0.0f, -1.0f, std::numeric_limits<float>::quiet_NaN()}) CHECK(grey(nothing, curve) == 0);
  }
}

TEST_CASE("A stop of exposure doubles radiance") {
  for (const auto& [curve, name] : tone_curve_names()) {
    CAPTURE(name);
    CHECK(grey(0.1f, curve, 2) == grey(0.4f, curve));
    CHECK(grey(0.4f, curve, -2) == grey(0.1f, curve));
  }
}

TEST_CASE("Reinhard's curve keeps the ratios of a colour's channels") {
  const glm::vec3 shown = tone_mapped({0.004f, 0.002f, 0.001f}, {.curve = ToneCurve::reinhard, .exposure = -2});
  // So dark that the transfer function is a line.
  CHECK(shown.x / shown.y == doctest::Approx(2));
  CHECK(shown.y / shown.z == doctest::Approx(2));
}
