#include <string>
#include <vector>

#include <doctest/doctest.h>
#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "base/error.hpp"
#include "pathtracer/image/image_io.hpp"
#include "pathtracer/load/scene_loader.hpp"
#include "tests/support/scratch_folder.hpp"

using namespace tandem;
using namespace tandem::pathtracer;

namespace {

Scene load(const test::ScratchFolder& folder, const std::string& text) {
  return load_scene(folder.write("scene.json", text));
}

std::string error_of(const std::string& text) {
  const test::ScratchFolder folder;
  const std::string path = folder.write("scene.json", text).string();
  try {
    load_scene(path);
  } catch (const Error& error) {
    const std::string sentence = error.what();
    CHECK(sentence.starts_with(path + ": "));
    return sentence.substr(path.size() + 2);
  }
  return "no error";
}

const std::string grey = R"("materials": {"grey": {"model": "diffuse"}})";
const std::string ball = grey + R"(, "spheres": [{"centre": [0, 0, 0], "radius": 1, "material": "grey"}])";

glm::vec3 normal_of(const Scene& scene, std::size_t triangle) {
  const auto corner = [&](int i) { return scene.positions[scene.triangles[triangle].vertices[i]]; };
  return glm::normalize(glm::cross(corner(1) - corner(0), corner(2) - corner(0)));
}

}  // namespace

TEST_CASE("What is wrong with a description is said in one sentence that names the place") {
  CHECK(error_of("{") != "no error");
  CHECK(error_of("[]") == "the description must be an object");
  CHECK(error_of("{}") == "the description must have something to see: models, spheres, boxes or quads");
  CHECK(error_of("{\"title\": 3}") == "title must be a text");
  CHECK(error_of(R"({"title": "a", "title": "b"})") == "an object has two members named title");
  CHECK(error_of("{" + grey + R"(, "spheres": [{"centre": [0, 0, 0], "radius": -1, "material": "grey"}]})") ==
        "spheres[0].radius must be a number from 1.18e-38 to 1e+12");
  CHECK(error_of("{" + grey + R"(, "spheres": [{"centre": [0, 0], "radius": 1, "material": "grey"}]})") ==
        "spheres[0].centre must be a list of 3");
  CHECK(error_of("{" + grey + R"(, "spheres": [{"centre": [0, 0, 0], "radius": 1, "material": "gray"}]})") ==
        "spheres[0].material names 'gray', which is not among the materials");
  CHECK(error_of("{" + grey +
                 R"(, "quads": [{"corner": [0, 0, 0], "u": [1, 1, 1], "v": [2, 2, 2], "material": "grey"}]})") ==
        "quads[0] must have sides u and v that span an area");
  CHECK(error_of("{" + grey + R"(, "boxes": [{"minimum": [0, 0, 0], "maximum": [1, 0, 1], "material": "grey"}]})") ==
        "boxes[0] must have a maximum above its minimum along every axis");
  CHECK(error_of(R"({"materials": {"a": {"base_color": 1}}})") == "materials.a must have a model");
  CHECK(error_of(R"({"materials": {"a": {"model": "velvet"}}})")
            .starts_with("materials.a.model is 'velvet', which is none of: diffuse, "));
  CHECK(error_of(R"({"materials": {"a": {"model": "diffuse", "base_color": 1.5}}})") ==
        "materials.a.base_color must be a number from 0 to 1");
  CHECK(error_of(R"({"materials": {"a": {"model": "diffuse", "base_color": "wood"}}})") ==
        "materials.a.base_color names 'wood', which is not among the textures");
  CHECK(error_of(R"({"models": [{"file": "other.json"}]})") ==
        "models[0].file must be a model, not another description");
  CHECK(error_of("{" + ball + R"(, "camera": {"position": [1, 2, 3], "target": [1, 2, 3]}})")
            .starts_with("camera cannot be used: "));
  CHECK(
      error_of(
          "{" + ball +
          R"(, "lights": [{"type": "spot", "position": [0, 3, 0], "direction": [0, -1, 0], "intensity": 1, "inner_angle": 50}]})") ==
      "lights[0] must have an inner_angle below its outer_angle");
  CHECK(error_of("{" + ball + R"(, "settings": {"depth": 1.5}})") ==
        "settings.depth must be a whole number from 1 to 1024");
}

TEST_CASE("Members are called as on the command line; the names that they had before are taken too, but not both") {
  const test::ScratchFolder folder;
  const std::string view = R"("position": [0, 0, 5], "target": [0, 0, 0])";
  const auto with = [&](const std::string& camera, const std::string& settings) {
    return "{" + ball + R"(, "camera": {)" + view + camera + R"(}, "settings": {)" + settings + "}}";
  };
  const Scene now = load(folder, with(R"(, "fov": 30)", R"("spp": 3, "depth": 4, "nee": false)"));
  const Scene before =
      load(folder, with(R"(, "vertical_fov": 30)", R"("samples": 3, "max_depth": 4, "light_sampling": false)"));
  for (const Scene* scene : {&now, &before}) {
    CHECK(scene->camera->vertical_fov == 30.0f);
    CHECK(scene->settings.samples == 3);
    CHECK(scene->settings.max_depth == 4);
    CHECK(scene->settings.light_sampling == false);
  }
  for (const char* name : {"view_height", "height"})
    CHECK(load(folder, with(fmt::format(R"(, "type": "orthographic", "{}": 7)", name), "")).camera->height == 7.0f);
  CHECK(error_of(with("", R"("spp": 3, "samples": 3)")) ==
        "settings.samples is the old name of spp, which is there too");
}

TEST_CASE("A box has twelve triangles that look outwards, also where its transform mirrors") {
  const test::ScratchFolder folder;
  for (const char* transform : {"[]", R"([{"scale": [-1, 1, 1]}])", R"([{"rotate": 40, "axis": [1, 2, 3]}])"}) {
    const Scene scene =
        load(folder, "{" + grey + R"(, "boxes": [{"minimum": [-1, -2, -3], "maximum": [1, 2, 3], "material": "grey",
                                     "transform": )" +
                         transform + "}]}");
    REQUIRE(scene.triangles.size() == 12);
    double area = 0;
    for (std::size_t i = 0; i < 12; ++i) {
      area += triangle_area(scene, scene.triangles[i]);
      CHECK(glm::dot(normal_of(scene, i), scene.positions[scene.triangles[i].vertices[0]]) > 0);
    }
    CHECK(area == doctest::Approx(2 * (2 * 4 + 4 * 6 + 6 * 2)));
  }
}

TEST_CASE("A model is placed by its transform, with other materials where the description says so") {
  const test::ScratchFolder folder;
  folder.write(
      "model.obj",
      "mtllib model.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 1 1\nusemtl a\nf 1//1 2//1 3//1\nusemtl b\nf 3 2 1\n");
  folder.write("model.mtl", "newmtl a\nKd 0.1 0.1 0.1\nnewmtl b\nKd 0.2 0.2 0.2\n");
  const Scene scene = load(folder, R"({
    "models": [{"file": "model.obj", "materials": {"b": "mirror"},
                "transform": [{"scale": [1, 1, 2]}, {"rotate": 90, "axis": [0, 0, 1]}, {"translate": [5, 0, 0]}]},
               {"file": "model.obj"}],
    "materials": {"mirror": {"model": "mirror", "reflectance": 0.9}}})");
  REQUIRE(scene.triangles.size() == 4);
  CHECK(scene.material_names == std::vector<std::string>{"mirror", "a", "b", "a", "b"});
  const auto model_of = [&](std::size_t i) {
    return scene.materials[scene.triangles[i].material & ~triangle_smooth].model;
  };
  CHECK(model_of(0) == MaterialModel::diffuse);
  CHECK(model_of(1) == MaterialModel::mirror);
  CHECK(model_of(3) == MaterialModel::diffuse);
  CHECK((scene.triangles[0].material & triangle_smooth) != 0);
  const glm::vec3 corner = scene.positions[scene.triangles[0].vertices[1]];  // (1, 0, 0)
  CHECK(glm::length(corner - glm::vec3(5, 1, 0)) < 1e-6f);
  // By the inverse transpose: (0, 1, 1) becomes (0, 1, 1/2), then turns from y to -x.
  const glm::vec3 normal = scene.normals[scene.triangles[0].vertices[0]];
  CHECK(glm::length(normal - glm::normalize(glm::vec3(-1, 0, 0.5f))) < 1e-6f);
  CHECK(scene.positions[scene.triangles[2].vertices[1]] == glm::vec3(1, 0, 0));
  CHECK_THROWS_WITH_AS(
      load(folder, R"({"models": [{"file": "model.obj", "materials": {"c": "grey"}}], )" + grey + "}"),
      doctest::Contains("models[0].materials.c stands for a material that the model does not have; it has: a, b"),
      Error);
}

TEST_CASE("A texture is encoded as what uses it needs, and numbers come from the channel that it says") {
  const test::ScratchFolder folder;
  write_image(folder.path() / "picture.png", {.width = 1, .height = 1, .pixels = {glm::vec3(0.25f)}}, {});
  const Scene scene = load(folder, R"({
    "spheres": [{"centre": [0, 0, 0], "radius": 1, "material": "a"}],
    "materials": {"a": {"model": "principled", "base_color": "p", "roughness": "p", "metallic": "q", "opacity": "p"}},
    "textures": {"p": {"type": "image", "file": "picture.png",
                       "transform": {"scale": [2, 3], "rotate": 90, "offset": [0.5, 0.25]}},
                 "q": {"type": "image", "file": "picture.png", "channel": "blue", "wrap": ["clamp", "mirror"]}}})");
  const GpuMaterial& material = scene.materials[0];
  CHECK(scene.images.size() == 2);
  const auto image_of = [&](std::uint32_t texture) { return scene.images[scene.textures[texture].image].format; };
  CHECK(image_of(material.base_color_texture) == TexelFormat::srgb8);
  CHECK(image_of(material.roughness_texture) == TexelFormat::unorm8);
  CHECK(scene.textures[material.roughness_texture].gpu.channel == 0);
  CHECK(scene.textures[material.metallic_texture].gpu.channel == 2);
  CHECK(scene.textures[material.metallic_texture].gpu.address == (1u | 2u << 8));
  CHECK(scene.textures[material.alpha_texture].gpu.channel == 3);
  CHECK(material.roughness == 1);
  // (u, v) -> (2 u, 3 v) -> (-3 v, 2 u) -> (0.5 - 3 v, 0.25 + 2 u)
  const GpuTexture& texture = scene.textures[material.base_color_texture].gpu;
  CHECK(glm::length(texture.u_row - glm::vec3(0, -3, 0.5f)) < 1e-6f);
  CHECK(glm::length(texture.v_row - glm::vec3(2, 0, 0.25f)) < 1e-6f);
}

TEST_CASE("Lights of a description") {
  const test::ScratchFolder folder;
  const Scene scene = load(folder, "{" + ball + R"(, "environment": {"radiance": 0.5, "rotation": 90},
    "lights": [{"type": "spot", "position": [0, 3, 0], "direction": [0, -2, 0], "intensity": [1, 2, 3], "inner_angle": 10, "outer_angle": 20},
               {"type": "rectangle", "corner": [0, 0, 0], "u": [2, 0, 0], "v": [0, 0, 3], "radiance": 7},
               {"type": "sphere", "centre": [0, 9, 0], "radius": 2, "radiance": [1, 2, 4]},
               {"type": "directional", "direction": [1, 0, 0], "irradiance": 3}]})");
  REQUIRE(scene.lights.size() == 2);
  CHECK(scene.lights[0].kind == LightKind::spot);
  CHECK(scene.lights[0].radiance == glm::vec3(1, 2, 3));
  CHECK(scene.lights[0].outer_angle == 20);
  CHECK(scene.lights[1].kind == LightKind::directional);
  REQUIRE(scene.triangles.size() == 2);
  CHECK(normal_of(scene, 0) == glm::vec3(0, -1, 0));
  CHECK(scene.materials[scene.triangles[0].material].emission == glm::vec3(7));
  REQUIRE(scene.spheres.size() == 2);
  CHECK(scene.materials[scene.spheres[1].material].emission == glm::vec3(1, 2, 4));
  REQUIRE(scene.environment);
  CHECK(scene.environment->texture == no_texture);
  CHECK(scene.environment->rotation == 90);
}
