// Cubes: which face and texel a direction meets, filters across edges and corners, gradients.

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include <doctest/doctest.h>

#include "rhi_cpu/kernel/abi.hpp"
#include "tests/rhi_cpu/translate/sampling_harness.hpp"

namespace {

using doctest::Approx;
using tandem::kernel::Filter;
using tandem::kernel::Sampler;
using tandem::test::Ask;
using tandem::test::Four;
using tandem::test::TestImage;

Sampler linear() {
  Sampler sampler;
  sampler.magnification = sampler.minification = Filter::linear;
  return sampler;
}

/// Faces of size^2 texels: 100 * layer + x + 10 * y.
std::vector<float> numbered_faces(std::size_t size, std::size_t layers) {
  std::vector<float> texels;
  for (std::size_t layer = 0; layer < layers; ++layer)
    for (std::size_t y = 0; y < size; ++y)
      for (std::size_t x = 0; x < size; ++x) texels.push_back(static_cast<float>(100 * layer + x + 10 * y));
  return texels;
}

TEST_CASE("faces and the coordinates on them, by Vulkan's table") {
  const TestImage cube({2, 2, 6}, 2, {numbered_faces(2, 6)});
  const TestImage cubes({2, 2, 12}, 2, {numbered_faces(2, 12)});
  struct Row {
    Four direction;
    float value;
  };
  // In each the first coordinate of the table is positive and the second negative (s = 1, t = 0), then the other way.
  const Row rows[] = {
      {{2, 1, -1, 0}, 1},    {{2, -1, 1, 0}, 10},     // +x: -z, -y
      {{-2, 1, 1, 0}, 101},  {{-2, -1, -1, 0}, 110},  // -x: +z, -y
      {{1, 2, -1, 0}, 201},  {{-1, 2, 1, 0}, 210},    // +y: +x, +z
      {{1, -2, 1, 0}, 301},  {{-1, -2, -1, 0}, 310},  // -y: +x, -z
      {{1, 1, 2, 0}, 401},   {{-1, -1, 2, 0}, 410},   // +z: +x, -y
      {{-1, 1, -2, 0}, 501}, {{1, -1, -2, 0}, 510},   // -z: -x, -y
  };
  for (const Row& row : rows) {
    CAPTURE(row.value);
    CHECK(cube.sampled({}, {Ask::level_cube, row.direction})[0] == row.value);
    for (const float which : {0.0f, 1.0f, 0.5f, 1.5f, -1.0f, 7.0f}) {
      Four at = row.direction;
      at[3] = which;
      CHECK(cubes.sampled({}, {Ask::level_cube_array, at})[0] == row.value + (which >= 1 ? 600 : 0));
    }
  }
  // On edges z wins over y, and y over x. A nearest filter stays on the face.
  CHECK(cube.sampled({}, {Ask::level_cube, {1, 1, 1}})[0] == 401);
  CHECK(cube.sampled({}, {Ask::level_cube, {1, -1, -0.5f}})[0] == 311);
}

TEST_CASE("a linear filter crosses edges, and a corner has three texels") {
  const TestImage one({1, 1, 6}, 2, {{0, 10, 20, 40, 80, 160}});
  const auto at = [&](float x, float y, float z) { return one.sampled(linear(), {Ask::level_cube, {x, y, z}})[0]; };
  CHECK(at(1, 0, 0) == 0);
  CHECK(at(0, 0, -9) == 160);
  CHECK(at(1, 0, 1) == 40);
  CHECK(at(-1, -1, 0) == 25);
  CHECK(at(0, 1, -1) == 90);
  // 0.75 of +z and 0.25 of +x, in the middle of the edge's sides.
  CHECK(at(0.5f, 0, 1) == 60);
  // Thirds, with the roundings of three sums.
  CHECK(at(1, 1, 1) == Approx(100 / 3.0).epsilon(1e-6));
  CHECK(at(-1, -1, -1) == Approx(70).epsilon(1e-6));
}

TEST_CASE("a linear filter is continuous across each edge") {
  std::vector<float> texels;
  std::uint32_t state = 1;
  for (int i = 0; i < 6 * 9; ++i) {
    state = state * 1664525u + 1013904223u;
    texels.push_back(static_cast<float>(state >> 24));
  }
  const TestImage cube({3, 3, 6}, 2, {texels});
  const auto at = [&](const std::array<float, 3>& d) {
    return cube.sampled(linear(), {Ask::level_cube, {d[0], d[1], d[2]}})[0];
  };
  // A step of 2e-5 of a face's side moves by 6e-5 texels, of which two neighbours differ by less than 256.
  constexpr float step = 1e-5f, most = 6e-5f * 256;
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (const float first : {-1.0f, 1.0f})
      for (const float second : {-1.0f, 1.0f})
        for (const float along : {-0.95f, -0.6f, -0.2f, 0.1f, 0.5f, 0.9f}) {
          std::array<float, 3> d = {};
          d[axis] = along;
          d[(axis + 1) % 3] = first * (1 - step);
          d[(axis + 2) % 3] = second;
          const float here = at(d);
          d[(axis + 1) % 3] = first;
          d[(axis + 2) % 3] = second * (1 - step);
          CAPTURE(axis);
          CAPTURE(along);
          CHECK(std::fabs(at(d) - here) <= most);
        }
}

TEST_CASE("the fourth texel beside an edge is the one on the other side, at the same place") {
  // Texel (1, 0) of +z (the first 2, then its number) and the one above it on +y, whose rows go the same way: (1, 1).
  const TestImage cube({2, 2, 6}, 2, {numbered_faces(2, 6)});
  const Four up = cube.sampled({}, {Ask::gather_cube, {0, 0.999f, 1}});
  // (x, y + 1), (x + 1, y + 1), (x + 1, y), (x, y)
  CHECK(up == Four{400, 401, 211, 210});
  // To the right of +z lies the left column of +x.
  CHECK(cube.sampled({}, {Ask::gather_cube, {0.999f, 0, 1}}) == Four{411, 10, 0, 401});
  // Above +x lies the right column of +y, from its lower end upwards.
  CHECK(cube.sampled({}, {Ask::gather_cube, {1, 0.999f, 0}}) == Four{0, 1, 201, 211});
  // Below -z lies the lower... the last row of -y is at z = -1, with x the other way.
  CHECK(cube.sampled({}, {Ask::gather_cube, {0, -0.999f, -1}}) == Four{311, 310, 511, 510});
}

TEST_CASE("gradients of a direction become gradients on the face") {
  std::vector<std::vector<float>> levels;
  for (std::size_t level = 0; level < 4; ++level)
    levels.emplace_back(6 * (8 >> level) * (8 >> level), static_cast<float>(level));
  const TestImage cube({8, 8, 6}, 2, levels);
  Sampler sampler;
  sampler.mipmap = Filter::linear;
  const auto at = [&](const Four& direction, const Four& dx, const Four& dy) {
    return cube.sampled(sampler, {Ask::gradients_cube, direction, 0, dx, dy})[0];
  };
  // log2 of the C library and the square root before it.
  const auto near = [](double value) { return Approx(value).epsilon(1e-6); };
  // s = (1 - z / x) / 2: a step of 0.5 in z is 0.25 of 8 texels.
  CHECK(at({1, 0, 0}, {0, 0, 0.5f}, {}) == near(1));
  CHECK(at({1, 0, 0}, {}, {0, -1, 0}) == near(2));
  CHECK(at({0, -2, 0}, {2, 0, 0}, {0, 0, 1}) == near(2));
  // Along the direction nothing changes; beside the middle of the face it does: (z / x^2) / 2 * 4 * 8 texels.
  CHECK(at({1, 0, 0}, {1, 0, 0}, {}) == 0);
  CHECK(at({2, 0, -1}, {4, 0, 0}, {}) == near(2));
  CHECK(at({-2, 0, -1}, {-4, 0, 0}, {}) == near(2));
  // s = (1 + z / -x) / 2: (1 / 2 + 2 * 1 / 4) / 2 of 8 texels.
  CHECK(at({-2, 0, -1}, {-2, 0, 1}, {}) == near(2));
}

}  // namespace
