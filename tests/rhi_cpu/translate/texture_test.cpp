// Sampled images, samplers and texel buffers as bindings, in arrays and as parameters; fetches, sizes, formats.

#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "tests/rhi_cpu/translate/kernel_harness.hpp"
#include "tests/rhi_cpu/translate/kernel_images.hpp"
#include "tests/rhi_cpu/translate/sampling_harness.hpp"

namespace {

using tandem::kernel::Filter;
using tandem::kernel::Image;
using tandem::kernel::Resource;
using tandem::kernel::ResourceKind;
using tandem::kernel::SampledImage;
using tandem::kernel::Sampler;
using tandem::rhi::TextureFormat;
using tandem::test::image_of;
using tandem::test::Kernel;
using tandem::test::resource;
using tandem::test::resource_of;
using tandem::test::TestImage;

TEST_CASE("images and samplers, joined and apart, in arrays and as parameters") {
  const std::string source = R"(
    #extension GL_EXT_nonuniform_qualifier : require
    #extension GL_EXT_samplerless_texture_functions : require
    layout(local_size_x = 1) in;
    layout(binding = 0) buffer Result { float result[]; };
    layout(binding = 1) uniform sampler2D joined;
    layout(binding = 2) uniform sampler2D more[2];
    layout(binding = 3) uniform texture2D apart;
    layout(binding = 4) uniform texture2D others[3];
    layout(binding = 5) uniform sampler alone;
    layout(binding = 6) uniform sampler few[2];
    layout(binding = 7) uniform samplerBuffer texels;
    layout(binding = 8) uniform textureBuffer words[2];
    layout(binding = 9) uniform samplerShadow shadow;
    float of(sampler2D s, float u) { return textureLod(s, vec2(u, 0.5), 0.0).x; }
    float of_both(texture2D t, sampler s, float u) { return textureLod(sampler2D(t, s), vec2(u, 0.5), 0.0).x; }
    float of_image(texture2D t) { return texelFetch(t, ivec2(1, 0), 0).x; }
    float of_sampler(sampler s) { return textureLod(sampler2D(apart, s), vec2(0.5), 0.0).x; }
    float of_buffer(samplerBuffer b, int i) { return texelFetch(b, i).x; }
    float of_words(textureBuffer b, int i) { return texelFetch(b, i).x; }
    float of_array(sampler2D s[2], int i) { return textureLod(s[i], vec2(0.25, 0.5), 0.0).x + textureLod(s[1], vec2(0.75, 0.5), 0.0).x; }
    void main() {
      int one = result.length() / 20;
      result[0] = of(joined, 0.25);
      result[1] = of(more[one], 0.25) + of(more[0], 0.25);
      result[2] = textureLod(more[nonuniformEXT(one)], vec2(0.75, 0.5), 0.0).x;
      result[3] = of_both(apart, alone, 0.75);
      result[4] = of_both(others[one + 1], few[one], 0.5);
      result[5] = textureLod(sampler2D(others[nonuniformEXT(one)], few[nonuniformEXT(one)]), vec2(0.5), 0.0).x;
      result[6] = of_image(others[one]) + of_image(apart);
      result[7] = of_sampler(few[one]);
      result[8] = of_buffer(texels, 2);
      result[9] = of_words(words[one], 0) + texelFetch(words[nonuniformEXT(0)], 1).x;
      result[10] = float(textureSize(texels) * 10 + textureSize(words[one]));
      result[11] = textureLod(sampler2DShadow(apart, shadow), vec3(0.75, 0.5, 3.0), 0.0);
      result[13] = of_array(more, one - 1);
      result[12] = texelFetch(texels, 3).x + texelFetch(texels, -1).x + of_words(words[0], 99);
    })";
  const TestImage a({2, 1, 1}, 2, {{1, 2}}), b({2, 1, 1}, 2, {{10, 20}}), c({2, 1, 1}, 2, {{100, 200}}),
      d({2, 1, 1}, 2, {{1000, 2000}}), e({2, 1, 1}, 2, {{10000, 20000}});
  const TestImage line({3, 1, 1}, 1, {{5, 6, 7}}), pair({2, 1, 1}, 1, {{8, 9}}), single({1, 1, 1}, 1, {{4}});
  Sampler nearest, linear, compare;
  linear.magnification = linear.minification = Filter::linear;
  compare.compare = tandem::kernel::CompareOp::less;
  const SampledImage joined = {&a.image(), &nearest}, first = {&b.image(), &nearest}, second = {&c.image(), &nearest};
  for (const bool optimize : {false, true}) {
    tandem::test::KernelOptions options;
    options.optimize = optimize;
    const Kernel kernel(source, options);
    std::vector<float> result(20);
    // others[0] is not read.
    kernel.run({resource(result), resource_of(joined), resource_of(first), resource_of(second), resource_of(d.image()),
                Resource{}, resource_of(e.image()), resource_of(b.image()), resource_of(nearest), Resource{},
                resource_of(linear), resource_of(line.image()), resource_of(pair.image()), resource_of(single.image()),
                resource_of(compare)});
    result.resize(14);
    CHECK(result == std::vector<float>{1, 110, 200, 2000, 15, 15000, 22000, 1500, 7, 13, 31, 1, 0, 210});
    CHECK(kernel.info().bindings[1].kind == ResourceKind::combined_image_sampler);
    CHECK(kernel.info().bindings[4].kind == ResourceKind::sampled_image);
    CHECK(kernel.info().bindings[6].kind == ResourceKind::sampler);
    CHECK(kernel.info().bindings[7].kind == ResourceKind::uniform_texel_buffer);
    CHECK(kernel.info().bindings[8].kind == ResourceKind::uniform_texel_buffer);
  }
}

TEST_CASE("fetches and sizes of every dimension and level") {
  const Kernel kernel(R"(
    layout(local_size_x = 1) in;
    layout(binding = 0) buffer Result { ivec4 result[]; };
    layout(binding = 1) uniform isampler1D d1;
    layout(binding = 2) uniform isampler2D d2;
    layout(binding = 3) uniform isampler3D d3;
    layout(binding = 4) uniform isamplerCube cube;
    layout(binding = 5) uniform isampler1DArray d1_array;
    layout(binding = 6) uniform isampler2DArray d2_array;
    layout(binding = 7) uniform isamplerCubeArray cube_array;
    layout(binding = 8) uniform isamplerBuffer line;
    void main() {
      int one = result.length() / 30;
      result[0] = ivec4(textureSize(d1, 0), textureSize(d1, one), textureSize(d1, 2), textureQueryLevels(d1));
      result[1] = ivec4(textureSize(d2, 0), textureSize(d2, one));
      result[2] = ivec4(textureSize(d3, one), textureQueryLevels(d3));
      result[3] = ivec4(textureSize(cube, one), textureSize(cube, 2));
      result[4] = ivec4(textureSize(d1_array, one), textureSize(d1_array, 0));
      result[5] = ivec4(textureSize(d2_array, one), textureQueryLevels(d2_array));
      result[6] = ivec4(textureSize(cube_array, one), textureQueryLevels(cube_array));
      result[7] = ivec4(textureSize(line), texelFetch(line, 3).x, texelFetch(line, 64).x, texelFetch(line, -1).w);
      result[8] = ivec4(texelFetch(d1, 2, 0).x, texelFetch(d1, one, one).x, texelFetch(d1, 2, one).x,
                        texelFetchOffset(d1, 3, 0, -2).x);
      result[9] = ivec4(texelFetch(d2, ivec2(3, 1), 0).x, texelFetch(d2, ivec2(1, one), one).x,
                        texelFetchOffset(d2, ivec2(0, 0), one, ivec2(1, 0)).x, texelFetch(d2, ivec2(1, 2), one).x);
      result[10] = ivec4(texelFetch(d3, ivec3(3, 3, 3), 0).x, texelFetch(d3, ivec3(1, 0, 1), one).x,
                         texelFetch(d3, ivec3(0, 0, 2), one).x, texelFetch(d3, ivec3(0, 0, 0), 3).w);
      result[11] = ivec4(texelFetch(d1_array, ivec2(1, 3), one).x, texelFetch(d1_array, ivec2(0, 4), one).x,
                         texelFetch(d2_array, ivec3(1, 1, 3), one).x, texelFetch(d2_array, ivec3(0, 0, -1), one).x);
      result[12] = texelFetch(d2, ivec2(0), 0); result[13] = texelFetch(d2, ivec2(-1, 0), 0);
      result[14] = ivec4(textureLod(d2, vec2(0.9), 0).x, textureLod(d3, vec3(0.9), 1).x,
                         textureLod(cube, vec3(-1, 0, 0), 0).x, textureLod(d2_array, vec3(0.1, 0.1, 2), 1).x);
      result[15] = textureGather(d2, vec2(0.25));
    })");
  // 4 texels along each side, of one integer each, that count from 0; the levels follow each other.
  std::vector<std::int32_t> texels(4096);
  for (std::size_t i = 0; i < texels.size(); ++i) texels[i] = static_cast<std::int32_t>(i);
  const auto image = [&](std::array<std::uint32_t, 3> size, std::uint32_t sides) {
    Image made = image_of(texels, TextureFormat::r32_sint, size);
    made.sides = sides;
    made.level_count = 3;
    std::uint64_t offset = 0;
    for (std::uint32_t level = 0; level < 3; ++level) {
      made.level_offsets[level] = offset;
      std::uint64_t count = 4;
      for (std::uint32_t i = 0; i < 3; ++i) count *= i < sides ? size[i] >> level : size[i];
      offset += count;
    }
    return made;
  };
  const Image images[] = {image({4, 1, 1}, 1),  image({4, 4, 1}, 2),
                          image({4, 4, 4}, 3),  image({4, 4, 6}, 2),
                          image({4, 4, 1}, 1),  image({4, 4, 4}, 2),
                          image({4, 4, 12}, 2), image_of(texels, TextureFormat::r32_sint, {64, 1, 1})};
  const Sampler sampler;
  std::array<SampledImage, 7> textures;
  std::vector<std::array<std::int32_t, 4>> result(30);
  std::vector<Resource> resources = {resource(result)};
  for (std::size_t i = 0; i < 7; ++i) {
    textures[i] = {&images[i], &sampler};
    resources.push_back(resource_of(textures[i]));
  }
  resources.push_back(resource_of(images[7]));
  kernel.run(resources);
  using Row = std::array<std::int32_t, 4>;
  CHECK(result[0] == Row{4, 2, 1, 3});
  CHECK(result[1] == Row{4, 4, 2, 2});
  CHECK(result[2] == Row{2, 2, 2, 3});
  CHECK(result[3] == Row{2, 2, 1, 1});
  CHECK(result[4] == Row{2, 4, 4, 4});
  CHECK(result[5] == Row{2, 2, 4, 3});
  CHECK(result[6] == Row{2, 2, 2, 3});
  CHECK(result[7] == Row{64, 3, 0, 1});
  CHECK(result[8] == Row{2, 5, 0, 1});
  CHECK(result[9] == Row{7, 19, 17, 0});
  CHECK(result[10] == Row{63, 69, 0, 1});
  CHECK(result[11] == Row{23, 0, 79, 0});
  CHECK(result[12] == Row{0, 0, 0, 1});
  CHECK(result[13] == Row{0, 0, 0, 1});
  CHECK(result[14] == Row{15, 71, 26, 72});
  CHECK(result[15] == Row{4, 5, 1, 0});
}

TEST_CASE("the format of a sampled image and of a texel buffer is the image's own") {
  const Kernel kernel(R"(
    #extension GL_EXT_samplerless_texture_functions : require
    layout(local_size_x = 1) in;
    layout(binding = 0) buffer Result { vec4 fetched, sampled, of_line; uvec4 whole; };
    layout(binding = 1) uniform sampler2D image;
    layout(binding = 2) uniform samplerBuffer line;
    layout(binding = 3) uniform utexture2D whole_image;
    void main() {
      fetched = texelFetch(image, ivec2(0), 0);
      sampled = textureLod(image, vec2(0.5), 0.0);
      of_line = texelFetch(line, 0);
      whole = texelFetch(whole_image, ivec2(0), 0);
    })");
  struct Case {
    TextureFormat format;
    std::uint32_t texel;
    std::array<float, 4> components;
    std::array<std::uint32_t, 4> whole;
  };
  using Whole = std::array<std::uint32_t, 4>;
  const Whole none = {0, 0, 0, 0};
  const std::array<float, 4> nothing = {0, 0, 0, 0};
  const Case cases[] = {
      {TextureFormat::rgba8_unorm, 0x8040ff00, {0, 1, 64 / 255.0f, 128 / 255.0f}, none},
      {TextureFormat::bgra8_unorm, 0x8040ff00, {64 / 255.0f, 1, 0, 128 / 255.0f}, none},
      // ((187 / 255 + 0.055) / 1.055)^2.4 and 10 / 255 / 12.92, to the nearest float; alpha is linear.
      {TextureFormat::rgba8_srgb, 0x80ff0abb, {0.49693299f, 0.0030352698f, 1, 128 / 255.0f}, none},
      {TextureFormat::rgb10a2_unorm,
       1023u | 1u << 10 | 512u << 20 | 1u << 30,
       {1, 1 / 1023.0f, 512 / 1023.0f, 1 / 3.0f},
       none},
      // 2^-14 * 1/64, the least that is not 0; infinity; 65536 * (1 - 1/64).
      {TextureFormat::rg11b10_float, 1u | 0x7c0u << 11 | 0x3dfu << 22, {0x1p-20f, INFINITY, 64512, 1}, none},
      {TextureFormat::d16_unorm, 0x8000, {32768 / 65535.0f, 0, 0, 1}, none},
      {TextureFormat::d32_float, 0x3f400000, {0.75f, 0, 0, 1}, none},
      {TextureFormat::r8_snorm, 0x80, {-1, 0, 0, 1}, none},
      {TextureFormat::rg16_float, 0x80013c00, {1, -0x1p-24f, 0, 1}, none},
      {TextureFormat::rgba8_uint, 0x04030201, nothing, {1, 2, 3, 4}},
      {TextureFormat::r16_uint, 0xffff, nothing, {65535, 0, 0, 1}},
      {TextureFormat::rgb10a2_uint, 0xffffffff, nothing, {1023, 1023, 1023, 3}},
  };
  const Sampler sampler;
  for (const Case& each : cases) {
    CAPTURE(tandem::rhi::info_of(each.format).name);
    std::vector<std::uint32_t> texel = {each.texel};
    const Image image = image_of(texel, each.format, {1, 1, 1});
    const SampledImage texture = {&image, &sampler};
    struct Result {
      std::array<float, 4> fetched, sampled, of_line;
      Whole whole;
    };
    std::vector<Result> result(1);
    kernel.run({resource(result), resource_of(texture), resource_of(image), resource_of(image)});
    CHECK(result[0].fetched == each.components);
    CHECK(result[0].sampled == each.components);
    CHECK(result[0].of_line == each.components);
    CHECK(result[0].whole == each.whole);
  }
}

}  // namespace
