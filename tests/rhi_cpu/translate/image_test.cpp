// Storage images and storage texel buffers: every dimension, arrays of them, functions that take them, atomics, and
// what lies outside.

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <doctest/doctest.h>

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
    // plane[1] has one row, so (0, 1) lies outside of it. Of the six texels outside each has the alpha 1.
    CHECK(result == std::vector<float>{103, 206, 0, 410, 507, 3, 43, 223, 222, 6});
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

TEST_CASE("cubes, arrays of cubes and of lines, and texel buffers") {
  // The layer of a cube is its face; of an array of cubes, the face and six times the cube.
  const Kernel kernel(R"(
    #extension GL_EXT_shader_image_load_formatted : require
    layout(local_size_x = 1) in;
    layout(binding = 0, r32f) uniform imageCube cube;
    layout(binding = 1, r32f) uniform imageCubeArray cubes;
    layout(binding = 2, r32f) uniform image1DArray lines;
    layout(binding = 3) uniform imageBuffer texels[2];
    layout(binding = 4) buffer Result { float result[]; };
    float at(imageBuffer b, int i) { return imageLoad(b, i).x; }
    void main() {
      result[0] = imageLoad(cube, ivec3(1, 0, 5)).x;
      result[1] = imageLoad(cubes, ivec3(0, 1, 7)).x;
      result[2] = imageLoad(lines, ivec2(2, 1)).x;
      result[3] = at(texels[result.length() - 17], 3);
      result[4] = imageLoad(cube, ivec3(1, 0, 6)).x + imageLoad(cubes, ivec3(0, 0, 12)).x +
                  imageLoad(lines, ivec2(0, 2)).x + imageLoad(texels[1], 4).x + imageLoad(texels[0], -1).x;
      ivec3 s = imageSize(cubes);
      result[5] = float(imageSize(cube).x * 10 + imageSize(cube).y);
      result[6] = float(s.x * 100 + s.y * 10 + s.z);
      result[7] = float(imageSize(lines).x * 10 + imageSize(lines).y);
      result[8] = float(imageSize(texels[1]));
      imageStore(cube, ivec3(0, 1, 4), vec4(-1)); imageStore(cubes, ivec3(1, 1, 11), vec4(-2));
      imageStore(lines, ivec2(0, 1), vec4(-3)); imageStore(texels[1], 0, vec4(-4));
      imageStore(lines, ivec2(3, 0), vec4(-5)); imageStore(texels[1], 4, vec4(-6));
    })");
  const auto numbered = [](std::size_t count) {
    std::vector<float> values(count);
    for (std::size_t i = 0; i < count; ++i) values[i] = static_cast<float>(i);
    return values;
  };
  std::vector<float> cube = numbered(24), cubes = numbered(48), lines = numbered(6), one = numbered(1),
                     four = numbered(5), result(18);
  const auto image = [](std::vector<float>& values, std::array<std::uint32_t, 3> size) {
    return image_of(values, TextureFormat::r32_float, size);
  };
  const Image images[] = {image(cube, {2, 2, 6}), image(cubes, {2, 2, 12}), image(lines, {3, 2, 1}),
                          image(one, {1, 1, 1}), image(four, {4, 1, 1})};
  kernel.run({resource_of(images[0]), resource_of(images[1]), resource_of(images[2]), resource_of(images[3]),
              resource_of(images[4]), resource(result)});
  result.resize(9);
  CHECK(result == std::vector<float>{21, 30, 5, 3, 0, 22, 222, 32, 4});
  CHECK(cube[18] == -1);
  CHECK(cubes[47] == -2);
  CHECK(lines == std::vector<float>{0, 1, 2, -3, 4, 5});
  CHECK(four == std::vector<float>{-4, 1, 2, 3, 4});
}

TEST_CASE("atomic operations on texels of 64 bits, on floats, and in texel buffers, cubes and layers") {
  const Kernel kernel(R"(
    #extension GL_EXT_shader_image_int64 : require
    #extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
    #extension GL_EXT_shader_atomic_float : require
    layout(local_size_x = 8) in;
    layout(binding = 0, r64ui) uniform u64image2DArray wide;
    layout(binding = 1, r64i) uniform i64imageBuffer line;
    layout(binding = 2, r32f) uniform imageCube cube;
    layout(binding = 3, r32ui) uniform uimageBuffer counts;
    void main() {
      int i = int(gl_LocalInvocationIndex);
      imageAtomicAdd(wide, ivec3(1, 0, 1), 0x100000000ul);
      imageAtomicMin(line, 1, int64_t(-i) << 40);
      imageAtomicAdd(cube, ivec3(0, 0, 3), 0.5);
      if (i == 7) imageAtomicExchange(cube, ivec3(0, 0, 4), 2.25);
      imageAtomicOr(counts, i & 1, 1u << i);
      imageAtomicAdd(counts, 2, 1u);
      imageAtomicMax(wide, ivec3(0, 0, 2), 9ul);
    })");
  std::vector<std::uint64_t> wide(4, 5);
  std::vector<std::int64_t> line(2, 3);
  std::vector<float> cube(6, 1);
  std::vector<std::uint32_t> counts(3, 0);
  const Image images[] = {
      image_of(wide, TextureFormat::r64_uint, {2, 1, 2}), image_of(line, TextureFormat::r64_sint, {2, 1, 1}),
      image_of(cube, TextureFormat::r32_float, {1, 1, 6}), image_of(counts, TextureFormat::r32_uint, {2, 1, 1})};
  kernel.run({resource_of(images[0]), resource_of(images[1]), resource_of(images[2]), resource_of(images[3])});
  CHECK(wide == std::vector<std::uint64_t>{5, 5, 5, 0x800000005u});
  CHECK(line == std::vector<std::int64_t>{3, -(std::int64_t{7} << 40)});
  CHECK(cube == std::vector<float>{1, 1, 1, 5, 2.25f, 1});
  CHECK(counts == std::vector<std::uint32_t>{0x55, 0xaa, 0});
}

}  // namespace
