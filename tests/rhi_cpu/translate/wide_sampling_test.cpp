// Sampled images in the wide form: every lane has the bits of the scalar form, whatever the format, the sampler and the
// coordinates, and whichever lanes execute.

#include <array>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <span>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "tests/rhi_cpu/translate/kernel_images.hpp"
#include "tests/rhi_cpu/translate/wide_forms.hpp"

namespace {

using tandem::kernel::AddressMode;
using tandem::kernel::BorderColor;
using tandem::kernel::Filter;
using tandem::kernel::SampledImage;
using tandem::kernel::Sampler;
using tandem::rhi::ComponentKind;
using tandem::rhi::TextureFormat;
using tandem::test::any_float;
using tandem::test::any_lanes;
using tandem::test::Forms;
using tandem::test::Random;
using tandem::test::RandomImage;
using tandem::test::resource;
using tandem::test::resource_of;

/// Of invocation i, at the point p.
constexpr const char* questions[] = {
    "textureLod(plane, p.xy, 0.0)",
    "textureLod(plane, p.xy, detail)",
    "textureLod(plane, p.xy, p.w)",
    "textureLodOffset(plane, p.xy, detail, ivec2(2, -3))",
    "textureProjLod(plane, p.xyz, detail)",
    "textureGrad(plane, p.xy, p.zw, p.wz)",
    "textureLod(layers, p.xyz, p.w)",
    "textureLod(line, p.x, p.w)",
    "textureLod(lines, p.xy, detail)",
    "textureLod(volume, p.xyz, p.w)",
    "textureLod(SEPARATE, p.yx, 0.0)",
    "textureGather(plane, p.xy, 0)",
    "textureGather(plane, p.xy, 3)",
    "textureGather(layers, p.xyz, 2)",
    "textureGatherOffset(plane, p.xy, ivec2(1, -2), 1)",
    "textureGatherOffsets(plane, p.xy, offsets, 1)",
    "texelFetch(plane, ivec2(p.xy * 4.0), 0)",
    "texelFetch(plane, ivec2(i, i >> 3), 0)",
    "texelFetch(plane, ivec2(p.xy * 4.0), int(detail))",
    "texelFetch(plane, ivec2(p.xy * 4.0), int(p.w) & 3)",
    "texelFetchOffset(layers, ivec3(p.xyz * 4.0), 1, ivec2(-1, 2))",
    "texelFetch(line, int(p.x * 4.0), 0)",
    "texelFetch(volume, ivec3(p.xyz * 4.0), 0)",
};
constexpr auto question_count = static_cast<std::uint32_t>(std::size(questions));

/// @param kind prefix of the types: "" or "u"
std::string source(const std::string& kind) {
  std::string glsl = std::string(tandem::test::words_of_vector) + R"(
layout(local_size_x = 32) in;
layout(push_constant) uniform Constants { uint question; uint executing; float detail; };
layout(binding = 0) readonly buffer Points { vec4 points[]; };
layout(binding = 1) buffer Answers { uvec4 answers[]; };
layout(binding = 8) uniform sampler separate_sampler;
)";
  const char* const textures[] = {"sampler2D plane",      "sampler2DArray layers", "sampler1D line",
                                  "sampler1DArray lines", "sampler3D volume",      "texture2D separate_image"};
  for (std::size_t i = 0; i < std::size(textures); ++i)
    glsl += "layout(binding = " + std::to_string(i + 2) + ") uniform " + kind + textures[i] + ";\n";
  glsl += "#define SEPARATE " + kind + R"(sampler2D(separate_image, separate_sampler)
const ivec2 offsets[4] = ivec2[4](ivec2(0), ivec2(1, -2), ivec2(-3, 1), ivec2(2));
void main() {
  int i = int(gl_GlobalInvocationID.x);
  vec4 p = points[i];
  if ((executing >> (i & 31) & 1u) == 0u) return;
  switch (question) {
)";
  for (std::uint32_t i = 0; i < question_count; ++i)
    glsl += "  case " + std::to_string(i) + "u: answers[i] = words_of(" + questions[i] + "); break;\n";
  return glsl + "  }\n}";
}

struct Constants {
  std::uint32_t question, executing;
  float detail;
};

Sampler random_sampler(Random& random, AddressMode mode, Filter filter) {
  Sampler sampler;
  sampler.magnification = filter;
  sampler.minification = static_cast<Filter>(random() % 2);
  sampler.mipmap = static_cast<Filter>(random() % 2);
  sampler.address[0] = mode;
  for (int i = 1; i < 3; ++i) sampler.address[i] = static_cast<AddressMode>(random() % 5);
  sampler.lod_bias = random() % 4 == 0 ? 0.75f : 0.0f;
  if (random() % 4 == 0) sampler.max_lod = 0.5f;
  sampler.border = static_cast<BorderColor>(random() % 6);
  sampler.unnormalized = random() % 8 == 0 ? 1 : 0;
  return sampler;
}

/// Asks all questions of random images of the format, with a random sampler that has the mode and the filter.
void compare(const Forms& forms, Random& random, TextureFormat format, AddressMode mode, Filter filter) {
  constexpr std::uint32_t count = 64;
  const auto side = [&] { return static_cast<std::uint32_t>(random() % 9 + 1); };
  const auto levels = [&] { return static_cast<std::uint32_t>(random() % 3 + 1); };
  const std::uint32_t width = random() % 4 == 0 ? 64 : side(), height = side(), depth = side();
  const RandomImage plane(random, format, {width, height, 1}, 2, levels());
  const RandomImage layers(random, format, {width, height, depth}, 2, levels());
  const RandomImage line(random, format, {width, 1, 1}, 1, levels());
  const RandomImage lines(random, format, {width, height, 1}, 1, 1);
  const RandomImage volume(random, format, {width, height, depth}, 3, levels());
  const Sampler sampler = random_sampler(random, mode, filter);
  std::vector<SampledImage> textures;
  for (const RandomImage* each : {&plane, &layers, &line, &lines, &volume})
    textures.push_back({&each->image, &sampler});
  std::vector<float> points(4 * count);
  for (float& each : points) each = any_float(random);
  for (std::uint32_t question = 0; question < question_count; ++question) {
    const Constants constants = {question, any_lanes(random), static_cast<float>(random() % 9) / 2.0f - 1.0f};
    std::vector<std::uint32_t> expected;
    for (std::size_t form = 0; form < forms.count(); ++form) {
      std::vector<std::uint32_t> answers(4 * count);
      std::vector<tandem::kernel::Resource> resources = {resource(points), resource(answers)};
      for (const SampledImage& each : textures) resources.push_back(resource_of(each));
      resources.push_back(resource_of(plane.image));
      resources.push_back(resource_of(sampler));
      forms[form].run(resources, {count / 32}, std::as_bytes(std::span(&constants, 1)));
      if (form == 0) expected = answers;
      INFO(questions[question], ", format ", static_cast<int>(format), ", address mode ", static_cast<int>(mode),
           ", filter ", static_cast<int>(filter), ", form ", form);
      CHECK(answers == expected);
    }
  }
}

constexpr AddressMode modes[] = {AddressMode::repeat, AddressMode::mirrored_repeat, AddressMode::clamp_to_edge,
                                 AddressMode::clamp_to_border, AddressMode::mirror_clamp_to_edge};

}  // namespace

TEST_CASE("in lanes: sampled images of every format, address mode and filter") {
  const Forms forms(source(""), {4, 8});
  Random random(1);
  for (std::uint32_t format = 0; format < tandem::rhi::texture_format_count; ++format)
    for (const AddressMode mode : modes)
      for (const Filter filter : {Filter::nearest, Filter::linear})
        compare(forms, random, static_cast<TextureFormat>(format), mode, filter);
}

TEST_CASE("in lanes: sampled images of integers") {
  Random random(2);
  const Forms forms(source("u"));
  for (std::uint32_t i = 0; i < tandem::rhi::texture_format_count; ++i) {
    const auto format = static_cast<TextureFormat>(i);
    if (tandem::rhi::info_of(format).kind != ComponentKind::uint && format != TextureFormat::rgba8_unorm) continue;
    for (const AddressMode mode : modes) compare(forms, random, format, mode, Filter::nearest);
  }
}
