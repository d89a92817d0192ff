#include "pathtracer/image/texture_image.hpp"

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "base/error.hpp"
#include "pathtracer/load/obj/obj_loader.hpp"
#include "tests/support/scratch_folder.hpp"

using namespace tandem::pathtracer;
using tandem::test::ScratchFolder;

namespace {

using Texels = std::vector<int>;

Texels values_of(const TextureImage& image) {
  Texels values;
  for (const std::byte texel : image.texels) values.push_back(std::to_integer<int>(texel));
  return values;
}

const std::string grey_image = "P2\n3 2\n255\n0 10 255\n1 128 254\n";
const std::string quad = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 2 0\nvt 2 2\nvt 0 2\n";

std::string error_of(const auto& action) {
  try {
    action();
  } catch (const tandem::Error& error) {
    return error.what();
  }
  return "no error";
}

bool contains(const std::string& text, std::string_view part) { return text.find(part) != std::string::npos; }

/// An OBJ file with the material "leaf", whose map_d is mask.pgm.
Scene load_leaf(const std::string& obj, const LoadOptions& options = {}, bool with_texture = true) {
  const ScratchFolder folder;
  if (with_texture) folder.write("mask.pgm", grey_image);
  folder.write("test.mtl", "newmtl leaf\nmap_d mask.pgm\nnewmtl other\nmap_d mask.pgm\nnewmtl solid\n");
  return load_obj(folder.write("test.obj", "mtllib test.mtl\n" + obj), options);
}

}  // namespace

TEST_CASE("A grey image is opacities, row by row from the top") {
  const ScratchFolder folder;
  const TextureImage texture = load_alpha_texture(folder.write("mask.pgm", grey_image));
  CHECK(texture.width == 3);
  CHECK(texture.height == 2);
  CHECK(values_of(texture) == Texels{0, 10, 255, 1, 128, 254});
}

TEST_CASE("A coloured image without alpha channel gives its luminance") {
  const ScratchFolder folder;
  const std::string image = "P3\n4 1\n255\n255 255 255  255 0 0  0 255 0  0 0 255\n";
  // 255 times the weights 0.2126, 0.7152 and 0.0722, rounded.
  CHECK(values_of(load_alpha_texture(folder.write("mask.ppm", image))) == Texels{255, 54, 182, 18});
}

TEST_CASE("An alpha channel is what counts in an image that has one") {
  const TextureImage texture =
      load_alpha_texture(std::filesystem::path(TANDEM_SOURCE_DIRECTORY) / "scenes" / "leaf.png");
  CHECK(texture.width == 64);
  CHECK(texture.texels.size() == 64 * 64);
  // White everywhere, so its colour would be 255.
  CHECK(values_of(texture).front() == 0);
  CHECK(values_of(texture)[32 * 64 + 32] == 255);
}

TEST_CASE("A texture that is missing or no image is an error that names it") {
  const ScratchFolder folder;
  CHECK(contains(error_of([&] { load_alpha_texture(folder.path() / "absent.png"); }), "absent.png"));
  const auto broken = folder.write("broken.png", "no image");
  CHECK(contains(error_of([&] { load_alpha_texture(broken); }), "broken.png"));
  std::string wide = "P2\n40000 1\n255\n";
  for (int i = 0; i < 40000; ++i) wide += "0\n";
  const auto too_wide = folder.write("wide.pgm", wide);
  CHECK(contains(error_of([&] { load_alpha_texture(too_wide); }), "40000x1"));
  CHECK(contains(error_of([] { load_leaf(quad + "usemtl leaf\nf 1/1 2/2 3/3\n", {}, false); }), "mask.pgm"));
}

TEST_CASE("A missing texture has no effect where that is allowed") {
  const Scene scene = load_leaf(quad + "usemtl leaf\nf 1/1 2/2 3/3\n", {.allow_missing_mtl = true}, false);
  REQUIRE(scene.warnings.size() == 1);
  CHECK(contains(scene.warnings[0], "mask.pgm"));
  CHECK_FALSE(is_transparent(scene, scene.triangles.at(0)));
  CHECK(scene.texture_coordinates.empty());
}

TEST_CASE("A texture is found beside the MTL file or in the folder of textures, by its last name where need be") {
  const ScratchFolder folder;
  std::filesystem::create_directories(folder.path() / "textures");
  std::filesystem::create_directories(folder.path() / "models");
  folder.write("textures/mask.pgm", grey_image);
  const auto load = [&](const std::string& directory) {
    folder.write(directory + "test.mtl", "newmtl leaf\nmap_Kd C:\\maps\\mask.pgm\nbump -bm 0.1 mask.pgm\n");
    return load_obj(folder.write(directory + "test.obj", "mtllib test.mtl\n" + quad + "usemtl leaf\nf 1/1 2/2 3/3\n"));
  };
  for (const char* directory : {"", "models/"}) {
    const Scene scene = load(directory);
    CHECK(scene.warnings.empty());
    CHECK(scene.textures.size() == 2);
    REQUIRE(scene.images.size() == 2);
    const GpuMaterial& material = scene.materials.at(0);
    CHECK(scene.images[scene.textures.at(material.base_color_texture).image].format == TexelFormat::srgb8);
    CHECK(scene.images[scene.textures.at(material.bump_texture).image].format == TexelFormat::unorm8);
    CHECK(scene.texture_coordinates.size() == scene.positions.size());
    CHECK_FALSE(is_transparent(material));
  }
}

TEST_CASE("Textured vertices have texture coordinates, and a file that two materials name is read once") {
  const Scene scene = load_leaf(quad + "usemtl leaf\nf 1/1 2/2 3/3 4/4\nusemtl other\nf 1/3 2/3 3/3\n");
  CHECK(scene.warnings.empty());
  CHECK(scene.textures.size() == 1);
  REQUIRE(scene.triangles.size() == 3);
  // The two meet in one vertex only: the third corner has the same texture coordinates in both.
  CHECK(scene.positions.size() == 6);
  REQUIRE(scene.texture_coordinates.size() == 6);
  for (const GpuTriangle& triangle : {scene.triangles[0], scene.triangles[1]})
    for (const std::uint32_t vertex : triangle.vertices)
      CHECK(scene.texture_coordinates[vertex] == 2.0f * glm::vec2(scene.positions[vertex]));
  for (const std::uint32_t vertex : scene.triangles[2].vertices)
    CHECK(scene.texture_coordinates[vertex] == glm::vec2(2));
}

TEST_CASE("Texture coordinates that nothing needs split no vertex and may be wrong") {
  const Scene scene = load_leaf(quad + "usemtl solid\nf 1/1 2/2 3/9\nf 1/4 2/3 3/2\n");
  REQUIRE(scene.warnings.size() == 1);
  CHECK(contains(scene.warnings[0], "1 corners name texture coordinates that the file does not have"));
  CHECK(scene.positions.size() == 3);
}

TEST_CASE("Texture coordinates that are needed and wrong are an error or a warning") {
  CHECK(contains(error_of([] { load_leaf(quad + "usemtl leaf\nf 1/1 2/2 3/9\n"); }), "texture coordinate index 9"));
  const Scene lacking = load_leaf(quad + "usemtl leaf\nf 1 2 3\n");
  REQUIRE(lacking.warnings.size() == 1);
  CHECK(contains(lacking.warnings[0], "1 triangles"));
  const Scene no_numbers = load_leaf("vt nan x\n" + quad + "usemtl leaf\nf 1/1 2/2 3/3\n");
  REQUIRE(no_numbers.warnings.size() == 1);
  CHECK(contains(no_numbers.warnings[0], "1 texture coordinates"));
}
