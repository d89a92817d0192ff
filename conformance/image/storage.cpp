#include <bit>
#include <cmath>
#include <cstring>
#include <string>

#include "conformance/image/texels.hpp"
#include "conformance/kit/cases.hpp"
#include "conformance/kit/check.hpp"
#include "conformance/kit/shader_run.hpp"
#include "rhi/transfer.hpp"

/// images.*: storage images of every format and dimension, their levels and layers, and atomic operations.
namespace tandem::conformance {
namespace {

using rhi::ComponentKind;
using rhi::TextureDimension;
using rhi::TextureFormat;

/// Stores four values, and reads the four texels of another image, whose format only the host knows.
const std::string format_shader = R"(
#extension GL_EXT_shader_image_load_formatted : require
layout(local_size_x = 1) in;
layout(binding = 0) buffer Answers { COMPONENT answers[16]; };
layout(binding = 1) uniform writeonly PREFIXimage2D stored;
layout(binding = 2) uniform readonly PREFIXimage2D loaded;
layout(binding = 3) readonly buffer Values { COMPONENT values[16]; };
void main() {
  for (int i = 0; i < 4; ++i) {
    imageStore(stored, ivec2(i, 0), PREFIXvec4(values[4 * i], values[4 * i + 1], values[4 * i + 2], values[4 * i + 3]));
    PREFIXvec4 texel = imageLoad(loaded, ivec2(i, 0));
    for (int k = 0; k < 4; ++k) answers[4 * i + k] = texel[k];
  }
}
)";

struct FormatCase {
  ComponentKind kind;
  std::string prefix;     ///< of image2D and vec4
  std::string component;  ///< float, uint or int
  std::array<Value, 4> values;
};

std::uint32_t bits_of(const FormatCase& format_case, double value) {
  if (format_case.component == "float") return std::bit_cast<std::uint32_t>(static_cast<float>(value));
  return static_cast<std::uint32_t>(static_cast<std::int64_t>(value));
}

double value_of(const FormatCase& format_case, std::uint32_t bits) {
  if (format_case.component == "float") return std::bit_cast<float>(bits);
  return format_case.component == "int" ? static_cast<double>(static_cast<std::int32_t>(bits))
                                        : static_cast<double>(bits);
}

/// Floats of 10 or 11 bits have no sign.
Value fitted(TextureFormat format, Value value) {
  if (format == TextureFormat::rg11b10_float)
    for (double& each : value) each = std::abs(each);
  return value;
}

void check_format(Context& context, const FormatCase& format_case, TextureFormat format) {
  rhi::Device& device = context.device();
  const std::string name(rhi::info_of(format).name);
  std::vector<std::uint8_t> bytes;
  Words values;
  for (const Value& each : format_case.values) {
    const std::vector<std::uint8_t> texel = encoded(format, fitted(format, each));
    bytes.insert(bytes.end(), texel.begin(), texel.end());
    for (const double component : fitted(format, each)) values.push_back(bits_of(format_case, component));
  }
  const rhi::TextureDesc desc = {.format = format, .size = {4, 1, 1}, .label = name};
  const rhi::TextureHandle stored = device.create_texture(desc);
  const rhi::TextureHandle loaded = rhi::create_filled(device, bytes, desc);
  ShaderRun run = {.label = "formats of " + format_case.component,
                   .glsl = with(with(format_shader, "PREFIX", format_case.prefix), "COMPONENT", format_case.component)};
  run.entries = {{.binding = 1, .resource = stored},
                 {.binding = 2, .resource = loaded},
                 {.binding = 3, .resource = rhi::BufferRange{words_buffer(device, values, "values")}}};
  const Words read = answers(context, run, 16);
  const std::vector<std::byte> written = rhi::read(device, stored);
  for (std::size_t i = 0; i < bytes.size(); ++i)
    check_equal(fmt::format("byte {} of the texels stored as {}", i, name), static_cast<unsigned>(written[i]),
                bytes[i]);
  for (std::size_t i = 0; i < 16; ++i) {
    const double expected = read_back(format, fitted(format, format_case.values[i / 4]))[i % 4];
    const double seen = value_of(format_case, read[i]);
    // A quotient of two integers is rounded, by a driver perhaps twice.
    check(std::abs(seen - expected) <= 2e-7 * std::abs(expected),
          fmt::format("component {} of a texel of {} reads as {:.9g}, expected {:.9g}", i % 4, name, seen, expected));
  }
}

void add_format_cases(const Group& group) {
  const FormatCase kinds[] = {
      {ComponentKind::unorm,
       "",
       "float",
       {{{0, 1, 0.2, 0.71}, {1, 0.2, 0, 1}, {-3, 7, 0.93, 0.12}, {0.31, 0.6, 1, 0}}}},
      {ComponentKind::snorm, "", "float", {{{0, 1, -0.2, -1}, {-1, 0.2, 0, 1}, {-3, 7, 0.9, -0.1}, {0.3, -0.6, 1, 0}}}},
      {ComponentKind::floating,
       "",
       "float",
       {{{0, 1, -2, 0.5}, {1.5, -0.25, 96, 1}, {3, 7, -0.75, 1024}, {5, 6, 1, 0}}}},
      {ComponentKind::uint, "u", "uint", {{{0, 1, 2, 3}, {3, 2, 1, 0}, {1, 3, 3, 1}, {2, 0, 1, 2}}}},
      {ComponentKind::sint, "i", "int", {{{0, 1, -2, -128}, {127, -1, 0, 5}, {100, -100, 3, 4}, {-7, 8, -9, 10}}}}};
  const char* const names[] = {"unorm", "snorm", "float", "uint", "sint"};
  for (std::size_t kind = 0; kind < 5; ++kind)
    group.add(names[kind], std::string("texels of every ") + names[kind] + " format are stored and read exactly",
              [format_case = kinds[kind]](Context& context) {
                std::string missing;
                bool any = false;
                for (std::size_t i = 0; i < rhi::texture_format_count; ++i) {
                  const auto format = static_cast<TextureFormat>(i);
                  const rhi::TextureFormatInfo& info = rhi::info_of(format);
                  if (info.kind != format_case.kind || format == TextureFormat::rgba8_srgb ||
                      format == TextureFormat::bgra8_unorm || info.size / info.components == 8)
                    continue;
                  if (context.device().info().formats[i].storage) {
                    any = true;
                    check_format(context, format_case, format);
                  } else {
                    missing += (missing.empty() ? "" : ", ") + std::string(info.name);
                  }
                }
                if (!any) throw Unsupported("the device has no storage images of such formats");
                if (!missing.empty()) context.note("not storage formats here: " + missing);
              });
}

struct DimensionCase {
  const char* name;
  const char* image;       ///< GLSL type without its prefix
  const char* coordinate;  ///< of the texel x, y, z
  rhi::TextureDimension dimension;
  std::array<std::uint32_t, 3> size;
  const char* size_in_shader;  ///< as uvec3
};

const DimensionCase dimension_cases[] = {
    {"d1", "image1D", "int(at.x)", TextureDimension::d1, {5, 1, 1}, "uvec3(imageSize(stored), 1, 1)"},
    {"d2", "image2D", "ivec2(at.xy)", TextureDimension::d2, {5, 3, 1}, "uvec3(imageSize(stored), 1)"},
    {"d3", "image3D", "ivec3(at)", TextureDimension::d3, {5, 3, 2}, "uvec3(imageSize(stored))"},
    {"cube", "imageCube", "ivec3(at)", TextureDimension::cube, {3, 3, 6}, "uvec3(imageSize(stored), 6)"},
    {"d1_array",
     "image1DArray",
     "ivec2(at.xz)",
     TextureDimension::d1_array,
     {5, 1, 3},
     "uvec3(imageSize(stored).x, 1, imageSize(stored).y)"},
    {"d2_array", "image2DArray", "ivec3(at)", TextureDimension::d2_array, {5, 3, 4}, "uvec3(imageSize(stored))"},
    {"cube_array",
     "imageCubeArray",
     "ivec3(at)",
     TextureDimension::cube_array,
     {2, 2, 12},
     "uvec3(imageSize(stored).xy, imageSize(stored).z * 6)"}};

/// Every texel gets its number, and what lies outside of the image stays unwritten and reads as zero.
void check_dimension(Context& context, const DimensionCase& dimension) {
  rhi::Device& device = context.device();
  if (dimension.dimension == TextureDimension::cube_array && !device.info().capabilities.cube_arrays)
    throw Unsupported("the device has no arrays of cubes");
  const rhi::TextureDesc desc = {.dimension = dimension.dimension,
                                 .format = TextureFormat::r32_uint,
                                 .size = dimension.size,
                                 .label = dimension.name};
  std::string glsl = R"(
layout(local_size_x = 1) in;
layout(binding = 0) buffer Answers { uint answers[4]; };
layout(binding = 1, r32ui) uniform uIMAGE stored;
void main() {
  uvec3 size = SIZE;
  uint sum = 0;
  for (uint z = 0; z < size.z; ++z)
    for (uint y = 0; y < size.y; ++y)
      for (uint x = 0; x < size.x; ++x) {
        uvec3 at = uvec3(x, y, z);
        imageStore(stored, AT, uvec4(1 + x + 10 * y + 100 * z));
        sum += imageLoad(stored, AT).x;
        imageAtomicAdd(stored, AT, 1000);
      }
  answers[0] = size.x;
  answers[1] = size.y;
  answers[2] = size.z;
  answers[3] = sum;
}
)";
  glsl = with(with(with(glsl, "IMAGE", dimension.image), "SIZE", dimension.size_in_shader), "AT", dimension.coordinate);
  const rhi::TextureHandle texture =
      rhi::create_filled(device, Words(dimension.size[0] * dimension.size[1] * dimension.size[2]), desc);
  ShaderRun run = {.label = std::string("image of dimension ") + dimension.name, .glsl = glsl};
  run.entries = {{.binding = 1, .resource = texture}};
  Words expected;
  std::uint32_t sum = 0;
  for (std::uint32_t z = 0; z < dimension.size[2]; ++z)
    for (std::uint32_t y = 0; y < dimension.size[1]; ++y)
      for (std::uint32_t x = 0; x < dimension.size[0]; ++x) {
        sum += 1 + x + 10 * y + 100 * z;
        expected.push_back(1001 + x + 10 * y + 100 * z);
      }
  check_words(answers(context, run, 4), Words{dimension.size[0], dimension.size[1], dimension.size[2], sum});
  const std::vector<std::byte> bytes = rhi::read(device, texture);
  Words seen(bytes.size() / 4);
  std::memcpy(seen.data(), bytes.data(), bytes.size());
  check_words(seen, expected);
}

void add_view_cases(const Group& group) {
  group.add("level_and_layer", "a storage image may be one level and some layers of a texture", [](Context& context) {
    rhi::Device& device = context.device();
    const rhi::TextureDesc desc = {.dimension = TextureDimension::d2_array,
                                   .format = TextureFormat::r32_uint,
                                   .size = {4, 2, 3},
                                   .level_count = 2,
                                   .label = "levels"};
    const rhi::TextureHandle texture = rhi::create_filled(device, Words(24 + 6), desc);
    ShaderRun run = {.label = "level and layer", .glsl = R"(
layout(local_size_x = 1) in;
layout(binding = 0) buffer Answers { uint answers[2]; };
layout(binding = 1, r32ui) uniform uimage2D stored;
void main() {
  answers[0] = imageSize(stored).x;
  answers[1] = imageSize(stored).y;
  imageStore(stored, ivec2(1, 0), uvec4(7));
}
)"};
    run.entries = {{.binding = 1,
                    .resource = rhi::TextureView{.texture = texture,
                                                 .first_level = 1,
                                                 .level_count = 1,
                                                 .first_layer = 2,
                                                 .layer_count = 1,
                                                 .dimension = TextureDimension::d2}}};
    check_words(answers(context, run, 2), Words{2, 1});
    Words expected(30);
    expected[24 + 2 * 2 + 1] = 7;
    const std::vector<std::byte> bytes = rhi::read(device, texture);
    Words seen(bytes.size() / 4);
    std::memcpy(seen.data(), bytes.data(), bytes.size());
    check_words(seen, expected);
  });
}

void add_texel_buffer_cases(const Group& group) {
  group.add("storage", "a storage texel buffer is written and read in its format", [](Context& context) {
    rhi::Device& device = context.device();
    const rhi::BufferHandle bytes =
        rhi::create_filled(device, Words{0xff00ff00, 0, 0}, rhi::BufferUsage::storage_texels, "texels");
    ShaderRun run = {.label = "storage texel buffer", .glsl = R"(
layout(local_size_x = 1) in;
layout(binding = 0) buffer Answers { uint answers[5]; };
layout(binding = 1, rgba8) uniform imageBuffer texels;
void main() {
  vec4 texel = imageLoad(texels, 0);
  for (int i = 0; i < 4; ++i) answers[i] = uint(texel[i]);
  answers[4] = imageSize(texels);
  imageStore(texels, 2, vec4(1, 0, 0, 1));
}
)"};
    run.entries = {{.binding = 1, .resource = rhi::TexelBuffer{{bytes}, TextureFormat::rgba8_unorm}}};
    check_words(answers(context, run, 5), Words{0, 1, 0, 1, 3});
    check_words(rhi::read<std::uint32_t>(device, bytes, 3), Words{0xff00ff00, 0, 0xff0000ff});
  });
  group.add("uniform", "a uniform texel buffer is fetched from in its format", [](Context& context) {
    rhi::Device& device = context.device();
    const rhi::BufferHandle bytes =
        rhi::create_filled(device, Words{0, 0x00010003, 0x00050009}, rhi::BufferUsage::uniform_texels, "texels");
    ShaderRun run = {.label = "uniform texel buffer", .glsl = R"(
#extension GL_EXT_samplerless_texture_functions : require
layout(local_size_x = 1) in;
layout(binding = 0) buffer Answers { uint answers[5]; };
layout(binding = 1) uniform utextureBuffer texels;
void main() {
  uvec4 texel = texelFetch(texels, 2);
  for (int i = 0; i < 4; ++i) answers[i] = texel[i];
  answers[4] = textureSize(texels);
}
)"};
    run.entries = {{.binding = 1, .resource = rhi::TexelBuffer{{bytes}, TextureFormat::rg16_uint}}};
    check_words(answers(context, run, 5), Words{9, 5, 0, 1, 3});
  });
}

}  // namespace

void add_storage_image_cases(Cases& cases) {
  add_format_cases({cases, "images.formats", {}});
  const Group dimensions = {cases, "images.dimensions", {}};
  for (const DimensionCase& dimension : dimension_cases)
    dimensions.add(dimension.name,
                   std::string("every texel of ") + dimension.image + " can be stored, read and added to",
                   [dimension](Context& context) { check_dimension(context, dimension); });
  add_view_cases({cases, "images.views", {}});
  add_texel_buffer_cases({cases, "images.texel_buffers", {}});
}

}  // namespace tandem::conformance
