// Samplers, against Vulkan's chapter "Image Operations": wrapping, filters, levels of detail, layers, borders.

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include <doctest/doctest.h>

#include "rhi_cpu/kernel/abi.hpp"
#include "tests/rhi_cpu/translate/sampling_harness.hpp"

namespace {

using doctest::Approx;
using tandem::kernel::AddressMode;
using tandem::kernel::BorderColor;
using tandem::kernel::Filter;
using tandem::kernel::Sampler;
using tandem::rhi::TextureFormat;
using tandem::test::Ask;
using tandem::test::Four;
using tandem::test::Query;
using tandem::test::TestImage;

constexpr AddressMode modes[] = {AddressMode::repeat, AddressMode::mirrored_repeat, AddressMode::clamp_to_edge,
                                 AddressMode::clamp_to_border, AddressMode::mirror_clamp_to_edge};

Sampler sampler_with(AddressMode mode, Filter filter = Filter::nearest) {
  Sampler sampler;
  for (AddressMode& each : sampler.address) each = mode;
  sampler.magnification = sampler.minification = filter;
  return sampler;
}

TEST_CASE("the five address modes, nearest") {
  const TestImage line({4, 1, 1}, 1, {{0, 1, 2, 3}});
  // Of texels -6 to 9; 7 stands for the border.
  const std::array<std::array<float, 16>, 5> expected = {{
      {2, 3, 0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3, 0, 1},
      {2, 3, 3, 2, 1, 0, 0, 1, 2, 3, 3, 2, 1, 0, 0, 1},
      {0, 0, 0, 0, 0, 0, 0, 1, 2, 3, 3, 3, 3, 3, 3, 3},
      {7, 7, 7, 7, 7, 7, 0, 1, 2, 3, 7, 7, 7, 7, 7, 7},
      {3, 3, 3, 2, 1, 0, 0, 1, 2, 3, 3, 3, 3, 3, 3, 3},
  }};
  for (std::size_t mode = 0; mode < 5; ++mode) {
    Sampler sampler = sampler_with(modes[mode]);
    sampler.border = BorderColor::float_opaque_white;
    for (int i = -6; i < 10; ++i) {
      CAPTURE(mode);
      CAPTURE(i);
      float texel = expected[mode][static_cast<std::size_t>(i + 6)];
      if (texel == 7) texel = 1;
      // A texel's interior, near both ends: (i + 1/16) / 4 and (i + 15/16) / 4 are floats.
      for (const float inside : {0.0625f, 0.9375f})
        CHECK(line.sampled(sampler, {Ask::level_d1, {(static_cast<float>(i) + inside) / 4}})[0] == texel);
    }
  }
}

TEST_CASE("the five address modes, linear") {
  const TestImage line({4, 1, 1}, 1, {{16, 32, 64, 128}});
  const auto at = [&](AddressMode mode, float u, BorderColor border = BorderColor::float_transparent_black) {
    Sampler sampler = sampler_with(mode, Filter::linear);
    sampler.border = border;
    return line.sampled(sampler, {Ask::level_d1, {u}})[0];
  };
  for (const AddressMode mode : modes) {
    CHECK(at(mode, 0.125f) == 16);   // the middle of a texel
    CHECK(at(mode, 0.25f) == 24);    // between two
    CHECK(at(mode, 0.3125f) == 28);  // 1.25 texels: a quarter before the middle of the second
  }
  // u = 0 lies between texels -1 and 0, u = 1/16 a quarter of a texel behind.
  CHECK(at(AddressMode::repeat, 0) == 72);
  CHECK(at(AddressMode::repeat, 0.0625f) == 128 * 0.25f + 16 * 0.75f);
  CHECK(at(AddressMode::repeat, 1) == 72);
  CHECK(at(AddressMode::mirrored_repeat, 0) == 16);
  CHECK(at(AddressMode::mirrored_repeat, -0.25f) == 24);
  CHECK(at(AddressMode::clamp_to_edge, -5) == 16);
  CHECK(at(AddressMode::clamp_to_edge, 1) == 128);
  CHECK(at(AddressMode::clamp_to_border, 0) == 8);
  CHECK(at(AddressMode::clamp_to_border, 0, BorderColor::float_opaque_white) == 8.5f);
  CHECK(at(AddressMode::clamp_to_border, 1.0625f) == 32);
  CHECK(at(AddressMode::mirror_clamp_to_edge, -0.25f) == 24);
  CHECK(at(AddressMode::mirror_clamp_to_edge, 2) == 128);
}

TEST_CASE("each side has its own address mode") {
  std::vector<float> numbers(27);
  for (std::size_t i = 0; i < 27; ++i) numbers[i] = static_cast<float>(i % 3 + 10 * (i / 3 % 3) + 100 * (i / 9));
  const TestImage cube({3, 3, 3}, 3, {numbers});
  Sampler sampler;
  sampler.address[0] = AddressMode::repeat;
  sampler.address[1] = AddressMode::clamp_to_edge;
  sampler.address[2] = AddressMode::mirrored_repeat;
  // Texel (4, 4, 4).
  CHECK(cube.sampled(sampler, {Ask::level_d3, {1.5f, 1.5f, 1.5f}})[0] == 121);
}

TEST_CASE("linear filters of two and three sides") {
  const TestImage square({2, 2, 1}, 2, {{1, 2, 3, 4}});
  const Sampler linear = sampler_with(AddressMode::clamp_to_edge, Filter::linear);
  // A quarter between the columns, three quarters between the rows.
  CHECK(square.sampled(linear, {Ask::level_d2, {0.375f, 0.625f}})[0] == 2.75f);
  const TestImage cube({2, 2, 2}, 3, {{0, 1, 10, 11, 100, 101, 110, 111}});
  CHECK(cube.sampled(linear, {Ask::level_d3, {0.375f, 0.5f, 0.625f}})[0] == 80.25f);
}

TEST_CASE("coordinates that are texels") {
  const TestImage square({4, 2, 1}, 2, {{0, 1, 2, 3, 10, 11, 12, 13}});
  Sampler sampler = sampler_with(AddressMode::clamp_to_edge);
  sampler.unnormalized = 1;
  CHECK(square.sampled(sampler, {Ask::level_d2, {2.5f, 1.25f}})[0] == 12);
  sampler.magnification = sampler.minification = Filter::linear;
  CHECK(square.sampled(sampler, {Ask::level_d2, {2, 1}})[0] == 6.5f);
  CHECK(square.sampled(sampler, {Ask::level_d2, {100, 100}})[0] == 13);
}

/// Each level holds its number.
TestImage numbered_levels(std::array<std::uint32_t, 3> size, std::uint32_t sides, std::uint32_t count) {
  std::vector<std::vector<float>> levels;
  for (std::uint32_t level = 0; level < count; ++level) {
    std::size_t texels = 1;
    for (std::uint32_t i = 0; i < 3; ++i) texels *= i < sides ? std::max(size[i] >> level, 1u) : size[i];
    levels.emplace_back(texels, static_cast<float>(level));
  }
  return TestImage(size, sides, levels);
}

TEST_CASE("levels: nearest, linear, bias and limits") {
  const TestImage image = numbered_levels({8, 8, 1}, 2, 4);
  const auto at = [&](const Sampler& sampler, float detail) {
    return image.sampled(sampler, {Ask::level_d2, {0.3f, 0.7f}, detail})[0];
  };
  Sampler sampler;
  // Vulkan prefers that a level and a half is the finer one.
  CHECK(at(sampler, 0.5f) == 0);
  CHECK(at(sampler, 0.75f) == 1);
  CHECK(at(sampler, 1.5f) == 1);
  CHECK(at(sampler, -3) == 0);
  CHECK(at(sampler, 17) == 3);
  sampler.mipmap = Filter::linear;
  for (const float detail : {0.0f, 0.25f, 1.0f, 1.5f, 2.75f, 3.0f}) CHECK(at(sampler, detail) == detail);
  CHECK(at(sampler, -1) == 0);
  CHECK(at(sampler, 9) == 3);
  sampler.lod_bias = 0.5f;
  CHECK(at(sampler, 0.25f) == 0.75f);
  sampler.min_lod = 1.25f;
  sampler.max_lod = 2.5f;
  CHECK(at(sampler, 0) == 1.25f);
  CHECK(at(sampler, 0.5f) == 1.25f);
  CHECK(at(sampler, 1.5f) == 2);
  CHECK(at(sampler, 2.5f) == 2.5f);
}

TEST_CASE("a filter per direction, and levels of their own size") {
  const TestImage line({4, 1, 1}, 1, {{0, 8, 16, 24}, {100, 200}, {1000}});
  Sampler sampler = sampler_with(AddressMode::clamp_to_edge);
  sampler.minification = Filter::linear;
  const auto at = [&](float u, float detail) { return line.sampled(sampler, {Ask::level_d1, {u}, detail})[0]; };
  CHECK(at(0.25f, 0) == 8);      // level of detail 0 is magnification
  CHECK(at(0.25f, 0.25f) == 4);  // minification, level 0
  CHECK(at(0.5f, 1) == 150);
  CHECK(at(0.5f, 2) == 1000);
  sampler.minification = Filter::nearest;
  sampler.magnification = Filter::linear;
  CHECK(at(0.25f, 0) == 4);
  CHECK(at(0.25f, 1) == 100);
  sampler.mipmap = Filter::linear;
  CHECK(at(0.75f, 1.25f) == 400);
}

TEST_CASE("the level of detail of gradients is log2 of the longer one in texels") {
  Sampler sampler;
  sampler.mipmap = Filter::linear;
  const TestImage line = numbered_levels({8, 1, 1}, 1, 4), plane = numbered_levels({8, 4, 1}, 2, 4),
                  cube = numbered_levels({8, 4, 4}, 3, 4);
  // log2 of the C library and the square root before it: a few roundings.
  const auto near = [](double value) { return Approx(value).epsilon(1e-6); };
  CHECK(line.sampled(sampler, {Ask::gradients_d1, {0.5f}, 0, {0.25f}, {-0.5f}})[0] == near(2));
  CHECK(plane.sampled(sampler, {Ask::gradients_d2, {0.5f, 0.5f}, 0, {0.25f, 0}, {0, 0.25f}})[0] == near(1));
  CHECK(plane.sampled(sampler, {Ask::gradients_d2, {0.5f, 0.5f}, 0, {0.375f, -1}, {0, 0.25f}})[0] ==
        near(std::log2(5.0)));
  CHECK(plane.sampled(sampler, {Ask::gradients_d2, {0.5f, 0.5f}, 0, {}, {}})[0] == 0);
  CHECK(plane.sampled(sampler, {Ask::limited_gradients_d2, {0.5f, 0.5f}, 1.5f, {0.25f, 0}, {}})[0] == 1.5f);
  CHECK(plane.sampled(sampler, {Ask::limited_gradients_d2, {0.5f, 0.5f}, 0.5f, {0.25f, 0}, {}})[0] == near(1));
  // (2, 3, 6) texels long.
  CHECK(cube.sampled(sampler, {Ask::gradients_d3, {}, 0, {0.25f, 0.75f, 1.5f}, {0.25f, 0, 0}})[0] ==
        near(std::log2(7.0)));
}

TEST_CASE("layers are rounded to even and clamped") {
  const Sampler sampler;
  const TestImage lines({2, 3, 1}, 1, {{0, 1, 10, 11, 20, 21}, {5, 15, 25}}),
      planes({2, 1, 3}, 2, {{0, 1, 10, 11, 20, 21}, {5, 15, 25}});
  const std::array<std::array<float, 2>, 7> layers = {
      {{-3, 0}, {0.5f, 0}, {0.75f, 10}, {1.25f, 10}, {1.5f, 20}, {2.5f, 20}, {99, 20}}};
  for (const auto& [layer, first] : layers) {
    CAPTURE(layer);
    CHECK(lines.sampled(sampler, {Ask::level_d1_array, {0.75f, layer}})[0] == first + 1);
    CHECK(planes.sampled(sampler, {Ask::level_d2_array, {0.75f, 0.5f, layer}})[0] == first + 1);
    CHECK(lines.sampled(sampler, {Ask::level_d1_array, {0.75f, layer}, 1})[0] == first + 5);
    CHECK(planes.sampled(sampler, {Ask::level_d2_array, {0.75f, 0.5f, layer}, 1})[0] == first + 5);
  }
}

TEST_CASE("a border has the components of its format") {
  const TestImage one({1, 1, 1}, 2, {{9}}), four({1, 1, 1}, 2, {{9, 9, 9, 9}}, TextureFormat::rgba32_float),
      two({1, 1, 1}, 2, {{9, 9}}, TextureFormat::rg32_float);
  Sampler sampler = sampler_with(AddressMode::clamp_to_border);
  const Query outside = {Ask::level_d2, {-1, 0.5f}};
  sampler.border = BorderColor::float_transparent_black;
  CHECK(four.sampled(sampler, outside) == Four{0, 0, 0, 0});
  CHECK(one.sampled(sampler, outside) == Four{0, 0, 0, 1});
  sampler.border = BorderColor::float_opaque_black;
  CHECK(four.sampled(sampler, outside) == Four{0, 0, 0, 1});
  sampler.border = BorderColor::float_opaque_white;
  CHECK(four.sampled(sampler, outside) == Four{1, 1, 1, 1});
  CHECK(two.sampled(sampler, outside) == Four{1, 1, 0, 1});
  CHECK(four.sampled(sampler, {Ask::level_d2, {0.5f, 0.5f}}) == Four{9, 9, 9, 9});
}

TEST_CASE("offsets are texels of the level; homogeneous coordinates are divided") {
  std::vector<float> numbers(16);
  for (std::size_t i = 0; i < 16; ++i) numbers[i] = static_cast<float>(i % 4 + 10 * (i / 4));
  const TestImage image({4, 4, 1}, 2, {numbers, {100, 101, 110, 111}});
  const Sampler sampler;
  // Texel (1, 1) of level 0 and (0, 0) of level 1, and (1, -2) from there.
  CHECK(image.sampled(sampler, {Ask::shifted_d2, {0.375f, 0.375f}})[0] == 32);
  CHECK(image.sampled(sampler, {Ask::shifted_d2, {0.25f, 0.25f}, 1})[0] == 101);
  CHECK(image.sampled(sampler, {Ask::projected_d2, {1.5f, 3.5f, 4}})[0] == 31);
  const TestImage cube({2, 2, 2}, 3, {{0, 1, 10, 11, 100, 101, 110, 111}});
  CHECK(cube.sampled(sampler, {Ask::projected_d3, {3, 1, 3, 4}})[0] == 101);
}

TEST_CASE("coordinates that are no numbers, or far away, read some texel") {
  const TestImage plane({2, 2, 1}, 2, {{1, 1, 1, 1}}), faces({1, 1, 6}, 2, {{1, 1, 1, 1, 1, 1}});
  const float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
  for (const AddressMode mode : modes) {
    for (const float far : {nan, infinity, -infinity, 1e30f, -1e30f, 2e9f}) {
      CAPTURE(far);
      Sampler sampler = sampler_with(mode);
      sampler.border = BorderColor::float_opaque_white;
      CHECK(plane.sampled(sampler, {Ask::level_d2, {far, far}, far})[0] == 1);
      CHECK(plane.sampled(sampler, {Ask::gradients_d2, {0, 0}, 0, {far, 0}, {far, far}})[0] == 1);
      CHECK(faces.sampled(sampler, {Ask::level_cube, {far, far, far}, far})[0] == 1);
      CHECK(faces.sampled(sampler, {Ask::level_cube_array, {far, 1, 1, far}})[0] == 1);
      sampler.magnification = sampler.minification = Filter::linear;
      plane.sampled(sampler, {Ask::level_d2, {far, far}, far});
      faces.sampled(sampler, {Ask::level_cube, {far, far, far}, far});
    }
  }
}

}  // namespace
