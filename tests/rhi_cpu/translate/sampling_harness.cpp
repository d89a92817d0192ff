#include "tests/rhi_cpu/translate/sampling_harness.hpp"

#include <fmt/format.h>

#include "tests/rhi_cpu/translate/kernel_harness.hpp"
#include "tests/rhi_cpu/translate/kernel_images.hpp"

namespace tandem::test {
namespace {

/// Of each Ask, in its order. s is a sampler of its dimension.
struct Expression {
  const char* sampler;
  const char* glsl;
};
constexpr Expression expressions[] = {
    {"sampler1D", "textureLod(s, p.x, detail)"},
    {"sampler2D", "textureLod(s, p.xy, detail)"},
    {"sampler3D", "textureLod(s, p.xyz, detail)"},
    {"samplerCube", "textureLod(s, p.xyz, detail)"},
    {"sampler1DArray", "textureLod(s, p.xy, detail)"},
    {"sampler2DArray", "textureLod(s, p.xyz, detail)"},
    {"samplerCubeArray", "textureLod(s, p, detail)"},
    {"sampler1D", "textureGrad(s, p.x, dx.x, dy.x)"},
    {"sampler2D", "textureGrad(s, p.xy, dx.xy, dy.xy)"},
    {"sampler3D", "textureGrad(s, p.xyz, dx.xyz, dy.xyz)"},
    {"samplerCube", "textureGrad(s, p.xyz, dx.xyz, dy.xyz)"},
    {"sampler2D", "textureGradClampARB(s, p.xy, dx.xy, dy.xy, detail)"},
    {"sampler2D", "textureLodOffset(s, p.xy, detail, ivec2(1, -2))"},
    {"sampler2D", "textureProjLod(s, p.xyz, detail)"},
    {"sampler3D", "textureProjLod(s, p, detail)"},
    {"sampler2D", "textureGather(s, p.xy, 1)"},
    {"sampler2DArray", "textureGather(s, p.xyz, 3)"},
    {"samplerCube", "textureGather(s, p.xyz)"},
    {"sampler2D", "textureGatherOffset(s, p.xy, ivec2(1, 0), 2)"},
    {"sampler2D", "textureGatherOffsets(s, p.xy, offsets, 0)"},
    {"sampler2DShadow", "vec4(textureLod(s, p.xyz, detail))"},
    {"sampler2DShadow", "vec4(textureProjLod(s, p, detail))"},
    {"sampler1DArrayShadow", "vec4(textureGrad(s, p.xyz, 0.0, 0.0))"},
    {"samplerCubeShadow", "vec4(textureGrad(s, p, dx.xyz, dy.xyz))"},
    {"sampler2DShadow", "textureGather(s, p.xy, detail)"},
    {"sampler2DShadow", "textureGatherOffset(s, p.xy, detail, ivec2(0, 1))"},
    {"samplerCubeArrayShadow", "textureGather(s, p, detail)"},
};
constexpr std::size_t ask_count = std::size(expressions);
static_assert(ask_count == static_cast<std::size_t>(Ask::gather_compare_cube_array) + 1);

struct Input {
  Four at, dx, dy;
  float detail;
  Ask ask;
  float padding[2];
};

std::string shader() {
  std::string declarations, cases;
  for (std::size_t i = 0; i < ask_count; ++i) {
    std::string glsl = expressions[i].glsl;
    glsl.replace(glsl.find("(s,") + 1, 1, fmt::format("s{}", i));
    declarations += fmt::format("layout(binding = {}) uniform {} s{};\n", i + 2, expressions[i].sampler, i);
    cases += fmt::format("case {}: result = {}; break;\n", i, glsl);
  }
  return "#extension GL_ARB_sparse_texture_clamp : require\nlayout(local_size_x = 1) in;\n"
         "layout(binding = 0) buffer Input { vec4 p, dx, dy; float detail; int ask; };\n"
         "layout(binding = 1) buffer Result { vec4 result; };\n" +
         declarations +
         "const ivec2 offsets[4] = ivec2[4](ivec2(0), ivec2(1, 0), ivec2(0, 1), ivec2(-1));\n"
         "void main() {\nswitch (ask) {\n" +
         cases + "}\n}";
}

}  // namespace

Four sampled(const kernel::Image& image, const kernel::Sampler& sampler, const Query& query) {
  static const Kernel kernel(shader());
  std::vector<Input> input = {{query.at, query.dx, query.dy, query.detail, query.ask, {}}};
  std::vector<Four> result(1);
  const kernel::SampledImage texture = {&image, &sampler};
  std::vector<kernel::Resource> resources = {resource(input), resource(result)};
  resources.resize(2 + ask_count, resource_of(texture));
  kernel.run(resources);
  return result[0];
}

TestImage::TestImage(std::array<std::uint32_t, 3> size, std::uint32_t sides,
                     const std::vector<std::vector<float>>& levels, rhi::TextureFormat format) {
  for (std::size_t i = 0; i < levels.size(); ++i) {
    image_.level_offsets[i] = texels_.size() * sizeof(float);
    texels_.insert(texels_.end(), levels[i].begin(), levels[i].end());
  }
  image_.texels = reinterpret_cast<std::byte*>(texels_.data());
  for (std::size_t i = 0; i < 3; ++i) image_.size[i] = size[i];
  image_.format = static_cast<std::uint32_t>(format);
  image_.sides = sides;
  image_.level_count = static_cast<std::uint32_t>(levels.size());
}

}  // namespace tandem::test
