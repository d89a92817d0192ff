// What vertices have of their own: colours, opacities, tangents, a second set of texture coordinates.

#include <bit>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include "pathtracer/render/first_hits.hpp"
#include "tests/pathtracer/render/picture.hpp"
#include "tests/support/device_test.hpp"

using namespace tandem;
using namespace tandem::pathtracer;

namespace {

/// A square over [-1, 1] x [-1, 1] that fills a picture of 8 x 8 pixels, with a second set of texture coordinates that
/// goes from 0 to 1 along y in both of its components. The first is 0.
Scene square(const GpuMaterial& material) {
  Scene scene;
  scene.name = "square";
  for (const glm::vec2 corner : {glm::vec2(-1, -1), glm::vec2(1, -1), glm::vec2(1, 1), glm::vec2(-1, 1)}) {
    scene.positions.emplace_back(corner, 0);
    scene.normals.emplace_back(0, 0, 1);
    scene.texture_coordinates.emplace_back(0, 0);
    GpuVertexAttributes attributes;
    attributes.color = corner.x < 0 ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0);
    attributes.opacity = corner.x < 0 ? 0 : 1;
    attributes.tangent = glm::vec4(0, 1, 0, 1);
    attributes.texture_coordinates = glm::vec2(corner.y < 0 ? 0 : 1);
    scene.attributes.push_back(attributes);
  }
  scene.triangles = {{{0, 1, 2}, 0}, {{0, 2, 3}, 0}};
  scene.materials = {material};
  scene.material_names = {"m"};
  return scene;
}

const RenderSettings filled{.width = 8,
                            .height = 8,
                            .camera = Camera{.kind = CameraKind::orthographic, .position = {0, 0, 4}, .height = 2},
                            .background = glm::vec3(0)};

std::vector<float> channel(const std::vector<ImageChannel>& channels, const std::string& name) {
  std::vector<float> values;
  for (const ImageChannel& each : channels)
    if (each.name == name)
      for (const std::uint32_t word : each.words) values.push_back(std::bit_cast<float>(word));
  REQUIRE(values.size() == 64);
  return values;
}

/// The mean over the samples of a pixel whose centre is at x: that of a uniform point in a column of width 1/4, of 256.
constexpr std::uint32_t samples = 256;
const double five_deviations = 5 * (0.25 / std::sqrt(12.0)) / std::sqrt(double{samples});
double centre(std::size_t pixel) { return -1 + (static_cast<double>(pixel % 8) + 0.5) / 4; }

}  // namespace

TANDEM_DEVICE_TEST("Colours of the vertices are factors on the base colour, linear in between") {
  const auto programs = std::make_shared<ProgramStore>(device_handle);
  GpuMaterial material = diffuse_material(glm::vec3(0.5f, 0.5f, 1));
  material.attributes = vertex_attribute::color;
  SceneOnDevice scene(device_handle, square(material), filled, {}, programs);
  const auto hits = first_hits(scene, samples);
  const std::vector<float> red = channel(hits, "albedo.R"), green = channel(hits, "albedo.G");
  for (std::size_t pixel = 0; pixel < 64; ++pixel) {
    const double expected = 0.5 * (1 - centre(pixel)) / 2;
    CHECK(std::abs(red[pixel] - expected) < five_deviations);
    CHECK(double{red[pixel]} + double{green[pixel]} == doctest::Approx(0.5).epsilon(1e-5));
  }
  CHECK(channel(hits, "albedo.B") == std::vector<float>(64, 0));

  // Not where the material does not say so.
  SceneOnDevice plain(device_handle, square(diffuse_material(glm::vec3(0.5f, 0.5f, 1))), filled, {}, programs);
  CHECK(channel(first_hits(plain, 1), "albedo.B") == std::vector<float>(64, 1));
}

TANDEM_DEVICE_TEST("Opacities of the vertices are those of the points between them") {
  GpuMaterial material = diffuse_material(glm::vec3(0.5f));
  material.attributes = vertex_attribute::opacity;
  SceneOnDevice scene(device_handle, square(material), filled);
  const std::vector<float> coverage = channel(first_hits(scene, samples), "coverage.Y");
  // Each sample is there or not.
  for (std::size_t pixel = 0; pixel < 64; ++pixel) {
    const double expected = (1 + centre(pixel)) / 2;
    CHECK(std::abs(coverage[pixel] - expected) < 5 * 0.5 / std::sqrt(double{samples}));
  }
}

TANDEM_DEVICE_TEST("A texture may use the second set of texture coordinates") {
  GpuMaterial material = diffuse_material(glm::vec3(1));
  Scene scene = square(material);
  // Black below, white above: nearest texels.
  TextureImage image{.name = "two", .format = TexelFormat::unorm8, .width = 1, .height = 2, .texels = {}};
  for (const int value : {255, 255, 255, 255, 0, 0, 0, 255}) image.texels.push_back(static_cast<std::byte>(value));
  const std::uint32_t texture = add_texture(scene, image);
  scene.textures[texture].gpu.filter = TextureFilter::nearest;
  scene.materials[0].base_color_texture = texture;
  for (const bool second : {false, true}) {
    CAPTURE(second);
    scene.textures[texture].gpu.coordinates = second ? 1 : 0;
    scene.materials[0].attributes = second ? vertex_attribute::texture_coordinates : 0;
    SceneOnDevice on_device(device_handle, scene, filled);
    const std::vector<float> red = channel(first_hits(on_device, 4), "albedo.R");
    for (std::size_t pixel = 0; pixel < 64; ++pixel) CHECK(red[pixel] == (second && pixel < 32 ? 1.0f : 0.0f));
  }
}

TANDEM_DEVICE_TEST("A normal map leans along the tangents that the vertices have") {
  Scene scene = square(diffuse_material(glm::vec3(1)));
  // Leans by 45 degrees along s, whatever the place: (1, 0, 1) in the tangent frame, but for the steps of 8 bits.
  TextureImage image{.name = "leaning", .format = TexelFormat::unorm8, .width = 1, .height = 1, .texels = {}};
  for (const int value : {255, 128, 255, 255}) image.texels.push_back(static_cast<std::byte>(value));
  scene.materials[0].normal_texture = add_texture(scene, image);
  scene.materials[0].attributes = vertex_attribute::tangent;
  const auto normal = [&](glm::vec4 tangent, glm::vec3 texel) {
    for (GpuVertexAttributes& vertex : scene.attributes) vertex.tangent = tangent;
    for (int i = 0; i < 3; ++i) scene.images[0].texels[static_cast<std::size_t>(i)] = static_cast<std::byte>(texel[i]);
    SceneOnDevice on_device(device_handle, scene, filled);
    const auto hits = first_hits(on_device, 1);
    return glm::vec3(channel(hits, "normal.X")[0], channel(hits, "normal.Y")[0], channel(hits, "normal.Z")[0]);
  };
  const auto is_near = [](glm::vec3 a, glm::vec3 b) { return glm::length(a - b) < 0.01f; };  // 8 bits: 0.004 each
  const float half = std::sqrt(0.5f);
  CHECK(is_near(normal({0, 1, 0, 1}, {255, 128, 255}), {0, half, half}));
  CHECK(is_near(normal({0, 1, 0, -1}, {255, 128, 255}), {0, half, half}));
  // Along t: the cross product of normal and tangent, times w.
  CHECK(is_near(normal({0, 1, 0, 1}, {128, 255, 255}), {-half, 0, half}));
  CHECK(is_near(normal({0, 1, 0, -1}, {128, 255, 255}), {half, 0, half}));
}

TANDEM_DEVICE_TEST("Colours of the vertices are factors on the emission where the material says so") {
  GpuMaterial material = diffuse_material(glm::vec3(0), glm::vec3(2));
  for (const bool emits : {false, true}) {
    CAPTURE(emits);
    material.attributes = vertex_attribute::color | (emits ? vertex_attribute::emission : 0);
    RenderSettings settings = filled;
    settings.max_depth = 1;
    const Image image = test::rendered(device_handle, square(material), settings, samples);
    for (std::size_t pixel = 0; pixel < 64; ++pixel) {
      const double expected = emits ? 2 * (1 - centre(pixel)) / 2 : 2;
      CHECK(std::abs(double{image.pixels[pixel].x} - expected) < 2 * five_deviations + 1e-5);
      CHECK(image.pixels[pixel].z == (emits ? 0.0f : 2.0f));
    }
  }
}
