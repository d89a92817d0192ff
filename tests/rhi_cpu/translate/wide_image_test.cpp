// Storage images in the wide form: lanes read and write the bits of the scalar form, in the order of invocations.

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

using tandem::kernel::Resource;
using tandem::rhi::TextureFormat;
using tandem::test::any_float;
using tandem::test::any_lanes;
using tandem::test::Forms;
using tandem::test::Random;
using tandem::test::RandomImage;
using tandem::test::resource;
using tandem::test::resource_of;

/// An image that the shader declares, by number.
struct Declaration {
  const char* layout;  ///< "" for an image whose format the shader does not say
  const char* type;
  const char* at;  ///< where it is read and written, of the ivec3 at
  TextureFormat format;
  std::array<std::uint32_t, 3> size = {13, 7, 1};
};
constexpr Declaration declarations[] = {
    {"rgba8", "image2D", "at.xy", TextureFormat::rgba8_unorm},
    {"rgba8", "image2D", "ivec2(i, at.y)", TextureFormat::rgba8_unorm, {64, 4, 1}},
    {"r8", "image2D", "at.xy", TextureFormat::r8_unorm},
    {"rgba8_snorm", "image2D", "at.xy", TextureFormat::rgba8_snorm},
    {"rgba16", "image2D", "at.xy", TextureFormat::rgba16_unorm},
    {"rgba16f", "image2D", "at.xy", TextureFormat::rgba16_float},
    {"rg16f", "image2D", "at.xy", TextureFormat::rg16_float},
    {"rgba32f", "image2D", "at.xy", TextureFormat::rgba32_float},
    {"r32f", "image2D", "ivec2(i, at.y)", TextureFormat::r32_float, {64, 4, 1}},
    {"rgb10_a2", "image2D", "at.xy", TextureFormat::rgb10a2_unorm},
    {"r11f_g11f_b10f", "image2D", "at.xy", TextureFormat::rg11b10_float},
    {"r32f", "image2DArray", "at", TextureFormat::r32_float, {5, 4, 3}},
    {"r32f", "image3D", "at", TextureFormat::r32_float, {5, 4, 3}},
    {"rgba8", "image2D", "at.xy", TextureFormat::rgba8_unorm, {0, 0, 0}},  // as where nothing is bound
    {"r32f", "image1D", "at.x", TextureFormat::r32_float, {9, 1, 1}},
    {"r32f", "imageBuffer", "at.x", TextureFormat::r32_float, {9, 1, 1}},
    {"r32ui", "uimage2D", "at.xy", TextureFormat::r32_uint},
    {"rgba8ui", "uimage2D", "at.xy", TextureFormat::rgba8_uint},
    {"r16ui", "uimage2D", "at.xy", TextureFormat::r16_uint},
    {"rgba32i", "iimage2D", "at.xy", TextureFormat::rgba32_sint},
    {"r8i", "iimage2D", "at.xy", TextureFormat::r8_sint},
    {"", "image2D", "at.xy", TextureFormat::rgba8_unorm},
    {"", "image2D", "at.xy", TextureFormat::rgba16_float},
    {"", "image2D", "at.xy", TextureFormat::r8_snorm},
    {"", "uimage2D", "at.xy", TextureFormat::rgba32_uint},
    {"", "uimage2D", "at.xy", TextureFormat::r32_float},
};
constexpr std::size_t declaration_count = std::size(declarations);

struct Constants {
  std::uint32_t number, executing, stores;
};

std::string source() {
  std::string glsl = "#extension GL_EXT_shader_image_load_formatted : require\n";
  std::string cases;
  for (std::size_t k = 0; k < declaration_count; ++k) {
    const Declaration& each = declarations[k];
    const std::string layout = each.layout, type = each.type, number = std::to_string(k);
    glsl += "layout(binding = " + std::to_string(k + 3) + (layout.empty() ? "" : ", " + layout) + ") uniform " + type +
            " image" + number + ";\n";
    const std::string value = type[0] == 'u' ? "uvec4(words)" : type[0] == 'i' && type[1] == 'i' ? "words" : "value";
    const std::string place = "image" + number + ", " + each.at;
    cases += "  case " + number + "u: if (stores != 0u) imageStore(" + place + ", " + value +
             "); else answers[i] = " + "words_of(imageLoad(" + place + ")); break;\n";
  }
  return glsl + tandem::test::words_of_vector + R"(
layout(local_size_x = 32) in;
layout(push_constant) uniform Constants { uint number, executing, stores; };
layout(binding = 0) readonly buffer Places { ivec4 places[]; };
layout(binding = 1) readonly buffer Values { vec4 values[]; };
layout(binding = 2) buffer Answers { uvec4 answers[]; };
void main() {
  int i = int(gl_GlobalInvocationID.x);
  ivec3 at = places[i].xyz;
  vec4 value = values[i];
  ivec4 words = floatBitsToInt(value);
  if ((executing >> (i & 31) & 1u) == 0u) return;
  switch (number) {
)" + cases +
         "  }\n}";
}

}  // namespace

TEST_CASE("in lanes: storage images are read and written as by one invocation after the other") {
  constexpr std::uint32_t count = 64;
  const Forms forms(source());
  Random random(1);
  for (std::uint32_t number = 0; number < declaration_count; ++number) {
    const Declaration& declaration = declarations[number];
    for (std::uint32_t round = 0; round < 8; ++round) {
      const RandomImage original(random, declaration.format, declaration.size);
      // Some lie outside, some far.
      std::vector<std::int32_t> places(4 * count);
      for (std::int32_t& each : places)
        each = random() % 32 == 0 ? static_cast<std::int32_t>(random()) : static_cast<std::int32_t>(random() % 16) - 2;
      if (round / 2 % 2 == 0)
        for (std::size_t i = 0; i < count; ++i) places[4 * i + 1] = 1;
      std::vector<float> values(4 * count);
      for (float& each : values) each = any_float(random);
      const Constants constants = {number, any_lanes(random), round % 2};
      std::vector<std::uint32_t> expected_answers;
      std::vector<std::byte> expected_texels;
      for (std::size_t form = 0; form < forms.count(); ++form) {
        std::vector<std::byte> texels = original.texels;
        tandem::kernel::Image image = original.image;
        image.texels = texels.data();
        std::vector<std::uint32_t> answers(4 * count);
        std::vector<Resource> resources = {resource(places), resource(values), resource(answers)};
        resources.resize(3 + declaration_count, resource_of(image));
        forms[form].run(resources, {count / 32}, std::as_bytes(std::span(&constants, 1)));
        if (form == 0) {
          expected_answers = answers;
          expected_texels = texels;
        }
        INFO("image ", number, ", round ", round, ", form ", form);
        CHECK(answers == expected_answers);
        CHECK(texels == expected_texels);
      }
    }
  }
}

TEST_CASE("in lanes: every code of 8 and 16 bits becomes the number of the scalar form") {
  const Forms forms(R"(
layout(local_size_x = 32) in;
layout(binding = 0, r16) uniform readonly image2D codes;
layout(binding = 1, r16f) uniform readonly image2D halves;
layout(binding = 2, r8) uniform readonly image2D bytes;
layout(binding = 3) buffer Answers { uvec4 answers[]; };
void main() {
  uint i = gl_GlobalInvocationID.x;
  ivec2 at = ivec2(i & 255u, i >> 8);
  answers[i] = floatBitsToUint(vec4(imageLoad(codes, at).x, imageLoad(halves, at).x, imageLoad(bytes, at).x, 0.0));
})",
                    {4, 8});
  constexpr std::uint32_t count = 65536;
  std::vector<std::uint16_t> words(count);
  for (std::uint32_t i = 0; i < count; ++i) words[i] = static_cast<std::uint16_t>(i);
  const tandem::kernel::Image codes = tandem::test::image_of(words, TextureFormat::r16_unorm, {256, 256, 1});
  const tandem::kernel::Image halves = tandem::test::image_of(words, TextureFormat::r16_float, {256, 256, 1});
  const tandem::kernel::Image bytes = tandem::test::image_of(words, TextureFormat::r8_unorm, {256, 256, 1});
  std::vector<std::uint32_t> expected;
  for (std::size_t form = 0; form < forms.count(); ++form) {
    std::vector<std::uint32_t> answers(4 * count);
    forms[form].run({resource_of(codes), resource_of(halves), resource_of(bytes), resource(answers)}, {count / 32});
    if (form == 0) expected = answers;
    CHECK((answers == expected));
  }
}
