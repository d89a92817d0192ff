#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "conformance/kit/cases.hpp"
#include "conformance/kit/check.hpp"
#include "conformance/kit/shader_run.hpp"
#include "rhi/transfer.hpp"

/// samplers.*: sampled images and what reads them. Coordinates are multiples of a sixteenth of a texel, which every
/// device resolves (subTexelPrecisionBits >= 4), so that the weights of a linear filter are exact; the texels are small
/// integers in floats.
namespace tandem::conformance {
namespace {

using rhi::AddressMode;
using rhi::Filter;
using rhi::TextureDimension;
using rhi::TextureFormat;

/// Sums of a few products of exact numbers; what is left is a device's own arithmetic.
constexpr double filter_tolerance = 1e-4;

rhi::TextureHandle float_texture(rhi::Device& device, rhi::TextureDesc desc, const std::vector<float>& texels) {
  desc.format = TextureFormat::r32_float;
  if (desc.label.empty()) desc.label = "texels";
  if (!device.info().formats[static_cast<std::size_t>(desc.format)].filtered)
    throw Unsupported("the device does not filter r32_float");
  return rhi::create_filled(device, texels, desc);
}

/// Samples at points (u, v, w, lod), one answer each.
struct Samples {
  std::string label;
  std::string declaration;  ///< of `image` at binding 1
  std::string expression;   ///< a float, of vec4 p
  std::vector<std::array<float, 4>> points;
};

std::vector<float> sampled(Context& context, const Samples& samples, const std::vector<rhi::BindGroupEntry>& entries) {
  rhi::Device& device = context.device();
  std::vector<float> points;
  for (const std::array<float, 4>& point : samples.points) points.insert(points.end(), point.begin(), point.end());
  ShaderRun run = {.label = samples.label, .glsl = R"(
layout(local_size_x = 1) in;
layout(binding = 0) buffer Answers { float answers[]; };
layout(binding = 2) readonly buffer Points { vec4 points[]; };
)" + samples.declaration + R"(
void main() {
  uint i = gl_WorkGroupID.x;
  vec4 p = points[i];
  answers[i] = )" + samples.expression + ";\n}\n"};
  run.entries = entries;
  run.entries.push_back(
      {.binding = 2,
       .resource = rhi::BufferRange{rhi::create_filled(device, points, rhi::BufferUsage::storage, "points")}});
  run.workgroup_count = {static_cast<std::uint32_t>(samples.points.size()), 1, 1};
  return floats_of(answers(context, run, samples.points.size()));
}

void check_samples(Context& context, const Samples& samples, const std::vector<rhi::BindGroupEntry>& entries,
                   const std::vector<double>& expected, const std::string& what) {
  const std::vector<float> seen = sampled(context, samples, entries);
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const std::array<float, 4>& p = samples.points[i];
    check(std::abs(seen[i] - expected[i]) <= filter_tolerance,
          fmt::format("{} at ({}, {}, {}), level {}, is {:.7g}, expected {:.7g}", what, p[0], p[1], p[2], p[3], seen[i],
                      expected[i]));
  }
}

rhi::BindGroupEntry combined(rhi::Device& device, const rhi::TextureHandle& texture, rhi::SamplerDesc sampler) {
  if (sampler.label.empty()) sampler.label = "sampler";
  rhi::SampledTexture sampled;
  sampled.view.texture = texture;
  sampled.sampler = device.create_sampler(sampler);
  return {.binding = 1, .resource = sampled};
}

rhi::SamplerDesc filtered(Filter filter, AddressMode mode) {
  return {.magnification = filter,
          .minification = filter,
          .mipmap = filter,
          .address = {mode, mode, mode},
          .label = "sampler"};
}

/// Texel i of a line of `size` as an address mode has it; the border is -1. "Wrapping Operation".
int wrapped(int i, int size, AddressMode mode) {
  const auto modulo = [](int a, int b) { return ((a % b) + b) % b; };
  switch (mode) {
    case AddressMode::repeat:
      return modulo(i, size);
    case AddressMode::mirrored_repeat: {
      const int n = modulo(i, 2 * size) - size;
      return size - 1 - (n >= 0 ? n : -(1 + n));
    }
    case AddressMode::clamp_to_edge:
      return std::clamp(i, 0, size - 1);
    case AddressMode::clamp_to_border:
      return i < 0 || i >= size ? -1 : i;
    case AddressMode::mirror_clamp_to_edge:
      return std::clamp(i >= 0 ? i : -(1 + i), 0, size - 1);
  }
  return 0;
}

const char* name_of(AddressMode mode) {
  const char* const names[] = {"repeat", "mirrored_repeat", "clamp_to_edge", "clamp_to_border", "mirror_clamp_to_edge"};
  return names[static_cast<std::size_t>(mode)];
}

/// 4 x 2 texels, 1 to 8.
constexpr int width = 4, height = 2;

double texel_2d(int x, int y, AddressMode mode, double border) {
  const int i = wrapped(x, width, mode), j = wrapped(y, height, mode);
  return i < 0 || j < 0 ? border : 1 + i + width * j;
}

double expected_2d(double u, double v, Filter filter, AddressMode mode, double border) {
  const double x = u * width, y = v * height;
  if (filter == Filter::nearest)
    return texel_2d(static_cast<int>(std::floor(x)), static_cast<int>(std::floor(y)), mode, border);
  const double left = std::floor(x - 0.5), top = std::floor(y - 0.5);
  const double a = x - 0.5 - left, b = y - 0.5 - top;
  const int i = static_cast<int>(left), j = static_cast<int>(top);
  return (1 - a) * (1 - b) * texel_2d(i, j, mode, border) + a * (1 - b) * texel_2d(i + 1, j, mode, border) +
         (1 - a) * b * texel_2d(i, j + 1, mode, border) + a * b * texel_2d(i + 1, j + 1, mode, border);
}

void add_filter_cases(const Group& group) {
  for (const Filter filter : {Filter::nearest, Filter::linear}) {
    for (const AddressMode mode : {AddressMode::repeat, AddressMode::mirrored_repeat, AddressMode::clamp_to_edge,
                                   AddressMode::clamp_to_border, AddressMode::mirror_clamp_to_edge}) {
      const std::string name = (filter == Filter::nearest ? "nearest_" : "linear_") + std::string(name_of(mode));
      group.add(name, "a 2D texture is filtered and wrapped as the specification says", [=](Context& context) {
        rhi::Device& device = context.device();
        const rhi::TextureHandle texture =
            float_texture(device, {.size = {width, height, 1}, .label = "texels"}, {1, 2, 3, 4, 5, 6, 7, 8});
        Samples samples = {.label = "sample 2D",
                           .declaration = "layout(binding = 1) uniform sampler2D image;",
                           .expression = "textureLod(image, p.xy, p.w).x",
                           .points = {}};
        std::vector<double> expected;
        // Sixteenths of a texel, off the lines where nearest changes.
        for (int x = -9; x < 13; x += 2)
          for (int y = -5; y < 9; y += 3) {
            const double u = (x + 5.0 / 16) / width, v = (y + 11.0 / 16) / height;
            samples.points.push_back({static_cast<float>(u), static_cast<float>(v), 0, 0});
            expected.push_back(expected_2d(u, v, filter, mode, 1));
          }
        rhi::SamplerDesc sampler = filtered(filter, mode);
        sampler.border = rhi::BorderColor::float_opaque_white;
        check_samples(context, samples, {combined(device, texture, sampler)}, expected, name);
      });
    }
  }
}

void add_level_cases(const Group& group) {
  static constexpr auto texture_of_levels = [](rhi::Device& device) {
    std::vector<float> texels(16, 1);
    texels.insert(texels.end(), 4, 2.0f);
    texels.push_back(4);
    return float_texture(device, {.size = {4, 4, 1}, .level_count = 3, .label = "levels"}, texels);
  };
  const auto samples_at = [](std::vector<std::array<float, 4>> points) {
    return Samples{.label = "sample 2D",
                   .declaration = "layout(binding = 1) uniform sampler2D image;",
                   .expression = "textureLod(image, p.xy, p.w).x",
                   .points = std::move(points)};
  };
  group.add("nearest", "the nearest level is read", [=](Context& context) {
    const rhi::TextureHandle texture = texture_of_levels(context.device());
    check_samples(context, samples_at({{.5f, .5f, 0, 0}, {.5f, .5f, 0, .25f}, {.5f, .5f, 0, .75f}, {.5f, .5f, 0, 9}}),
                  {combined(context.device(), texture, filtered(Filter::nearest, AddressMode::repeat))}, {1, 1, 2, 4},
                  "the level");
  });
  group.add("linear", "two levels are blended", [=](Context& context) {
    const rhi::TextureHandle texture = texture_of_levels(context.device());
    check_samples(context, samples_at({{.5f, .5f, 0, .5f}, {.5f, .5f, 0, 1.25f}, {.5f, .5f, 0, -3}}),
                  {combined(context.device(), texture, filtered(Filter::linear, AddressMode::repeat))}, {1.5, 2.5, 1},
                  "the blend");
  });
  group.add("bias_and_clamp", "the bias is added, then the level is clamped", [=](Context& context) {
    const rhi::TextureHandle texture = texture_of_levels(context.device());
    rhi::SamplerDesc sampler = filtered(Filter::linear, AddressMode::repeat);
    sampler.lod_bias = 1;
    sampler.min_lod = 0.5;
    sampler.max_lod = 1.5;
    check_samples(context, samples_at({{.5f, .5f, 0, -2}, {.5f, .5f, 0, .25f}, {.5f, .5f, 0, 2}}),
                  {combined(context.device(), texture, sampler)}, {1.5, 2.5, 3}, "the level");
  });
  group.add("gradients", "explicit derivatives choose the level", [=](Context& context) {
    const rhi::TextureHandle texture = texture_of_levels(context.device());
    Samples samples = {.label = "sample with gradients",
                       .declaration = "layout(binding = 1) uniform sampler2D image;",
                       .expression = "textureGrad(image, p.xy, vec2(p.z, 0), vec2(0, p.w)).x",
                       .points = {{.5f, .5f, .25f, .25f}, {.5f, .5f, .5f, .25f}, {.5f, .5f, 0, 1}}};
    check_samples(context, samples,
                  {combined(context.device(), texture, filtered(Filter::nearest, AddressMode::repeat))}, {1, 2, 4},
                  "the level");
  });
}

void add_dimension_cases(const Group& group) {
  group.add("d1", "a 1D texture is filtered along its line", [](Context& context) {
    const rhi::TextureHandle texture = float_texture(
        context.device(), {.dimension = TextureDimension::d1, .size = {4, 1, 1}, .label = "line"}, {1, 2, 4, 8});
    const Samples samples = {.label = "sample 1D",
                             .declaration = "layout(binding = 1) uniform sampler1D image;",
                             .expression = "textureLod(image, p.x, 0).x",
                             .points = {{.25f, 0, 0, 0}, {.5f, 0, 0, 0}, {0, 0, 0, 0}}};
    check_samples(context, samples,
                  {combined(context.device(), texture, filtered(Filter::linear, AddressMode::repeat))}, {1.5, 3, 4.5},
                  "the line");
  });
  group.add("d3", "a 3D texture is filtered between eight texels", [](Context& context) {
    const rhi::TextureHandle texture =
        float_texture(context.device(), {.dimension = TextureDimension::d3, .size = {2, 2, 2}, .label = "volume"},
                      {0, 1, 2, 3, 4, 5, 6, 7});
    const Samples samples = {.label = "sample 3D",
                             .declaration = "layout(binding = 1) uniform sampler3D image;",
                             .expression = "textureLod(image, p.xyz, 0).x",
                             .points = {{.5f, .5f, .5f, 0}, {.25f, .25f, .25f, 0}, {.75f, .5f, .25f, 0}}};
    check_samples(context, samples,
                  {combined(context.device(), texture, filtered(Filter::linear, AddressMode::clamp_to_edge))},
                  {3.5, 0, 2}, "the volume");
  });
  group.add("d2_array", "the layer is the nearest one, clamped", [](Context& context) {
    const rhi::TextureHandle texture =
        float_texture(context.device(), {.dimension = TextureDimension::d2_array, .size = {1, 1, 4}, .label = "layers"},
                      {10, 20, 30, 40});
    const Samples samples = {
        .label = "sample 2D array",
        .declaration = "layout(binding = 1) uniform sampler2DArray image;",
        .expression = "textureLod(image, p.xyz, 0).x",
        .points = {{.5f, .5f, 0, 0}, {.5f, .5f, 1.25f, 0}, {.5f, .5f, 1.75f, 0}, {.5f, .5f, 9, 0}}};
    check_samples(context, samples,
                  {combined(context.device(), texture, filtered(Filter::linear, AddressMode::repeat))},
                  {10, 20, 30, 40}, "the layer");
  });
  group.add("cube", "a direction chooses the face of a cube", [](Context& context) {
    const rhi::TextureHandle texture =
        float_texture(context.device(), {.dimension = TextureDimension::cube, .size = {2, 2, 6}, .label = "cube"},
                      {1, 2, 3, 4, 11, 12, 13, 14, 21, 22, 23, 24, 31, 32, 33, 34, 41, 42, 43, 44, 51, 52, 53, 54});
    // "Cube Map Face Selection": +X has s along -Z and t along -Y, -X s along +Z; +Y t along +Z, -Y t along -Z; ...
    const Samples samples = {.label = "sample cube",
                             .declaration = "layout(binding = 1) uniform samplerCube image;",
                             .expression = "textureLod(image, p.xyz, 0).x",
                             .points = {{1, .5f, .5f, 0},
                                        {-1, .5f, -.5f, 0},
                                        {.5f, 1, .5f, 0},
                                        {-.5f, -1, .5f, 0},
                                        {.5f, -.5f, 1, 0},
                                        {.5f, .5f, -1, 0}}};
    check_samples(context, samples,
                  {combined(context.device(), texture, filtered(Filter::nearest, AddressMode::clamp_to_edge))},
                  {1, 11, 24, 31, 44, 51}, "the face");
  });
}

void add_special_cases(const Group& group) {
  group.add("compare", "a shadow sampler compares each texel", [](Context& context) {
    rhi::Device& device = context.device();
    const TextureFormat format = TextureFormat::d32_float;
    if (!device.info().formats[static_cast<std::size_t>(format)].sampled)
      throw Unsupported("the device does not sample d32_float");
    const rhi::TextureHandle texture = rhi::create_filled(device, std::vector<float>{.25f, .75f},
                                                          {.format = format, .size = {2, 1, 1}, .label = "depths"});
    const Samples samples = {.label = "sample shadow",
                             .declaration = "layout(binding = 1) uniform sampler2DShadow image;",
                             .expression = "textureLod(image, p.xyz, 0)",
                             .points = {{.25f, .5f, .5f, 0}, {.75f, .5f, .5f, 0}, {.25f, .5f, .125f, 0}}};
    rhi::SamplerDesc sampler = filtered(Filter::nearest, AddressMode::clamp_to_edge);
    sampler.compare = rhi::CompareOp::less_or_equal;
    check_samples(context, samples, {combined(device, texture, sampler)}, {0, 1, 1}, "less or equal");
    sampler.compare = rhi::CompareOp::greater;
    check_samples(context, samples, {combined(device, texture, sampler)}, {1, 0, 0}, "greater");
  });
  group.add("gather", "a gather returns the four texels of a linear filter in their order", [](Context& context) {
    const rhi::TextureHandle texture =
        float_texture(context.device(), {.size = {width, height, 1}, .label = "texels"}, {1, 2, 3, 4, 5, 6, 7, 8});
    const Samples samples = {
        .label = "gather",
        .declaration = "layout(binding = 1) uniform sampler2D image;",
        .expression =
            "dot(textureGather(image, p.xy), vec4(1, 10, 100, 1000)) + textureGatherOffset(image, p.xy, "
            "ivec2(1, 0)).w * 10000",
        .points = {{.25f, .5f, 0, 0}, {.5f, .5f, 0, 0}}};
    check_samples(context, samples,
                  {combined(context.device(), texture, filtered(Filter::linear, AddressMode::clamp_to_edge))},
                  {5 + 60 + 200 + 1000 + 20000, 6 + 70 + 300 + 2000 + 30000}, "the gather");
  });
  group.add("fetch_and_sizes", "texels are fetched by level, and sizes and levels are told", [](Context& context) {
    std::vector<float> texels(32, 1);
    for (int i = 0; i < 8; ++i) texels.push_back(static_cast<float>(10 + i));
    const rhi::TextureHandle texture =
        float_texture(context.device(), {.size = {8, 4, 1}, .level_count = 2, .label = "levels"}, texels);
    const Samples samples = {
        .label = "fetch",
        .declaration = "layout(binding = 1) uniform sampler2D image;",
        .expression =
            "texelFetch(image, ivec2(p.xy), int(p.w)).x + texelFetchOffset(image, ivec2(p.xy), int(p.w), "
            "ivec2(1, 0)).x * 100 + float(textureSize(image, int(p.w)).x * 10000 + "
            "textureQueryLevels(image) * 100000)",
        .points = {{1, 1, 0, 1}, {2, 0, 0, 0}}};
    check_samples(context, samples,
                  {combined(context.device(), texture, filtered(Filter::nearest, AddressMode::repeat))},
                  {15 + 1600 + 40000 + 200000, 1 + 100 + 80000 + 200000}, "the fetch");
  });
  group.add("offset", "an offset moves the footprint by texels", [](Context& context) {
    const rhi::TextureHandle texture =
        float_texture(context.device(), {.size = {width, height, 1}, .label = "texels"}, {1, 2, 3, 4, 5, 6, 7, 8});
    const Samples samples = {.label = "sample with offset",
                             .declaration = "layout(binding = 1) uniform sampler2D image;",
                             .expression =
                                 "textureLodOffset(image, p.xy, 0, ivec2(1, -1)).x + "
                                 "100 * textureProjLod(image, vec3(p.xy * 2, 2), 0).x",
                             .points = {{.375f, .75f, 0, 0}, {.875f, .75f, 0, 0}}};
    check_samples(context, samples,
                  {combined(context.device(), texture, filtered(Filter::nearest, AddressMode::repeat))},
                  {3 + 600, 1 + 800}, "the offset");
  });
  group.add("unnormalized", "unnormalised coordinates are texels", [](Context& context) {
    const rhi::TextureHandle texture =
        float_texture(context.device(), {.size = {width, height, 1}, .label = "texels"}, {1, 2, 3, 4, 5, 6, 7, 8});
    const Samples samples = {.label = "sample 2D",
                             .declaration = "layout(binding = 1) uniform sampler2D image;",
                             .expression = "textureLod(image, p.xy, p.w).x",
                             .points = {{1.5f, .5f, 0, 0}, {2, 1, 0, 0}, {-3, 9, 0, 0}}};
    const rhi::SamplerDesc sampler = {
        .magnification = Filter::linear,
        .minification = Filter::linear,
        .address = {AddressMode::clamp_to_edge, AddressMode::clamp_to_edge, AddressMode::clamp_to_edge},
        .max_lod = 0,
        .unnormalized_coordinates = true,
        .label = "sampler"};
    check_samples(context, samples, {combined(context.device(), texture, sampler)}, {2, 4.5, 5}, "the texel");
  });
  group.add("separate", "an image and a sampler may be bound apart, and in arrays", [](Context& context) {
    rhi::Device& device = context.device();
    const rhi::TextureHandle first = float_texture(device, {.size = {2, 1, 1}, .label = "first"}, {1, 2});
    const rhi::TextureHandle second = float_texture(device, {.size = {2, 1, 1}, .label = "second"}, {10, 20});
    const Samples samples = {
        .label = "sample apart",
        .declaration =
            "layout(binding = 1) uniform texture2D images[2];\nlayout(binding = 3) uniform sampler samplers[2];",
        .expression = "textureLod(sampler2D(images[int(p.z)], samplers[int(p.w)]), p.xy, 0).x",
        .points = {{.5f, .5f, 0, 0}, {.5f, .5f, 1, 0}, {.625f, .5f, 0, 1}, {.625f, .5f, 1, 1}}};
    const rhi::SamplerHandle linear = device.create_sampler(filtered(Filter::linear, AddressMode::clamp_to_edge));
    const rhi::SamplerHandle nearest = device.create_sampler(filtered(Filter::nearest, AddressMode::clamp_to_edge));
    check_samples(context, samples,
                  {{.binding = 1, .resource = first},
                   {.binding = 1, .resource = second, .array_element = 1},
                   {.binding = 3, .resource = linear},
                   {.binding = 3, .resource = nearest, .array_element = 1}},
                  {1.5, 15, 2, 20}, "the image");
  });
  group.add("integers", "a texture of integers is read exactly", [](Context& context) {
    rhi::Device& device = context.device();
    const rhi::TextureHandle texture =
        rhi::create_filled(device, std::vector<std::uint32_t>{1, 2, 3, 4000000000u},
                           {.format = TextureFormat::r32_uint, .size = {2, 2, 1}, .label = "integers"});
    ShaderRun run = {.label = "sample integers", .glsl = R"(
layout(local_size_x = 1) in;
layout(binding = 0) buffer Answers { uint answers[2]; };
layout(binding = 1) uniform usampler2D image;
void main() {
  answers[0] = textureLod(image, vec2(0.75, 0.75), 0).x;
  answers[1] = texelFetch(image, ivec2(1, 0), 0).x;
}
)"};
    run.entries = {combined(device, texture, filtered(Filter::nearest, AddressMode::repeat))};
    check_words(answers(context, run, 2), Words{4000000000u, 2});
  });
}

}  // namespace

void add_sampler_cases(Cases& cases) {
  add_filter_cases({cases, "samplers.filters", {}});
  add_level_cases({cases, "samplers.levels", {}});
  add_dimension_cases({cases, "samplers.dimensions", {}});
  add_special_cases({cases, "samplers.operations", {}});
}

}  // namespace tandem::conformance
