#include <doctest/doctest.h>

#include <cmath>
#include <complex>
#include <vector>

#include "tests/shaders/function_kernel.hpp"
#include "tests/support/device_test.hpp"

using namespace tandem;

namespace {

/// Fresnel's equations in double precision from the angle, by Snell's law.
double fresnel(double cosine, double eta) {
  const double angle = std::acos(cosine);
  const double sine = std::sin(angle) / eta;
  if (sine >= 1.0) return 1.0;
  const double refracted = std::asin(sine);
  if (angle < 1e-6) return std::pow((eta - 1.0) / (eta + 1.0), 2.0);
  const double s = std::sin(angle - refracted) / std::sin(angle + refracted);
  const double p = std::tan(angle - refracted) / std::tan(angle + refracted);
  return 0.5 * (s * s + p * p);
}

}  // namespace

TANDEM_DEVICE_TEST("Fresnel reflectance agrees with the sine and tangent laws") {
  std::vector<float> inputs;
  for (const float eta : {1.5f, 1.0f / 1.5f, 1.33f, 2.4f, 1.0001f, 0.4f})
    for (int i = 1; i < 1000; ++i) inputs.insert(inputs.end(), {static_cast<float>(i) / 1000.0f, eta});
  const std::vector<float> outputs = test::run(device,
                                               {.includes = "#include \"bsdf/fresnel.glsl\"",
                                                .body = R"(
    float t = refracted_cosine(input_float(0), input_float(1));
    output_float(0, fresnel_dielectric(input_float(0), t, input_float(1)));
    output_float(1, t);)",
                                                .input_count = 2,
                                                .output_count = 2},
                                               inputs);
  double worst = 0.0;
  double worst_snell = 0.0;
  for (std::size_t i = 0; i < inputs.size(); i += 2) {
    const double cosine = inputs[i], eta = inputs[i + 1];
    worst = std::max(worst, std::abs(outputs[i] - fresnel(cosine, eta)));
    const double sine = std::sqrt(1.0 - cosine * cosine) / eta;
    // Squared, because a cosine near 0 is the root of a difference.
    if (sine < 1.0)
      worst_snell = std::max(worst_snell, std::abs(double{outputs[i + 1]} * outputs[i + 1] - (1.0 - sine * sine)));
  }
  // The slope of the reflectance is steepest just before total reflection: an ULP of the refracted cosine's square,
  // some 1e-7, moves the cosine by up to 3e-4 and the reflectance by about as much; elsewhere by 1e-6.
  CHECK(worst < 2e-3);
  CHECK(worst_snell < 2e-6);
}

TANDEM_DEVICE_TEST("Fresnel reflectance at known points") {
  const test::FunctionKernel kernel = {.includes = "#include \"bsdf/fresnel.glsl\"",
                                       .body =
                                           "output_float(0, fresnel_dielectric(input_float(0), "
                                           "refracted_cosine(input_float(0), input_float(1)), input_float(1)));",
                                       .input_count = 2};
  const std::vector<float> outputs = test::run(device, kernel,
                                               {1.0f, 1.5f,          // normal incidence on glass: ((n - 1) / (n + 1))^2
                                                1.0f, 1.0f / 1.5f,   // the same from inside
                                                0.0f, 1.5f,          // grazing
                                                0.5f, 1.0f / 1.5f,   // 60 degrees inside glass: total reflection
                                                0.3f, 1.0f,          // no interface
                                                0.001f, 1.0f,        // no interface, grazing
                                                0.5547002f, 1.5f});  // Brewster's angle
  CHECK(outputs[0] == doctest::Approx(0.04).epsilon(1e-6));
  CHECK(outputs[1] == doctest::Approx(0.04).epsilon(1e-6));
  CHECK(outputs[2] == 1.0f);
  CHECK(outputs[3] == 1.0f);
  CHECK(outputs[4] == doctest::Approx(0.0).epsilon(1e-12));
  CHECK(outputs[5] == doctest::Approx(0.0).epsilon(1e-12));
  // There the parallel part vanishes and the other is ((n^2 - 1) / (n^2 + 1))^2.
  CHECK(outputs[6] == doctest::Approx(0.5 * std::pow(1.25 / 3.25, 2)).epsilon(1e-5));
}

TANDEM_DEVICE_TEST(
    "A dielectric refracts by Snell's law, reflects totally beyond the critical angle and keeps the energy") {
  std::vector<float> inputs;
  for (const float eta : {1.5f, 1.0f / 1.5f, 1.1f, 0.5f})
    for (int i = 0; i <= 100; ++i)
      for (const float u : {0.0f, 0.25f, 0.999999f})
        inputs.insert(inputs.end(), {static_cast<float>(i) * 0.0157f, eta, u});
  const std::vector<float> outputs = test::run(device,
                                               {.includes = "#include \"bsdf/dielectric.glsl\"",
                                                .body = R"(
    vec2 sc = det_sincos(input_float(0));
    vec3 wo = vec3(0.6 * sc.x, 0.8 * sc.x, sc.y);
    BsdfSample s = dielectric_sample(vec3(0.5, 0.75, 1.0), input_float(1), wo, input_float(2));
    output_float(0, s.direction.x); output_float(1, s.direction.y); output_float(2, s.direction.z);
    output_float(3, s.weight.x); output_float(4, s.weight.z); output_float(5, s.eta); output_float(6, float(s.lobe));)",
                                                .input_count = 3,
                                                .output_count = 7},
                                               inputs);
  int transmitted_count = 0, total_count = 0;
  for (std::size_t row = 0; row < inputs.size() / 3; ++row) {
    const double angle = inputs[3 * row], eta = inputs[3 * row + 1], u = inputs[3 * row + 2];
    const float* out = &outputs[7 * row];
    const double sine = std::sin(angle), cosine = std::cos(angle);
    const bool transmitted = out[6] == 6.0f;
    INFO("angle ", angle, ", eta ", eta, ", u ", u);
    CHECK(std::hypot(double{out[0]}, double{out[1]}, double{out[2]}) == doctest::Approx(1.0).epsilon(1e-6));
    if (transmitted) {
      ++transmitted_count;
      CHECK(std::hypot(out[0], out[1]) == doctest::Approx(sine / eta).epsilon(1e-5));
      CHECK(out[0] <= 0.0f);
      CHECK(out[2] <= 0.0f);
      CHECK(out[3] == doctest::Approx(0.5 / (eta * eta)).epsilon(1e-6));
      CHECK(out[4] == doctest::Approx(1.0 / (eta * eta)).epsilon(1e-6));
      CHECK(out[5] == doctest::Approx(eta));
      CHECK(u >= fresnel(cosine, eta) - 2e-3);
    } else {
      CHECK(out[6] == 2.0f);
      CHECK(out[0] == doctest::Approx(-0.6 * sine).epsilon(1e-5));
      CHECK(out[2] == doctest::Approx(cosine).epsilon(1e-5));
      // What is not refracted is reflected: the choice has the probability of its energy, so the weight is 1.
      CHECK(out[3] == 1.0f);
      CHECK(out[5] == 1.0f);
      CHECK(u < fresnel(cosine, eta) + 2e-3);
    }
    if (sine / eta > 1.0001) {
      ++total_count;
      CHECK(!transmitted);
    }
  }
  CHECK(transmitted_count > 300);
  CHECK(total_count > 100);
}

TANDEM_DEVICE_TEST("The mirror reflects about the normal; Lambert's weight is the albedo and its parts agree") {
  const std::vector<float> outputs =
      test::run(device,
                {.includes = "#include \"bsdf/lambert.glsl\"\n#include \"bsdf/mirror.glsl\"",
                 .body = R"(
    BsdfSample m = mirror_sample(vec3(0.25), vec3(0.48, 0.64, 0.6));
    output_float(0, m.direction.x); output_float(1, m.direction.y); output_float(2, m.direction.z); output_float(3, m.weight.y);
    vec3 albedo = vec3(0.2, 0.5, 0.8);
    BsdfSample l = lambert_sample(albedo, vec2(input_float(0), 0.3));
    output_float(4, l.weight.z);
    output_float(5, l.density);
    output_float(6, lambert_evaluate(albedo, l.direction).z * l.direction.z);
    output_float(7, lambert_evaluate(albedo, -l.direction).z + lambert_density(-l.direction));)",
                 .output_count = 8},
                {0.15f});
  CHECK(outputs[0] == -0.48f);
  CHECK(outputs[1] == -0.64f);
  CHECK(outputs[2] == 0.6f);
  CHECK(outputs[3] == 0.25f);
  CHECK(outputs[4] == 0.8f);
  CHECK(outputs[6] / outputs[5] == doctest::Approx(0.8).epsilon(1e-6));
  CHECK(outputs[7] == 0.0f);
}
