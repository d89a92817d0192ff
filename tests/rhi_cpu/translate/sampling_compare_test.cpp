// Gathers and comparisons of depths.

#include <cstdint>
#include <vector>

#include <doctest/doctest.h>

#include "rhi_cpu/kernel/abi.hpp"
#include "tests/rhi_cpu/translate/kernel_images.hpp"
#include "tests/rhi_cpu/translate/sampling_harness.hpp"

namespace {

using tandem::kernel::AddressMode;
using tandem::kernel::BorderColor;
using tandem::kernel::CompareOp;
using tandem::kernel::Filter;
using tandem::kernel::Sampler;
using tandem::rhi::TextureFormat;
using tandem::test::Ask;
using tandem::test::Four;
using tandem::test::TestImage;

Sampler clamped(CompareOp op = CompareOp::never, Filter filter = Filter::nearest) {
  Sampler sampler;
  for (AddressMode& each : sampler.address) each = AddressMode::clamp_to_edge;
  sampler.magnification = sampler.minification = filter;
  sampler.compare = op;
  return sampler;
}

TEST_CASE("a gather has the four texels of a linear filter, from the lower left against the clock") {
  // Component c of texel (x, y): x + 10 * y + 100 * c, in two layers 1000 apart.
  std::vector<float> texels;
  for (int layer = 0; layer < 2; ++layer)
    for (int y = 0; y < 3; ++y)
      for (int x = 0; x < 3; ++x)
        for (int c = 0; c < 4; ++c) texels.push_back(static_cast<float>(x + 10 * y + 100 * c + 1000 * layer));
  const TestImage image({3, 3, 1}, 2, {texels}, TextureFormat::rgba32_float),
      layers({3, 3, 2}, 2, {texels}, TextureFormat::rgba32_float);
  Sampler sampler = clamped();
  // Between texels 0 and 1, and 1 and 2. No filter and no level of detail changes it.
  sampler.min_lod = 5;
  const float u = 1 / 3.0f, v = 0.6f;
  CHECK(image.sampled(sampler, {Ask::gather_d2, {u, v}}) == Four{120, 121, 111, 110});
  CHECK(layers.sampled(sampler, {Ask::gather_d2_array, {u, v, 0.75f}}) == Four{1320, 1321, 1311, 1310});
  CHECK(image.sampled(sampler, {Ask::gather_shifted_d2, {u, v}}) == Four{221, 222, 212, 211});
  CHECK(image.sampled(sampler, {Ask::gather_offsets_d2, {u, v}}) == Four{10, 11, 20, 0});
  // Beyond the lower right.
  CHECK(image.sampled(sampler, {Ask::gather_d2, {1, 1}}) == Four{122, 122, 122, 122});
  for (AddressMode& each : sampler.address) each = AddressMode::repeat;
  CHECK(image.sampled(sampler, {Ask::gather_d2, {1, 1}}) == Four{102, 100, 120, 122});
  for (AddressMode& each : sampler.address) each = AddressMode::clamp_to_border;
  CHECK(image.sampled(sampler, {Ask::gather_d2, {1, 1}}) == Four{0, 0, 0, 122});
}

TEST_CASE("the eight comparisons, of the reference with the depth") {
  const TestImage image({1, 1, 1}, 2, {{0.5f}}, TextureFormat::d32_float);
  // Of references 0.25, 0.5 and 0.75.
  const float expected[8][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {1, 1, 1}};
  for (std::uint32_t op = 0; op < 8; ++op)
    for (std::size_t i = 0; i < 3; ++i) {
      CAPTURE(op);
      const float reference = 0.25f * static_cast<float>(i + 1);
      const Sampler sampler = clamped(static_cast<CompareOp>(op));
      CHECK(image.sampled(sampler, {Ask::compare_d2, {0.5f, 0.5f, reference}})[0] == expected[op][i]);
      CHECK(image.sampled(sampler, {Ask::compare_projected_d2, {1, 1, 2 * reference, 2}})[0] == expected[op][i]);
    }
}

TEST_CASE("a linear filter weighs what passes") {
  const TestImage image({2, 2, 1}, 2, {{0.1f, 0.3f, 0.5f, 0.7f}, {0.9f}}, TextureFormat::d32_float);
  Sampler sampler = clamped(CompareOp::less, Filter::linear);
  const auto at = [&](float u, float v, float reference, float detail) {
    return image.sampled(sampler, {Ask::compare_d2, {u, v, reference}, detail})[0];
  };
  CHECK(at(0.5f, 0.5f, 0.2f, 0) == 0.75f);
  CHECK(at(0.5f, 0.5f, 0.6f, 0) == 0.25f);
  CHECK(at(0.375f, 0.5f, 0.6f, 0) == 0.125f);
  CHECK(at(0.5f, 0.375f, 0.4f, 0) == 0.25f);
  CHECK(at(0.5f, 0.5f, 0.8f, 1) == 1);
  sampler.mipmap = Filter::linear;
  CHECK(at(0.5f, 0.5f, 0.6f, 0.5f) == 0.625f);
  CHECK(image.sampled(sampler, {Ask::gather_compare_d2, {0.5f, 0.5f}, 0.4f}) == Four{1, 1, 0, 0});
  CHECK(image.sampled(sampler, {Ask::gather_compare_d2, {0.5f, 0.5f}, 0.2f}) == Four{1, 1, 1, 0});
  CHECK(image.sampled(sampler, {Ask::gather_compare_shifted_d2, {0.5f, 0.5f}, 0.6f}) == Four{0, 1, 1, 0});
}

TEST_CASE("layers, cubes and borders of depths") {
  const TestImage lines({1, 2, 1}, 1, {{0.25f, 0.75f}}, TextureFormat::d32_float);
  const Sampler less = clamped(CompareOp::less);
  CHECK(lines.sampled(less, {Ask::compare_d1_array, {0.5f, 0, 0.5f}})[0] == 0);
  CHECK(lines.sampled(less, {Ask::compare_d1_array, {0.5f, 1, 0.5f}})[0] == 1);
  const TestImage cube({1, 1, 6}, 2, {{0.1f, 0.2f, 0.3f, 0.4f, 0.5f, 0.6f}}, TextureFormat::d32_float);
  CHECK(cube.sampled(less, {Ask::compare_cube, {0, -1, 0, 0.35f}})[0] == 1);
  CHECK(cube.sampled(less, {Ask::compare_cube, {0, 1, 0, 0.35f}})[0] == 0);
  const TestImage cubes({1, 1, 12}, 2, {{0, 0, 0, 0, 0, 0, 0.1f, 0.2f, 0.3f, 0.4f, 0.5f, 0.6f}},
                        TextureFormat::d32_float);
  // To the right of +z lies +x, above it +y, and in the corner the mean of what passes.
  CHECK(cubes.sampled(less, {Ask::gather_compare_cube_array, {0.01f, 0.01f, 1, 1}, 0.25f}) == Four{1, 0, 2 / 3.0f, 1});
  Sampler border = clamped(CompareOp::less);
  for (AddressMode& each : border.address) each = AddressMode::clamp_to_border;
  CHECK(lines.sampled(border, {Ask::compare_d1_array, {2, 1, 0.5f}})[0] == 0);
  border.border = BorderColor::float_opaque_white;
  CHECK(lines.sampled(border, {Ask::compare_d1_array, {2, 1, 0.5f}})[0] == 1);
}

TEST_CASE("a reference is clamped for depths in fixed point only") {
  std::vector<std::uint16_t> fixed = {65535};
  const auto image = tandem::test::image_of(fixed, TextureFormat::d16_unorm, {1, 1, 1});
  const TestImage floating({1, 1, 1}, 2, {{1}}, TextureFormat::d32_float);
  const tandem::test::Query query = {Ask::compare_d2, {0.5f, 0.5f, 1.5f}};
  CHECK(tandem::test::sampled(image, clamped(CompareOp::less_or_equal), query)[0] == 1);
  CHECK(floating.sampled(clamped(CompareOp::less_or_equal), query)[0] == 0);
}

}  // namespace
