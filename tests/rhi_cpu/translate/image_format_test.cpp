// Storage images of every format.

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <string>
#include <vector>

#include <doctest/doctest.h>
#include <fmt/format.h>

#include "tests/rhi_cpu/translate/kernel_harness.hpp"
#include "tests/rhi_cpu/translate/kernel_images.hpp"

namespace {

using tandem::kernel::Image;
using tandem::kernel::Resource;
using tandem::rhi::TextureFormat;
using tandem::test::image_of;
using tandem::test::Kernel;
using tandem::test::resource;
using tandem::test::resource_of;

/// A texel of one format: a value in GLSL that it is written from, its bytes, and the components that are read.
struct Case {
  std::string layout;
  TextureFormat format;
  std::string kind;  ///< prefix of the image's type
  std::string value;
  std::vector<std::uint64_t> texel;  ///< numbers of `width` bytes
  std::size_t width;
  std::vector<std::uint64_t> components;  ///< bits
};

std::vector<std::uint64_t> floats(std::initializer_list<float> values) {
  std::vector<std::uint64_t> bits;
  for (const float value : values) bits.push_back(std::bit_cast<std::uint32_t>(value));
  return bits;
}

// 0.5 * 255 = 127.5 lies in the middle, and goes to the even 128; NaN becomes 0. Integers keep their low bits. What a
// format lacks is read as 0, alpha as 1.
const std::string unit = "0.5, 2.0, -1.0, uintBitsToFloat(0x7fc00000)", signed_unit = "-1.0, 1.0, -3.0, 0.5";
const Case cases[] = {
    {"r8", TextureFormat::r8_unorm, "", unit, {128}, 1, floats({128 / 255.0f, 0, 0, 1})},
    {"r8_snorm", TextureFormat::r8_snorm, "", signed_unit, {0x81}, 1, floats({-1, 0, 0, 1})},
    {"r8ui", TextureFormat::r8_uint, "u", "255u, 1u, 2u, 3u", {255}, 1, {255, 0, 0, 1}},
    {"r8i", TextureFormat::r8_sint, "i", "-2, 1, 2, 3", {0xfe}, 1, {0xfffffffe, 0, 0, 1}},
    {"rg8", TextureFormat::rg8_unorm, "", unit, {128, 255}, 1, floats({128 / 255.0f, 1, 0, 1})},
    {"rg8_snorm", TextureFormat::rg8_snorm, "", signed_unit, {0x81, 0x7f}, 1, floats({-1, 1, 0, 1})},
    {"rg8ui", TextureFormat::rg8_uint, "u", "255u, 257u, 2u, 3u", {255, 1}, 1, {255, 1, 0, 1}},
    {"rg8i", TextureFormat::rg8_sint, "i", "-2, 127, 2, 3", {0xfe, 127}, 1, {0xfffffffe, 127, 0, 1}},
    {"rgba8", TextureFormat::rgba8_unorm, "", unit, {128, 255, 0, 0}, 1, floats({128 / 255.0f, 1, 0, 0})},
    {"rgba8_snorm",
     TextureFormat::rgba8_snorm,
     "",
     signed_unit,
     {0x81, 0x7f, 0x81, 0x40},
     1,
     floats({-1, 1, -1, 64 / 127.0f})},
    {"rgba8ui", TextureFormat::rgba8_uint, "u", "1u, 255u, 257u, 3u", {1, 255, 1, 3}, 1, {1, 255, 1, 3}},
    {"rgba8i",
     TextureFormat::rgba8_sint,
     "i",
     "-1, 127, -128, 3",
     {255, 127, 128, 3},
     1,
     {0xffffffff, 127, 0xffffff80, 3}},
    // 0.5 * 65535 = 32767.5, to the even 32768; 0.5 * 32767 = 16383.5, to the even 16384.
    {"r16", TextureFormat::r16_unorm, "", unit, {32768}, 2, floats({32768 / 65535.0f, 0, 0, 1})},
    {"r16_snorm", TextureFormat::r16_snorm, "", "0.5, 0, 0, 0", {16384}, 2, floats({16384 / 32767.0f, 0, 0, 1})},
    {"r16ui", TextureFormat::r16_uint, "u", "65535u, 1u, 2u, 3u", {65535}, 2, {65535, 0, 0, 1}},
    {"r16i", TextureFormat::r16_sint, "i", "-2, 1, 2, 3", {0xfffe}, 2, {0xfffffffe, 0, 0, 1}},
    {"r16f", TextureFormat::r16_float, "", "-1.5, 1, 2, 3", {0xbe00}, 2, floats({-1.5f, 0, 0, 1})},
    {"rg16", TextureFormat::rg16_unorm, "", unit, {32768, 65535}, 2, floats({32768 / 65535.0f, 1, 0, 1})},
    {"rg16_snorm", TextureFormat::rg16_snorm, "", signed_unit, {0x8001, 0x7fff}, 2, floats({-1, 1, 0, 1})},
    {"rg16ui", TextureFormat::rg16_uint, "u", "65535u, 65537u, 2u, 3u", {65535, 1}, 2, {65535, 1, 0, 1}},
    {"rg16i", TextureFormat::rg16_sint, "i", "-2, 7, 2, 3", {0xfffe, 7}, 2, {0xfffffffe, 7, 0, 1}},
    {"rg16f", TextureFormat::rg16_float, "", "-1.5, 0.25, 2, 3", {0xbe00, 0x3400}, 2, floats({-1.5f, 0.25f, 0, 1})},
    {"rgba16", TextureFormat::rgba16_unorm, "", unit, {32768, 65535, 0, 0}, 2, floats({32768 / 65535.0f, 1, 0, 0})},
    {"rgba16_snorm",
     TextureFormat::rgba16_snorm,
     "",
     signed_unit,
     {0x8001, 0x7fff, 0x8001, 16384},
     2,
     floats({-1, 1, -1, 16384 / 32767.0f})},
    {"rgba16ui", TextureFormat::rgba16_uint, "u", "1u, 65535u, 2u, 3u", {1, 65535, 2, 3}, 2, {1, 65535, 2, 3}},
    {"rgba16i",
     TextureFormat::rgba16_sint,
     "i",
     "-1, 2, -32768, 3",
     {0xffff, 2, 0x8000, 3},
     2,
     {0xffffffff, 2, 0xffff8000, 3}},
    {"rgba16f",
     TextureFormat::rgba16_float,
     "",
     "1.0, -2.0, 65504.0, 0.5",
     {0x3c00, 0xc000, 0x7bff, 0x3800},
     2,
     floats({1, -2, 65504, 0.5f})},
    {"r32ui", TextureFormat::r32_uint, "u", "4000000000u, 1u, 2u, 3u", {4000000000u}, 4, {4000000000u, 0, 0, 1}},
    {"r32i", TextureFormat::r32_sint, "i", "-5, 1, 2, 3", {0xfffffffb}, 4, {0xfffffffb, 0, 0, 1}},
    {"r32f", TextureFormat::r32_float, "", "1.5, 1, 2, 3", floats({1.5f}), 4, floats({1.5f, 0, 0, 1})},
    {"rg32ui", TextureFormat::rg32_uint, "u", "7u, 8u, 2u, 3u", {7, 8}, 4, {7, 8, 0, 1}},
    {"rg32i", TextureFormat::rg32_sint, "i", "-7, 8, 2, 3", {0xfffffff9, 8}, 4, {0xfffffff9, 8, 0, 1}},
    {"rg32f", TextureFormat::rg32_float, "", "7, 8, 2, 3", floats({7, 8}), 4, floats({7, 8, 0, 1})},
    {"rgba32ui", TextureFormat::rgba32_uint, "u", "7u, 8u, 9u, 10u", {7, 8, 9, 10}, 4, {7, 8, 9, 10}},
    {"rgba32i", TextureFormat::rgba32_sint, "i", "-1, 8, 9, 10", {0xffffffff, 8, 9, 10}, 4, {0xffffffff, 8, 9, 10}},
    {"rgba32f", TextureFormat::rgba32_float, "", "7, 8, 9, 0.1", floats({7, 8, 9, 0.1f}), 4, floats({7, 8, 9, 0.1f})},
    {"r64ui",
     TextureFormat::r64_uint,
     "u64",
     "0xfedcba9876543210ul, 1ul, 2ul, 3ul",
     {0xfedcba9876543210u},
     8,
     {0xfedcba9876543210u, 0, 0, 1}},
    {"r64i",
     TextureFormat::r64_sint,
     "i64",
     "-2l, 1l, 2l, 3l",
     {0xfffffffffffffffeu},
     8,
     {0xfffffffffffffffeu, 0, 0, 1}},
    // 0.5 * 1023 = 511.5, to the even 512; 0.7 * 3 = 2.1.
    {"rgb10_a2",
     TextureFormat::rgb10a2_unorm,
     "",
     "0.5, 2.0, -1.0, 0.7",
     {512u | 1023u << 10 | 2u << 30},
     4,
     floats({512 / 1023.0f, 1, 0, 2 / 3.0f})},
    {"rgb10_a2ui",
     TextureFormat::rgb10a2_uint,
     "u",
     "1023u, 1025u, 512u, 6u",
     {1023u | 1u << 10 | 512u << 20 | 2u << 30},
     4,
     {1023, 1, 512, 2}},
    // 1 + 63.9 / 64, towards zero: exponent 15, fraction 63; what is negative becomes 0; 3 = 2^1 * 1.5: exponent 16,
    // fraction 16 of 32.
    {"r11f_g11f_b10f",
     TextureFormat::rg11b10_float,
     "",
     "1.9984375, -5.0, 3.0, 0.5",
     {(15u << 6 | 63u) | (16u << 5 | 16u) << 22},
     4,
     floats({1.984375f, 0, 3, 1})},
    // The largest finite number of 11 bits; infinity; 2^-16 = 2^-14 * 8 / 32.
    {"r11f_g11f_b10f",
     TextureFormat::rg11b10_float,
     "",
     "1e9, uintBitsToFloat(0x7f800000), 1.52587890625e-05, 0",
     {0x7bfu | 0x7c0u << 11 | 8u << 22},
     4,
     floats({65024, INFINITY, 0x1p-16f, 1})},
    // No shader names these.
    {"", TextureFormat::bgra8_unorm, "", "0.5, 2.0, -1.0, 1.0", {0, 255, 128, 255}, 1, floats({128 / 255.0f, 1, 0, 1})},
    {"", TextureFormat::d16_unorm, "", unit, {32768}, 2, floats({32768 / 65535.0f, 0, 0, 1})},
    {"", TextureFormat::d32_float, "", "0.75, 1, 1, 1", floats({0.75f}), 4, floats({0.75f, 0, 0, 1})},
    // 0.5 as sRGB: 1.055 * 0.5^(1 / 2.4) - 0.055 = 0.735357, which is 187.5 of 255; 188 is 0.5028865 again.
    {"",
     TextureFormat::rgba8_srgb,
     "",
     "0.5, 1.0, 0.0, 0.5",
     {188, 255, 0, 128},
     1,
     floats({0.50288647f, 1, 0, 128 / 255.0f})},
};

std::vector<std::uint8_t> bytes_of(const Case& each) {
  std::vector<std::uint8_t> bytes;
  for (const std::uint64_t number : each.texel)
    for (std::size_t i = 0; i < each.width; ++i) bytes.push_back(static_cast<std::uint8_t>(number >> (8 * i)));
  return bytes;
}

/// A shader that writes texel (1, 0) of an image of each case, and reads (0, 1).
std::string format_shader(bool named) {
  std::string declarations =
      "#extension GL_EXT_shader_image_load_formatted : require\n"
      "#extension GL_EXT_shader_image_int64 : require\n"
      "#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require\nlayout(local_size_x = 1) in;\n"
      "layout(binding = 0) buffer Result { u64vec4 result[]; };\n";
  std::string statements;
  int i = 0;
  for (const Case& each : cases) {
    ++i;
    const bool is_named = named && !each.layout.empty();
    declarations += fmt::format("layout(binding = {}{}) uniform {}image2D image{};\n", i,
                                is_named ? ", " + each.layout : "", each.kind, i);
    const char* bits = each.kind.empty() ? "floatBitsToUint" : each.kind == "i" ? "uvec4" : "";
    statements += fmt::format(
        "imageStore(image{0}, ivec2(1, 0), {1}vec4({2}));\n"
        "result[{3}] = u64vec4({4}(imageLoad(image{0}, ivec2(0, 1))));\n",
        i, each.kind, each.value, i - 1, bits);
  }
  return declarations + "void main() {\n" + statements + "}";
}

TEST_CASE("texels are written and read in every format, which the shader names or leaves to the image") {
  constexpr std::size_t count = std::size(cases);
  REQUIRE(count == tandem::rhi::texture_format_count + 1);  // rg11b10_float twice
  for (const bool named : {true, false}) {
    CAPTURE(named);
    const Kernel kernel(format_shader(named));
    std::vector<std::vector<std::uint8_t>> texels(count);
    std::vector<Image> images(count);
    std::vector<std::uint64_t> result(4 * count);
    std::vector<Resource> resources = {resource(result)};
    for (std::size_t k = 0; k < count; ++k) {
      // Three texels in two rows; the one that is read is the first of the second row.
      const std::vector<std::uint8_t> texel = bytes_of(cases[k]);
      REQUIRE(tandem::rhi::size_of(cases[k].format) == texel.size());
      texels[k].assign(6 * texel.size(), 0xab);
      std::copy(texel.begin(), texel.end(), texels[k].begin() + std::ptrdiff_t(3 * texel.size()));
      images[k] = image_of(texels[k], cases[k].format, {3, 2, 1});
      resources.push_back(resource_of(images[k]));
    }
    kernel.run(resources);
    for (std::size_t k = 0; k < count; ++k) {
      CAPTURE(tandem::rhi::info_of(cases[k].format).name);
      const std::vector<std::uint8_t> texel = bytes_of(cases[k]);
      std::vector<std::uint8_t> memory;
      for (const bool holds : {false, true, false, true, false, false}) {
        if (holds)
          memory.insert(memory.end(), texel.begin(), texel.end());
        else
          memory.insert(memory.end(), texel.size(), 0xab);
      }
      CHECK(texels[k] == memory);
      CHECK(std::vector<std::uint64_t>(result.begin() + std::ptrdiff_t(4 * k),
                                       result.begin() + std::ptrdiff_t(4 * k + 4)) == cases[k].components);
    }
  }
}

}  // namespace
