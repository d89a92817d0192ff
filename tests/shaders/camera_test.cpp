#include <doctest/doctest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include "tests/shaders/function_kernel.hpp"
#include "tests/shaders/random_source.hpp"
#include "tests/support/device_test.hpp"

using namespace tandem;

namespace {

glm::dvec3 vector_at(const std::vector<float>& values, std::size_t index) {
  return {values[index], values[index + 1], values[index + 2]};
}

/// Orthonormal but for rounding, and not along the axes.
const std::string basis = R"(
    vec3 right = vec3(0.6, 0.0, 0.8);
    vec3 up = vec3(0.64, 0.6, -0.48);
    vec3 forward = vec3(0.48, -0.8, -0.36);
)";
const glm::dvec3 right_vector(0.6, 0, 0.8), up_vector(0.64, 0.6, -0.48), forward_vector(0.48, -0.8, -0.36);

}  // namespace

TANDEM_DEVICE_TEST("Points of a pixel lie in its part of the film") {
  std::vector<float> inputs;
  for (const float pixel : {0.0f, 7.0f, 639.0f})
    for (const float u : {0.0f, 0.5f, 0.99999994f}) inputs.insert(inputs.end(), {pixel, u});
  const std::vector<float> outputs = test::run(device,
                                               {.includes = "#include \"camera/film.glsl\"",
                                                .body = R"(
    vec2 film = film_point(uvec2(input_float(0)), vec2(input_float(1)), uvec2(640, 1280));
    output_float(0, film.x);
    output_float(1, film.y);)",
                                                .input_count = 2,
                                                .output_count = 2},
                                               inputs);
  for (std::size_t i = 0; i < inputs.size(); i += 2) {
    const double place = double{inputs[i]} + inputs[i + 1];
    CHECK(outputs[i] == doctest::Approx(place / 320 - 1).epsilon(1e-6));
    CHECK(outputs[i + 1] == doctest::Approx(1 - place / 640).epsilon(1e-6));
  }
  CHECK(outputs.front() == -1.0f);
}

TANDEM_DEVICE_TEST("What a pinhole sees at the distance of focus, every point of the lens sees at the same place") {
  test::RandomSource random(31);
  std::vector<float> inputs;
  for (int i = 0; i < 20000; ++i) {
    for (const double limit : {1.0, 1.0}) inputs.push_back(static_cast<float>(random.uniform(-limit, limit)));
    for (int k = 0; k < 2; ++k) inputs.push_back(static_cast<float>(random.bits() >> 8) * 0x1p-24f);
    inputs.push_back(static_cast<float>(std::exp2(random.uniform(-3, 8))));  // distance of focus
  }
  const std::vector<float> outputs = test::run(device,
                                               {.includes = "#include \"camera/thin_lens.glsl\"",
                                                .body = basis + R"(
    vec2 film = vec2(input_float(0), input_float(1));
    right *= 0.75;
    up *= 0.5;
    vec3 from = lens_point(vec2(input_float(2), input_float(3)), 0.125, right, up);
    vec3 direction = lens_direction(film, from, input_float(4), right, up, forward);
    output_float(0, from.x); output_float(1, from.y); output_float(2, from.z);
    output_float(3, direction.x); output_float(4, direction.y); output_float(5, direction.z);)",
                                                .input_count = 5,
                                                .output_count = 6},
                                               inputs);
  double off_target = 0, off_lens = 0, farthest = 0, off_length = 0;
  glm::dvec3 centre(0);
  double squares = 0;
  const std::size_t count = inputs.size() / 5;
  for (std::size_t i = 0; i < count; ++i) {
    const double focus = inputs[5 * i + 4];
    const glm::dvec3 target =
        focus * (forward_vector + 0.75 * inputs[5 * i] * right_vector + 0.5 * inputs[5 * i + 1] * up_vector);
    const glm::dvec3 from = vector_at(outputs, 6 * i), direction = vector_at(outputs, 6 * i + 3);
    const glm::dvec3 met = from + direction * (glm::dot(target - from, direction) / glm::dot(direction, direction));
    off_target = std::max(off_target, glm::distance(met, target) / (focus + 0.125));
    off_lens = std::max(off_lens, std::abs(glm::dot(from, forward_vector)));
    farthest = std::max(farthest, glm::length(from));
    off_length = std::max(off_length, std::abs(glm::length(direction) - 1));
    centre += from / double(count);
    squares += glm::dot(from, from) / double(count);
  }
  CHECK(off_target < 1e-6);  // a few roundings of 6e-8
  CHECK(off_lens < 1e-7);
  CHECK(off_length < 2.5e-7);
  CHECK(farthest <= 0.1250001);
  CHECK(farthest > 0.124);
  // A uniform disk: its mean is its centre, its mean square half of its radius squared. Five deviations of 20000
  // points.
  CHECK(glm::length(centre) < 5 * 0.125 / std::sqrt(2.0 * 20000));
  CHECK(squares == doctest::Approx(0.0078125).epsilon(5 * 0.58 / std::sqrt(20000.0)));
}

TANDEM_DEVICE_TEST("Neighbouring pixels of an orthographic camera are a pixel apart") {
  const std::vector<float> outputs = test::run(device,
                                               {.includes = "#include \"camera/film.glsl\"\n#include "
                                                            "\"camera/orthographic.glsl\"",
                                                .body = basis + R"(
    vec2 film = film_point(uvec2(input_bits(0) % 40u, input_bits(0) / 40u), vec2(0.5), uvec2(40, 20));
    vec3 point = orthographic_point(film, right * 4.0, up * 2.0);
    output_float(0, point.x); output_float(1, point.y); output_float(2, point.z);)",
                                                .input_count = 1,
                                                .output_count = 3},
                                               [] {
                                                 std::vector<float> indices;
                                                 for (std::uint32_t i = 0; i < 800; ++i)
                                                   indices.push_back(std::bit_cast<float>(i));
                                                 return indices;
                                               }());
  for (std::size_t i = 0; i < 800; ++i) {
    const double x = (double(i % 40) - 19.5) * 0.2, y = (9.5 - double(i / 40)) * 0.2;
    CHECK(glm::distance(vector_at(outputs, 3 * i), x * right_vector + y * up_vector) < 2e-6);
  }
}

TANDEM_DEVICE_TEST("Pixels of an equirectangular camera are equal angles of longitude and latitude") {
  std::vector<float> inputs;
  for (int y = 0; y <= 32; ++y)
    for (int x = 0; x <= 64; ++x)
      inputs.insert(inputs.end(), {static_cast<float>(x) / 32 - 1, static_cast<float>(y) / 16 - 1});
  const std::vector<float> outputs = test::run(device,
                                               {.includes = "#include \"camera/equirectangular.glsl\"",
                                                .body = basis + R"(
    vec3 direction = equirectangular_direction(vec2(input_float(0), input_float(1)), right, up, forward);
    output_float(0, direction.x); output_float(1, direction.y); output_float(2, direction.z);)",
                                                .input_count = 2,
                                                .output_count = 3},
                                               inputs);
  double worst = 0;
  for (std::size_t i = 0; i < inputs.size() / 2; ++i) {
    const double longitude = std::numbers::pi * inputs[2 * i], latitude = std::numbers::pi / 2 * inputs[2 * i + 1];
    const glm::dvec3 expected = std::cos(latitude) * std::sin(longitude) * right_vector +
                                std::sin(latitude) * up_vector +
                                std::cos(latitude) * std::cos(longitude) * forward_vector;
    worst = std::max(worst, glm::distance(vector_at(outputs, 3 * i), expected));
  }
  CHECK(worst < 6e-7);  // an angle of pi, a sine of 2.5 ULP and a few roundings
}
