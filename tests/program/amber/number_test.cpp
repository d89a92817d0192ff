#include "program/amber/value/number.hpp"

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "program/amber/value/data_type.hpp"
#include "program/amber/value/values.hpp"

using namespace tandem::program;
using namespace tandem::program::amber;

namespace {

std::string stored(const char* word, ScalarType scalar) {
  const auto number = parse_number(word);
  REQUIRE(number);
  if (!fits(*number, scalar)) return "no";
  std::array<std::byte, 8> bytes = {};
  write(bytes, scalar, *number);
  return text_of(read(bytes, scalar), scalar);
}

TEST_CASE("a number keeps its value in memory") {
  CHECK(stored("-3", ScalarType::int8) == "-3");
  CHECK(stored("0xff", ScalarType::int8) == "-1");
  CHECK(stored("-1", ScalarType::uint16) == "65535");
  CHECK(stored("18446744073709551615", ScalarType::uint64) == "18446744073709551615");
  CHECK(stored("-9223372036854775808", ScalarType::int64) == "-9223372036854775808");
  CHECK(stored("256", ScalarType::uint8) == "no");
  CHECK(stored("-32769", ScalarType::int16) == "no");
  CHECK(stored("1.5", ScalarType::int32) == "no");
  CHECK(stored("1e3", ScalarType::float32) == "1000");
  CHECK(stored("-0", ScalarType::float64) == "-0");
  CHECK(stored("-0.0", ScalarType::float16) == "-0");
  CHECK(stored("nan", ScalarType::float32) == "nan");
}

TEST_CASE("a word that is no number is none") {
  for (const char* word : {"", "-", "x", "1x", "0x", "1.2.3", "--1", "18446744073709551616", "-9223372036854775809"})
    CHECK_MESSAGE(!parse_number(word), word);
}

TEST_CASE("16-bit floats are rounded to nearest even") {
  for (std::uint32_t bits = 0; bits < 0x10000; ++bits) {
    const double value = from_half(static_cast<std::uint16_t>(bits));
    if (std::isnan(value)) continue;
    if (to_half(value) != bits) FAIL("bits " << bits);
    const double next = from_half(static_cast<std::uint16_t>(bits + 1));
    if (std::isnan(next) || std::isinf(next) || (bits & 0x7fff) == 0x7fff) continue;
    if (to_half((value + next) / 2) != bits + (bits & 1)) FAIL("half way after bits " << bits);
  }
  CHECK(to_half(65519.9) == 0x7bff);
  CHECK(to_half(65520) == 0x7c00);
  CHECK(to_half(1e300) == 0x7c00);
  CHECK(to_half(-std::numeric_limits<double>::infinity()) == 0xfc00);
  CHECK(to_half(0x1p-25) == 0);
  CHECK(to_half(0x1.8p-25) == 1);
}

LaidOut laid_out(const char* word, Layout layout) {
  const auto type = parse_data_type(word);
  REQUIRE_MESSAGE(type, word);
  return lay_out(*type, layout);
}

TEST_CASE("items lie as GLSL's layouts say") {
  CHECK(laid_out("vec3<float>", Layout::std430).stride == 16);
  CHECK(laid_out("vec3<float>", Layout::scalar).stride == 12);
  CHECK(laid_out("float", Layout::std140).stride == 4);
  CHECK(laid_out("float[]", Layout::std140).stride == 16);
  CHECK(laid_out("float[]", Layout::std430).stride == 4);
  CHECK(laid_out("mat2x2<float>", Layout::std430).stride == 16);
  CHECK(laid_out("mat2x2<float>", Layout::std140).stride == 32);
  CHECK(laid_out("mat3x3<float16>", Layout::std430).stride == 24);
  CHECK(laid_out("vec4<double>", Layout::std430).stride == 32);
  CHECK(laid_out("int8[3]", Layout::std140).stride == 48);
  CHECK(laid_out("R8G8B8A8_UNORM", Layout::std430).stride == 4);
  const LaidOut matrix = laid_out("mat3x2<float>", Layout::std140);
  const Values values(matrix.type, matrix.stride);
  CHECK(values.scalars_per_element() == 6);
  CHECK(values.place(2).offset == 16);
  CHECK(values.place(7).offset == 52);
}

TEST_CASE("formats have components, and a number where they are packed") {
  const auto texel = parse_texel("A2B10G10R10_UNORM_PACK32");
  REQUIRE(texel);
  CHECK(texel->format == tandem::rhi::TextureFormat::rgb10a2_unorm);
  const std::array<std::byte, 4> bytes = {std::byte{0xff}, std::byte{0x03}, std::byte{0}, std::byte{0x40}};
  CHECK(value_of(texel->components[3], bytes) == 1.0);
  CHECK(value_of(texel->components[0], bytes) == doctest::Approx(1.0 / 3));
  CHECK(parse_texel("R8G8B8A8_SRGB")->format == tandem::rhi::TextureFormat::rgba8_srgb);
  CHECK(parse_texel("B8G8R8A8_UNORM")->format == tandem::rhi::TextureFormat::bgra8_unorm);
  CHECK(parse_texel("B10G11R11_UFLOAT_PACK32")->format == tandem::rhi::TextureFormat::rg11b10_float);
  CHECK(parse_texel("D32_SFLOAT")->format == tandem::rhi::TextureFormat::d32_float);
  CHECK(parse_texel("R32G32_SFLOAT")->format == tandem::rhi::TextureFormat::rg32_float);
  CHECK(parse_texel("R64_SINT")->format == tandem::rhi::TextureFormat::r64_sint);
  CHECK(!parse_texel("R8G8B8A8_SSCALED")->format);
  CHECK(!parse_texel("D24_UNORM_S8_UINT")->format);
  for (const char* name : {"R8", "R8_", "_UNORM", "R8G16_UNORM", "Q8_UNORM", "R0_UINT", "R8G8B8A8", "R999_UINT"})
    CHECK_MESSAGE(!parse_texel(name), name);
}

}  // namespace
