#include "program/data/texels.hpp"

#include <doctest/doctest.h>

#include <vector>

using namespace tandem;
using namespace tandem::program;
using rhi::TextureFormat;

namespace {

TEST_CASE("a texture is rows of texels, of several levels a structure") {
  rhi::TextureDesc desc{.format = TextureFormat::rgba8_unorm, .size = {3, 2, 1}, .label = {}};
  CHECK(describe(texture_type(desc)) == "u8vec4[2][3]");
  CHECK(path_of(texture_type(desc), 24, 23) == "[1][2].w");
  desc.format = TextureFormat::rg11b10_float;
  CHECK(describe(texture_type(desc)) == "uint[2][3]");
  desc = {.dimension = rhi::TextureDimension::d2_array,
          .format = TextureFormat::r16_float,
          .size = {3, 3, 2},
          .level_count = 2,
          .label = {}};
  const ValueType type = texture_type(desc);
  CHECK(describe(type.members[0].type) == "float16_t[2][3][3]");
  CHECK(describe(type.members[1].type) == "float16_t[2][1][1]");
  CHECK(path_of(type, type.size, 19) == "level1[1][0][0]");
  CHECK(place_of(type, type.size, 18).offset == 36);
  CHECK(type.size == 40);
}

void check_round_trip(TextureFormat format, const std::vector<float>& rgba, const std::vector<float>& expected) {
  CAPTURE(rhi::info_of(format).name);
  CHECK(rgba_of(format, texels_of(format, rgba)) == expected);
}

TEST_CASE("texels are made of colours and become colours again") {
  const std::vector<float> colour = {0.0f, 1.0f, 2.0f, -0.5f};
  check_round_trip(TextureFormat::rgba32_float, colour, colour);
  check_round_trip(TextureFormat::rgba16_float, colour, colour);
  check_round_trip(TextureFormat::rg32_float, colour, {0, 1, 0, 1});
  check_round_trip(TextureFormat::rgba8_unorm, colour, {0, 1, 1, 0});
  check_round_trip(TextureFormat::rgba8_snorm, colour, {0, 1, 1, -64.0f / 127.0f});
  check_round_trip(TextureFormat::rgba8_uint, colour, {0, 1, 2, 0});
  check_round_trip(TextureFormat::rgba32_sint, {0, -3.5f, 2, 1}, {0, -3, 2, 1});
  check_round_trip(TextureFormat::r8_unorm, {0.5f, 0, 0, 0}, {128.0f / 255.0f, 0, 0, 1});
  check_round_trip(TextureFormat::d16_unorm, {0.5f, 0, 0, 0}, {32768.0f / 65535.0f, 0, 0, 1});
  const std::vector<std::byte> blue_first = texels_of(TextureFormat::bgra8_unorm, std::vector<float>{1, 0, 0, 1});
  CHECK(blue_first[2] == std::byte{255});
  check_round_trip(TextureFormat::bgra8_unorm, {1, 0, 0, 1}, {1, 0, 0, 1});
}

}  // namespace
