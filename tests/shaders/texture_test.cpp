#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <vector>

#include <glm/glm.hpp>
#include <glm/gtc/packing.hpp>

#include "pathtracer/scene/scene.hpp"
#include "tests/shaders/random_source.hpp"
#include "tests/shaders/scene_kernel.hpp"
#include "tests/support/device_test.hpp"

using namespace tandem;
using namespace tandem::pathtracer;

namespace {

constexpr TexelFormat formats[] = {TexelFormat::unorm8, TexelFormat::srgb8,   TexelFormat::unorm16,
                                   TexelFormat::half,   TexelFormat::float32, TexelFormat::single_unorm8};

/// A scene must have something in it.
Scene scene_with_triangle() {
  Scene scene;
  scene.name = "test";
  scene.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  scene.normals.resize(3);
  scene.triangles.push_back({{0, 1, 2}, 0});
  scene.materials.push_back(diffuse_material(glm::vec3(0.5f)));
  return scene;
}

template <typename T>
void append(std::vector<std::byte>& bytes, T value) {
  const auto parts = std::as_bytes(std::span(&value, 1));
  bytes.insert(bytes.end(), parts.begin(), parts.end());
}

double srgb_to_linear(double encoded) {
  return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

/// An image with what its texels mean, in double precision, row by row from the top.
struct KnownImage {
  TextureImage image;
  std::vector<glm::dvec4> values;
};

KnownImage random_image(TexelFormat format, std::uint32_t width, std::uint32_t height, test::RandomSource& random) {
  KnownImage known;
  known.image = {.name = "random", .format = format, .width = width, .height = height, .texels = {}};
  for (std::uint32_t i = 0; i < width * height; ++i) {
    glm::dvec4 value;
    for (int channel = 0; channel < 4; ++channel) {
      const std::uint32_t bits = random.bits();
      switch (format) {
        case TexelFormat::half: {
          const auto half = glm::packHalf1x16(static_cast<float>(random.uniform(-8, 8)));
          append(known.image.texels, half);
          value[channel] = double{glm::unpackHalf1x16(half)};
          break;
        }
        case TexelFormat::float32: {
          const auto number = static_cast<float>(random.uniform(-8, 8));
          append(known.image.texels, number);
          value[channel] = double{number};
          break;
        }
        case TexelFormat::unorm16:
          append(known.image.texels, static_cast<std::uint16_t>(bits >> 16));
          value[channel] = (bits >> 16) / 65535.0;
          break;
        case TexelFormat::single_unorm8:
          if (channel == 0) append(known.image.texels, static_cast<std::uint8_t>(bits >> 24));
          value[channel] = channel == 0 ? (bits >> 24) / 255.0 : value[0];
          break;
        default:
          append(known.image.texels, static_cast<std::uint8_t>(bits >> 24));
          value[channel] = (bits >> 24) / 255.0;
          if (format == TexelFormat::srgb8 && channel < 3) value[channel] = srgb_to_linear(value[channel]);
      }
    }
    known.values.push_back(value);
  }
  return known;
}

struct Place {
  std::uint32_t texture;
  glm::vec2 uv;
  glm::vec3 position{0};
};

/// r, g, b, alpha and the number of the texture's channel at each place.
std::vector<float> read_textures(rhi::Device& device, const Scene& scene, const std::vector<Place>& places) {
  std::vector<std::uint32_t> inputs;
  for (const Place& place : places) {
    inputs.push_back(place.texture);
    for (const float value : {place.uv.x, place.uv.y, place.position.x, place.position.y, place.position.z})
      inputs.push_back(std::bit_cast<std::uint32_t>(value));
  }
  const std::vector<std::uint32_t> bits = test::run_bits(device, scene,
                                                         {.includes = "#include \"texture/texture.glsl\"",
                                                          .body = R"(
    vec2 uv = vec2(input_float(1), input_float(2));
    vec3 position = vec3(input_float(3), input_float(4), input_float(5));
    vec4 value = texture_at(input_bits(0), both_sets(uv), position);
    output_float(0, value.x); output_float(1, value.y); output_float(2, value.z); output_float(3, value.w);
    output_float(4, texture_value(input_bits(0), both_sets(uv), position));)",
                                                          .input_count = 6,
                                                          .output_count = 5},
                                                         inputs);
  std::vector<float> values;
  for (const std::uint32_t word : bits) values.push_back(std::bit_cast<float>(word));
  return values;
}

glm::dvec4 color_at(const std::vector<float>& outputs, std::size_t row) {
  return {outputs[5 * row], outputs[5 * row + 1], outputs[5 * row + 2], outputs[5 * row + 3]};
}

/// Where on an axis of texels from 0 to `count` a coordinate lies, and which texel an index means.
double axis_place(double coordinate, std::uint32_t count, TextureAddress address) {
  if (address == TextureAddress::repeat) coordinate -= std::floor(coordinate);
  if (address == TextureAddress::clamp) coordinate = std::clamp(coordinate, 0.0, 1.0);
  if (address == TextureAddress::mirror) coordinate = std::abs(coordinate - 2 * std::round(coordinate / 2));
  return coordinate * count;
}

std::uint32_t axis_texel(int index, std::uint32_t count, TextureAddress address) {
  const int size = static_cast<int>(count);
  if (address == TextureAddress::repeat) return static_cast<std::uint32_t>((index + size) % size);
  return static_cast<std::uint32_t>(std::clamp(index, 0, size - 1));
}

/// By the definition, from the sum over the four texels around.
glm::dvec4 reference(const KnownImage& known, const GpuTexture& texture, const glm::dvec2& uv) {
  const std::uint32_t width = known.image.width, height = known.image.height;
  const TextureAddress across{texture.address & 0xff}, upwards{texture.address >> 8};
  const double x = axis_place(uv.x, width, across), y = axis_place(uv.y, height, upwards);
  const auto texel = [&](int column, int row_from_below) {
    const std::uint32_t row = height - 1 - axis_texel(row_from_below, height, upwards);
    return known.values[row * width + axis_texel(column, width, across)];
  };
  if (texture.filter == TextureFilter::nearest) return texel(int(x), int(y));
  glm::dvec4 sum(0);
  for (int row = int(std::floor(y - 0.5)), i = 0; i < 2; ++i)
    for (int column = int(std::floor(x - 0.5)), j = 0; j < 2; ++j)
      sum += (1 - std::abs(x - 0.5 - (column + j))) * (1 - std::abs(y - 0.5 - (row + i))) * texel(column + j, row + i);
  return sum;
}

/// Whether rounding could take another texel.
bool near_edge(double place) { return std::abs(place - std::round(place)) < 1e-4; }

}  // namespace

TANDEM_DEVICE_TEST("Images in every format, address mode and filter are what double precision says") {
  test::RandomSource random(41);
  Scene scene = scene_with_triangle();
  std::vector<KnownImage> images;
  for (const TexelFormat format : formats) {
    // One row of an odd number of bytes, so that the texels of what follows begin in the next word.
    images.push_back(random_image(format, 7, 5, random));
    scene.images.push_back(images.back().image);
    for (std::uint32_t across = 0; across < 3; ++across)
      for (std::uint32_t upwards = 0; upwards < 3; ++upwards)
        for (const TextureFilter filter : {TextureFilter::nearest, TextureFilter::linear}) {
          Texture texture{.gpu = {}, .image = static_cast<std::uint32_t>(scene.images.size() - 1)};
          texture.gpu.address = across | upwards << 8;
          texture.gpu.filter = filter;
          scene.textures.push_back(texture);
        }
  }
  std::vector<Place> places;
  std::vector<glm::dvec4> expected;
  while (places.size() < 60000) {
    const auto index = static_cast<std::uint32_t>(places.size() % scene.textures.size());
    const Texture& texture = scene.textures[index];
    const float u = static_cast<float>(random.uniform(-3, 3)), v = static_cast<float>(random.uniform(-3, 3));
    const bool nearest = texture.gpu.filter == TextureFilter::nearest;
    if (nearest && (near_edge(7.0 * double{u}) || near_edge(5.0 * double{v}))) continue;
    places.push_back({.texture = index, .uv = {u, v}});
    expected.push_back(reference(images[texture.image], texture.gpu, {u, v}));
  }
  const std::vector<float> outputs = read_textures(device, scene, places);
  std::array<double, std::size(formats)> worst{};
  for (std::size_t i = 0; i < places.size(); ++i) {
    const glm::dvec4 error = glm::abs(color_at(outputs, i) - expected[i]);
    double& largest = worst[scene.textures[places[i].texture].image];
    largest = std::max({largest, error.x, error.y, error.z, error.w});
  }
  for (std::size_t i = 0; i < worst.size(); ++i) {
    INFO("format ", i);
    // Coordinates of 3 that are rounded at 1.2e-7, times 7 texels, times values that differ by 1, or by 16 in floats.
    const bool is_float = formats[i] == TexelFormat::half || formats[i] == TexelFormat::float32;
    CHECK(worst[i] < (is_float ? 4e-5 : 2.5e-6));
  }
}

TEST_CASE("All devices read textures to the last bit") {
  const test::NoWarnings no_warnings;
  test::RandomSource random(45);
  Scene scene = scene_with_triangle();
  for (const TexelFormat format : formats) add_texture(scene, random_image(format, 13, 9, random).image);
  Texture noise;
  noise.gpu.kind = TextureKind::noise;
  noise.gpu.scale = 1.75f;
  scene.textures.push_back(noise);
  std::vector<Place> places;
  for (std::uint32_t i = 0; i < 50000; ++i) {
    Place place{.texture = i % 7, .uv = {}};
    for (float* value : {&place.uv.x, &place.uv.y, &place.position.x, &place.position.y, &place.position.z})
      *value = static_cast<float>(random.uniform(-9, 9));
    places.push_back(place);
  }
  std::vector<std::vector<float>> outputs;
  for (const std::string& name : test::device_names()) {
    outputs.push_back(read_textures(*test::device(name), scene, places));
    std::size_t different = 0;
    for (std::size_t i = 0; i < outputs.front().size(); ++i)
      different += std::bit_cast<std::uint32_t>(outputs.back()[i]) != std::bit_cast<std::uint32_t>(outputs.front()[i]);
    CHECK(different == 0);
  }
}

TANDEM_DEVICE_TEST("Every half float and every integer is decoded to the float that it means") {
  Scene scene = scene_with_triangle();
  std::vector<float> expected;
  const auto add = [&](TexelFormat format, std::uint32_t width, std::uint32_t height, std::vector<std::byte> texels) {
    Texture texture{.gpu = {}, .image = static_cast<std::uint32_t>(scene.images.size())};
    texture.gpu.filter = TextureFilter::nearest;
    scene.textures.push_back(texture);
    scene.images.push_back(
        {.name = "all", .format = format, .width = width, .height = height, .texels = std::move(texels)});
  };
  std::vector<std::byte> halves, wide;
  for (std::uint32_t bits = 0; bits < 65536; ++bits) {
    // Infinities and NaNs do not occur.
    const auto half = static_cast<std::uint16_t>((bits & 0x7c00) == 0x7c00 ? 0 : bits);
    append(halves, half);
    append(wide, static_cast<std::uint16_t>(bits));
    expected.push_back(glm::unpackHalf1x16(half));
  }
  add(TexelFormat::half, 128, 128, halves);
  add(TexelFormat::unorm16, 128, 128, wide);
  std::vector<std::byte> narrow;
  for (std::uint32_t value = 0; value < 256; ++value) append(narrow, static_cast<std::uint8_t>(value));
  add(TexelFormat::unorm8, 8, 8, narrow);
  add(TexelFormat::single_unorm8, 16, 16, narrow);
  std::vector<Place> places;
  for (std::uint32_t texture = 0; texture < 4; ++texture)
    for (std::uint32_t y = 0; y < scene.images[texture].height; ++y)
      for (std::uint32_t x = 0; x < scene.images[texture].width; ++x) {
        const glm::vec2 size(scene.images[texture].width, scene.images[texture].height);
        places.push_back({.texture = texture, .uv = {(float(x) + 0.5f) / size.x, 1 - (float(y) + 0.5f) / size.y}});
      }
  const std::vector<float> outputs = read_textures(device, scene, places);
  std::size_t row = 0, wrong_halves = 0;
  for (std::size_t i = 0; i < 65536; i += 4, ++row)
    for (std::size_t channel = 0; channel < 4; ++channel)
      wrong_halves += outputs[5 * row + channel] != expected[i + channel];
  CHECK(wrong_halves == 0);
  double worst = 0;
  for (std::size_t i = 0; i < 65536; i += 4, ++row)
    for (std::size_t channel = 0; channel < 4; ++channel)
      worst = std::max(worst, test::ulp_distance(double(i + channel) / 65535, outputs[5 * row + channel]));
  CHECK(outputs[5 * row - 2] == 1.0f);
  for (std::size_t i = 0; i < 256; i += 4, ++row)
    for (std::size_t channel = 0; channel < 4; ++channel)
      worst = std::max(worst, test::ulp_distance(double(i + channel) / 255, outputs[5 * row + channel]));
  CHECK(outputs[5 * row - 2] == 1.0f);
  for (std::size_t i = 0; i < 256; ++i, ++row)
    for (std::size_t channel = 0; channel < 4; ++channel)
      worst = std::max(worst, test::ulp_distance(double(i) / 255, outputs[5 * row + channel]));
  // The product of an exact integer and a rounded reciprocal.
  CHECK(worst <= 1.5);
}

TANDEM_DEVICE_TEST("A single colour stays what it is under any filter and coordinate; no texture is 1") {
  Scene scene = scene_with_triangle();
  std::vector<std::byte> texels;
  for (int i = 0; i < 6; ++i)
    for (const float value : {0.1f, 0.7f, 3.3f, 0.9f}) append(texels, value);
  add_texture(scene, {.name = "even", .format = TexelFormat::float32, .width = 3, .height = 2, .texels = texels});
  test::RandomSource random(42);
  std::vector<Place> places = {{.texture = 0, .uv = {1e30f, -1e30f}},
                               {.texture = 0, .uv = {-1e-30f, 16777216.0f}},
                               {.texture = 0, .uv = {3e38f, -0.0f}}};
  for (int i = 0; i < 1000; ++i) {
    const double u = random.uniform(-9, 9), v = random.uniform(-9, 9);
    places.push_back({.texture = 0, .uv = {u, v}});
  }
  const std::vector<float> outputs = read_textures(device, scene, places);
  for (std::size_t i = 0; i < places.size(); ++i) {
    REQUIRE(color_at(outputs, i) == glm::dvec4(0.1f, 0.7f, 3.3f, 0.9f));
    REQUIRE(outputs[5 * i + 4] == 0.1f);
  }
  const std::vector<float> absent = read_textures(device, scene, {{.texture = no_texture, .uv = {0.3f, 0.4f}}});
  for (const float value : absent) CHECK(value == 1.0f);
}

TANDEM_DEVICE_TEST("A texture's transform, factor and channel") {
  test::RandomSource random(43);
  Scene scene = scene_with_triangle();
  const KnownImage known = random_image(TexelFormat::float32, 16, 16, random);
  scene.images.push_back(known.image);
  Texture texture;
  texture.gpu.u_row = {0, -2, 0.25f};
  texture.gpu.v_row = {0.5f, 0, 0.125f};
  texture.gpu.color_a = {2, 3, 4};
  texture.gpu.alpha_a = 0.5f;
  for (texture.gpu.channel = 0; texture.gpu.channel <= luminance_channel; ++texture.gpu.channel)
    scene.textures.push_back(texture);
  std::vector<Place> places;
  for (int i = 0; i < 1000; ++i) {
    const double u = random.uniform(-2, 2), v = random.uniform(-2, 2);
    places.push_back({.texture = static_cast<std::uint32_t>(i % 5), .uv = {u, v}});
  }
  const std::vector<float> outputs = read_textures(device, scene, places);
  for (std::size_t i = 0; i < places.size(); ++i) {
    const glm::dvec2 uv(places[i].uv);
    const glm::dvec2 own(-2 * uv.y + 0.25, 0.5 * uv.x + 0.125);
    const glm::dvec4 expected = reference(known, texture.gpu, own) * glm::dvec4(2, 3, 4, 0.5);
    // As in the test of all formats, with coordinates and values four times as large.
    for (int channel = 0; channel < 4; ++channel)
      REQUIRE(std::abs(color_at(outputs, i)[channel] - expected[channel]) < 1e-3);
    const double luminance = 0.2126 * expected.x + 0.7152 * expected.y + 0.0722 * expected.z;
    const double number = places[i].texture == 4 ? luminance : expected[static_cast<int>(places[i].texture)];
    REQUIRE(std::abs(double{outputs[5 * i + 4]} - number) < 1e-3);
  }
}

TANDEM_DEVICE_TEST("A checker has squares of side 1 / scale, and a uniform texture has none") {
  Scene scene = scene_with_triangle();
  Texture texture;
  texture.gpu.kind = TextureKind::checker;
  texture.gpu.scale = 4;
  texture.gpu.color_a = {1, 0.5f, 0.25f};
  texture.gpu.color_b = {0, 2, 3};
  texture.gpu.alpha_b = 0.5f;
  scene.textures.push_back(texture);
  texture.gpu.kind = TextureKind::uniform;
  scene.textures.push_back(texture);
  test::RandomSource random(44);
  std::vector<Place> places;
  for (int i = 0; i < 10000; ++i) {
    const double u = random.uniform(-5, 5), v = random.uniform(-5, 5);
    places.push_back({.texture = 0, .uv = {u, v}});
  }
  for (int i = 0; i < 100; ++i) {
    const double u = random.uniform(-5, 5), v = random.uniform(-5, 5);
    places.push_back({.texture = 1, .uv = {u, v}});
  }
  const std::vector<float> outputs = read_textures(device, scene, places);
  int second_count = 0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    // Times 4 is exact.
    const int squares = int(std::floor(4 * places[i].uv.x)) + int(std::floor(4 * places[i].uv.y));
    const bool second = places[i].texture == 0 && squares % 2 != 0;
    second_count += second;
    REQUIRE(color_at(outputs, i) == (second ? glm::dvec4(0, 2, 3, 0.5) : glm::dvec4(1, 0.5, 0.25, 1)));
  }
  CHECK(second_count > 4500);
  CHECK(second_count < 5500);
}
