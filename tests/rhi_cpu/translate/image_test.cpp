// Storage images: every format and dimension, arrays of them, functions that take them, atomics, and what lies outside.

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <iterator>
#include <string>
#include <vector>

#include <doctest/doctest.h>
#include <fmt/format.h>

#include "rhi/texture.hpp"
#include "rhi_cpu/kernel/abi.hpp"
#include "tests/rhi_cpu/translate/kernel_harness.hpp"

namespace {

using tandem::kernel::Image;
using tandem::kernel::Resource;
using tandem::rhi::TextureFormat;
using tandem::test::Kernel;
using tandem::test::resource;

Resource resource_of(const Image& image) {
  return {const_cast<std::byte*>(reinterpret_cast<const std::byte*>(&image)), 0};
}

template <typename T>
Image image_of(std::vector<T>& texels, TextureFormat format, std::array<std::uint32_t, 3> size) {
  return {reinterpret_cast<std::byte*>(texels.data()), {size[0], size[1], size[2]}, static_cast<std::uint32_t>(format)};
}

using Words = std::vector<std::uint32_t>;

Words floats(std::initializer_list<float> values) {
  Words words;
  for (const float value : values) words.push_back(std::bit_cast<std::uint32_t>(value));
  return words;
}

/// A texel of one format: a value in GLSL that it is written from, its words, and the components that are read.
struct Case {
  std::string layout;
  TextureFormat format;
  std::string kind;  ///< prefix of the image's type
  std::string value;
  Words texel;
  Words components;
};

// 0.5 * 255 = 127.5 lies in the middle, and goes to the even 128; NaN becomes 0. Integers keep their low bits. What a
// format lacks is read as 0, alpha as 1.
const Case cases[] = {
    {"rgba8",
     TextureFormat::rgba8_unorm,
     "",
     "0.5, 2.0, -1.0, uintBitsToFloat(0x7fc00000)",
     {0x0000ff80},
     floats({128 / 255.0f, 1, 0, 0})},
    {"rgba8_snorm",
     TextureFormat::rgba8_snorm,
     "",
     "-1.0, 1.0, -3.0, 0.5",
     {0x40817f81},
     floats({-1, 1, -1, 64 / 127.0f})},
    {"rgba8ui", TextureFormat::rgba8_uint, "u", "1u, 255u, 257u, 3u", {0x0301ff01}, {1, 255, 1, 3}},
    {"rgba8i", TextureFormat::rgba8_sint, "i", "-1, 127, -128, 3", {0x03807fff}, {0xffffffff, 127, 0xffffff80, 3}},
    {"rgba16ui", TextureFormat::rgba16_uint, "u", "1u, 65535u, 2u, 3u", {0xffff0001, 0x00030002}, {1, 65535, 2, 3}},
    {"rgba16i",
     TextureFormat::rgba16_sint,
     "i",
     "-1, 2, -32768, 3",
     {0x0002ffff, 0x00038000},
     {0xffffffff, 2, 0xffff8000, 3}},
    {"rgba16f",
     TextureFormat::rgba16_float,
     "",
     "1.0, -2.0, 65504.0, 0.5",
     {0xc0003c00, 0x38007bff},
     floats({1, -2, 65504, 0.5f})},
    {"r32ui", TextureFormat::r32_uint, "u", "4000000000u, 1u, 2u, 3u", {4000000000u}, {4000000000u, 0, 0, 1}},
    {"r32i", TextureFormat::r32_sint, "i", "-5, 1, 2, 3", {0xfffffffb}, {0xfffffffb, 0, 0, 1}},
    {"r32f", TextureFormat::r32_float, "", "1.5, 1, 2, 3", floats({1.5f}), floats({1.5f, 0, 0, 1})},
    {"rg32ui", TextureFormat::rg32_uint, "u", "7u, 8u, 2u, 3u", {7, 8}, {7, 8, 0, 1}},
    {"rg32i", TextureFormat::rg32_sint, "i", "-7, 8, 2, 3", {0xfffffff9, 8}, {0xfffffff9, 8, 0, 1}},
    {"rg32f", TextureFormat::rg32_float, "", "7, 8, 2, 3", floats({7, 8}), floats({7, 8, 0, 1})},
    {"rgba32ui", TextureFormat::rgba32_uint, "u", "7u, 8u, 9u, 10u", {7, 8, 9, 10}, {7, 8, 9, 10}},
    {"rgba32i", TextureFormat::rgba32_sint, "i", "-1, 8, 9, 10", {0xffffffff, 8, 9, 10}, {0xffffffff, 8, 9, 10}},
    {"rgba32f", TextureFormat::rgba32_float, "", "7, 8, 9, 0.1", floats({7, 8, 9, 0.1f}), floats({7, 8, 9, 0.1f})},
};

TEST_CASE("texels are written and read in every format, which the shader names or leaves to the image") {
  for (const bool named : {true, false}) {
    CAPTURE(named);
    std::string declarations =
        "#extension GL_EXT_shader_image_load_formatted : require\nlayout(local_size_x = 1) in;\n"
        "layout(binding = 0) buffer Result { uvec4 result[]; };\n";
    std::string statements;
    int i = 0;
    for (const Case& each : cases) {
      ++i;
      declarations += fmt::format("layout(binding = {}{}) uniform {}image2D image{};\n", i,
                                  named ? ", " + each.layout : "", each.kind, i);
      statements += fmt::format(
          "imageStore(image{0}, ivec2(1, 0), {1}vec4({2}));\n"
          "result[{3}] = {4}(imageLoad(image{0}, ivec2(0, 1)));\n",
          i, each.kind, each.value, i - 1, each.kind.empty() ? "floatBitsToUint" : "uvec4");
    }
    const Kernel kernel(declarations + "void main() {\n" + statements + "}");
    constexpr std::size_t count = std::size(cases);
    std::vector<Words> texels(count);
    std::vector<Image> images(count);
    Words result(4 * count);
    std::vector<Resource> resources = {resource(result)};
    for (std::size_t k = 0; k < count; ++k) {
      // Three texels in two rows; the one that is read is the first of the second row.
      const std::size_t words = cases[k].texel.size();
      REQUIRE(tandem::rhi::size_of(cases[k].format) == 4 * words);
      texels[k].assign(6 * words, 0xabababab);
      std::copy(cases[k].texel.begin(), cases[k].texel.end(), texels[k].begin() + std::ptrdiff_t(3 * words));
      images[k] = image_of(texels[k], cases[k].format, {3, 2, 1});
      resources.push_back(resource_of(images[k]));
    }
    kernel.run(resources);
    for (std::size_t k = 0; k < count; ++k) {
      CAPTURE(cases[k].layout);
      const Words& texel = cases[k].texel;
      Words memory;
      for (const bool holds : {false, true, false, true, false, false}) {
        if (holds)
          memory.insert(memory.end(), texel.begin(), texel.end());
        else
          memory.insert(memory.end(), texel.size(), 0xabababab);
      }
      CHECK(texels[k] == memory);
      CHECK(Words(result.begin() + std::ptrdiff_t(4 * k), result.begin() + std::ptrdiff_t(4 * k + 4)) ==
            cases[k].components);
    }
  }
}

TEST_CASE("images of every dimension, in arrays, through functions, have a size and nothing outside") {
  const std::string source = R"(
    #extension GL_EXT_nonuniform_qualifier : require
    #extension GL_EXT_shader_image_load_formatted : require
    layout(local_size_x = 1) in;
    layout(binding = 0, r32f) uniform image1D line;
    layout(binding = 1) uniform image2D plane[2];
    layout(binding = 2, r32f) uniform image3D cube;
    layout(binding = 3, r32f) uniform image2DArray layers;
    layout(binding = 4) buffer Result { float result[]; };
    float at(image2D image, ivec2 p) { return imageLoad(image, p).x; }
    void put(image2D image, ivec2 p, float v) { imageStore(image, p, vec4(v)); }
    void main() {
      int n = result.length() / 20;
      result[0] = imageLoad(line, 2).x;
      result[1] = at(plane[0], ivec2(1, 2)); result[2] = at(plane[nonuniformEXT(n)], ivec2(0, 1));
      result[3] = imageLoad(cube, ivec3(1, 0, 2)).x; result[4] = imageLoad(layers, ivec3(0, 1, 1)).x;
      result[5] = float(imageSize(line)); result[6] = float(imageSize(plane[n]).x * 10 + imageSize(plane[0]).y);
      ivec3 s = imageSize(cube); result[7] = float(s.x * 100 + s.y * 10 + s.z);
      s = imageSize(layers); result[8] = float(s.x * 100 + s.y * 10 + s.z);
      vec4 sum = imageLoad(line, 3) + imageLoad(line, -1) + imageLoad(plane[0], ivec2(2, 0)) +
                 imageLoad(plane[0], ivec2(0, 3)) + imageLoad(cube, ivec3(0, 0, 3)) + imageLoad(cube, ivec3(0, -1, 0));
      result[9] = sum.x + sum.y + sum.z + sum.w;
      imageStore(line, 3, vec4(-1)); imageStore(line, -1, vec4(-1)); imageStore(cube, ivec3(0, 0, 3), vec4(-1));
      imageStore(layers, ivec3(0, 0, -1), vec4(-1)); put(plane[0], ivec2(-1, 0), -1.0);
      put(plane[n], ivec2(0, 0), 77.0); imageStore(cube, ivec3(0, 1, 2), vec4(88));
    })";
  for (const bool optimize : {false, true}) {
    tandem::test::KernelOptions options;
    options.optimize = optimize;
    const Kernel kernel(source, options);
    const auto numbered = [](std::size_t count, float first) {
      std::vector<float> values(count);
      for (std::size_t i = 0; i < count; ++i) values[i] = first + static_cast<float>(i);
      return values;
    };
    // A guard of one texel on each side.
    std::vector<float> line = numbered(5, 100), first = numbered(8, 200), second = numbered(6, 300),
                       cube = numbered(14, 400), layers = numbered(10, 500), result(20);
    const auto image = [](std::vector<float>& values, std::array<std::uint32_t, 3> size) {
      return Image{reinterpret_cast<std::byte*>(values.data() + 1),
                   {size[0], size[1], size[2]},
                   static_cast<std::uint32_t>(TextureFormat::r32_float)};
    };
    const Image images[] = {image(line, {3, 1, 1}), image(first, {2, 3, 1}), image(second, {4, 1, 1}),
                            image(cube, {2, 2, 3}), image(layers, {2, 2, 2})};
    kernel.run({resource_of(images[0]), resource_of(images[1]), resource_of(images[2]), resource_of(images[3]),
                resource_of(images[4]), resource(result)});
    result.resize(10);
    // plane[1] has one row, so (0, 1) lies outside of it.
    CHECK(result == std::vector<float>{103, 206, 0, 410, 507, 3, 43, 223, 222, 0});
    CHECK(line == numbered(5, 100));
    CHECK(first == numbered(8, 200));
    CHECK(layers == numbered(10, 500));
    CHECK(second[1] == 77);
    CHECK(cube[11] == 88);
    CHECK(cube[13] == 413);
  }
}

TEST_CASE("atomic operations on texels") {
  const Kernel kernel(R"(
    layout(local_size_x = 8, local_size_y = 8) in;
    layout(binding = 0, r32ui) uniform uimage2D counts[2];
    layout(binding = 1, r32i) uniform iimage2D least;
    layout(binding = 2) buffer Result { uint result[]; };
    void main() {
      imageAtomicAdd(counts[1], ivec2(gl_LocalInvocationID.x % 2, 0), 1u);
      imageAtomicMin(least, ivec2(0, 1), -int(gl_LocalInvocationIndex));
      result[gl_LocalInvocationIndex] = imageAtomicAdd(counts[0], ivec2(5, 5), 3u) + imageAtomicExchange(counts[1], ivec2(-1, 0), 9u);
      if (gl_LocalInvocationIndex == 0) result[64] = imageAtomicCompSwap(counts[0], ivec2(0), 4u, 44u);
    })");
  std::vector<std::uint32_t> a = {4}, b = {0, 0}, result(65, 1);
  std::vector<std::int32_t> least = {7, 8};
  const Image images[] = {image_of(a, TextureFormat::r32_uint, {1, 1, 1}),
                          image_of(b, TextureFormat::r32_uint, {2, 1, 1}),
                          image_of(least, TextureFormat::r32_sint, {1, 2, 1})};
  kernel.run({resource_of(images[0]), resource_of(images[1]), resource_of(images[2]), resource(result)});
  CHECK(b == std::vector<std::uint32_t>{32, 32});
  CHECK(least == std::vector<std::int32_t>{7, -63});
  CHECK(a == std::vector<std::uint32_t>{44});
  std::vector<std::uint32_t> expected(64, 0);
  expected.push_back(4);
  CHECK(result == expected);
}

}  // namespace
