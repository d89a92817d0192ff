#include <cmath>
#include <numbers>

#include <doctest/doctest.h>

#include "pathtracer/load/gltf/loader.hpp"
#include "tests/pathtracer/load/gltf/file.hpp"
#include "tests/support/scratch_folder.hpp"

using namespace tandem::pathtracer;
using namespace tandem::test;

namespace {

/// A file of one triangle with this material, and two textures of one image of 2 x 1 pixels.
GltfFile file_with(const nlohmann::json& material) {
  GltfFile file;
  file.add_triangle(material);
  file.json["images"] = {{{"uri", data_uri("image/png", png(2, 1, {255, 0, 0, 255, 0, 255, 0, 64}))}}};
  file.json["textures"] = {{{"source", 0}}, {{"source", 0}, {"sampler", 0}}};
  file.json["samplers"] = {{{"wrapS", 33071}, {"wrapT", 33648}, {"magFilter", 9728}}};
  return file;
}

Scene load(const nlohmann::json& material) { return file_with(material).load(); }

nlohmann::json extension(const std::string& name, const nlohmann::json& content) {
  return {{"extensions", {{name, content}}}};
}

/// Where a texture is read, for texture coordinates of the file (v downwards), as the shader computes it; v downwards.
glm::vec2 read_at(const GpuTexture& texture, glm::vec2 file_coordinates) {
  const glm::vec3 uv(file_coordinates.x, 1 - file_coordinates.y, 1);
  return {texture.u_row.x * uv.x + texture.u_row.y * uv.y + texture.u_row.z,
          1 - (texture.v_row.x * uv.x + texture.v_row.y * uv.y + texture.v_row.z)};
}

void check_near(glm::vec2 a, glm::vec2 b) {
  CHECK(a.x == doctest::Approx(b.x));
  CHECK(a.y == doctest::Approx(b.y));
}

}  // namespace

TEST_CASE("glTF: what a material leaves out is what glTF says; so is all of a primitive without material") {
  GltfFile without;
  without.add_triangle();
  for (const Scene& scene : {load(nlohmann::json::object()), without.load()}) {
    REQUIRE(scene.materials.size() == 1);
    const GpuMaterial& material = scene.materials[0];
    CHECK(material.model == MaterialModel::principled);
    CHECK(material.base_color == glm::vec3(1));
    CHECK(material.metallic == 1);
    CHECK(material.roughness == 1);
    CHECK(material.ior == 1.5f);
    CHECK(material.specular == 1);
    CHECK(material.reflectance == glm::vec3(1));
    CHECK(material.transmission == 0);
    CHECK(material.emission == glm::vec3(0));
    CHECK_FALSE(is_transparent(material));
    CHECK(scene.warnings.empty());
    CHECK(scene.textures.empty());
    CHECK(scene.texture_coordinates.empty());
  }
  CHECK(without.load().material_names[0] == "default");
  CHECK(load({{"name", "gold"}}).material_names[0] == "gold");
}

TEST_CASE("glTF: metallic-roughness factors and textures, and their channels") {
  const Scene scene = load({{"pbrMetallicRoughness",
                             {{"baseColorFactor", {0.1, 0.2, 0.3, 0.4}},
                              {"metallicFactor", 0.25},
                              {"roughnessFactor", 0.75},
                              {"baseColorTexture", {{"index", 0}}},
                              {"metallicRoughnessTexture", {{"index", 0}}}}},
                            {"normalTexture", {{"index", 0}, {"scale", 0.5}}},
                            {"occlusionTexture", {{"index", 0}}},
                            {"emissiveFactor", {1, 0.5, 0.25}},
                            {"emissiveTexture", {{"index", 0}}},
                            {"doubleSided", true}});
  const GpuMaterial& material = scene.materials[0];
  CHECK(material.base_color == glm::vec3(0.1f, 0.2f, 0.3f));
  CHECK(material.metallic == 0.25f);
  CHECK(material.roughness == 0.75f);
  CHECK(material.normal_scale == 0.5f);
  CHECK(material.emission == glm::vec3(1, 0.5f, 0.25f));
  CHECK_FALSE(is_transparent(material));
  CHECK(scene.warnings.empty());

  // One image as colours and one as data; views of them for each channel, none twice.
  REQUIRE(scene.images.size() == 2);
  CHECK(scene.textures.size() == 4);
  const auto format = [&](std::uint32_t texture) { return scene.images[scene.textures[texture].image].format; };
  CHECK(format(material.base_color_texture) == TexelFormat::srgb8);
  CHECK(material.emission_texture == material.base_color_texture);
  CHECK(format(material.roughness_texture) == TexelFormat::unorm8);
  CHECK(scene.textures[material.roughness_texture].gpu.channel == 1);
  CHECK(scene.textures[material.metallic_texture].gpu.channel == 2);
  CHECK(format(material.normal_texture) == TexelFormat::unorm8);
  CHECK(scene.texture_coordinates.size() == scene.positions.size());
  CHECK(scene.texture_coordinates[0] == glm::vec2(0, 1));
}

TEST_CASE("glTF: alpha modes") {
  const auto alpha = [](const nlohmann::json& mode, double factor, bool textured) {
    nlohmann::json material = mode;
    material["pbrMetallicRoughness"]["baseColorFactor"] = {1, 1, 1, factor};
    if (textured) material["pbrMetallicRoughness"]["baseColorTexture"]["index"] = 0;
    return load(material);
  };
  CHECK_FALSE(is_transparent(alpha({{"alphaMode", "OPAQUE"}}, 0.5, true).materials[0]));

  const Scene blend = alpha({{"alphaMode", "BLEND"}}, 0.5, true);
  CHECK(blend.materials[0].opacity == 0.5f);
  CHECK(blend.materials[0].alpha_cutoff == 0);
  REQUIRE(blend.materials[0].alpha_texture != no_texture);
  CHECK(blend.textures[blend.materials[0].alpha_texture].gpu.channel == 3);
  CHECK(blend.images.size() == 1);
  CHECK(blend.materials[0].base_color_texture != blend.materials[0].alpha_texture);

  const GpuMaterial mask = alpha({{"alphaMode", "MASK"}}, 1, true).materials[0];
  CHECK(mask.alpha_cutoff == 0.5f);
  CHECK(mask.alpha_texture != no_texture);
  CHECK(alpha({{"alphaMode", "MASK"}, {"alphaCutoff", 0.2}}, 1, true).materials[0].alpha_cutoff == 0.2f);
  CHECK_FALSE(is_transparent(alpha({{"alphaMode", "MASK"}, {"alphaCutoff", 0}}, 0, true).materials[0]));

  // Without a texture a cut-out covers everything or nothing.
  const GpuMaterial covers = alpha({{"alphaMode", "MASK"}}, 0.5, false).materials[0];
  CHECK_FALSE(is_transparent(covers));
  const GpuMaterial nothing = alpha({{"alphaMode", "MASK"}}, 0.4, false).materials[0];
  CHECK(nothing.opacity == 0);
  CHECK(nothing.alpha_cutoff == 0);
}

TEST_CASE("glTF: samplers") {
  const Scene scene = load(
      {{"normalTexture", {{"index", 1}}}, {"pbrMetallicRoughness", {{"metallicRoughnessTexture", {{"index", 0}}}}}});
  const GpuTexture& set = scene.textures[scene.materials[0].normal_texture].gpu;
  CHECK(set.address ==
        (static_cast<std::uint32_t>(TextureAddress::clamp) | static_cast<std::uint32_t>(TextureAddress::mirror) << 8));
  CHECK(set.filter == TextureFilter::nearest);
  const GpuTexture& absent = scene.textures[scene.materials[0].roughness_texture].gpu;
  CHECK(absent.address == 0);
  CHECK(absent.filter == TextureFilter::linear);
  check_near(read_at(absent, {0.3f, 0.2f}), {0.3f, 0.2f});
}

TEST_CASE("glTF: KHR_texture_transform scales, then turns, then shifts") {
  const auto texture = [](const nlohmann::json& transform) {
    nlohmann::json info = extension("KHR_texture_transform", transform);
    info["index"] = 0;
    const Scene scene = load({{"normalTexture", info}});
    CHECK(scene.warnings.empty());
    return scene.textures[scene.materials[0].normal_texture].gpu;
  };
  check_near(read_at(texture({{"offset", {0.25, 0.5}}}), {0.1f, 0.2f}), {0.35f, 0.7f});
  check_near(read_at(texture({{"scale", {2, 3}}}), {0.1f, 0.2f}), {0.2f, 0.6f});
  // The example of the extension: the lower left quarter of the image, turned by a quarter.
  const GpuTexture quarter = texture({{"offset", {0, 1}}, {"rotation", std::numbers::pi / 2}, {"scale", {0.5, 0.5}}});
  check_near(read_at(quarter, {0, 0}), {0, 1});
  check_near(read_at(quarter, {1, 0}), {0, 0.5f});
  check_near(read_at(quarter, {0, 1}), {0.5f, 1});
  // (1, 0) scaled to (2, 0), turned by 30 degrees as the image is seen, so upwards.
  const GpuTexture all = texture({{"offset", {0.5, 0.25}}, {"rotation", std::numbers::pi / 6}, {"scale", {2, 3}}});
  const float c = std::sqrt(3.0f) / 2, s = 0.5f;
  check_near(read_at(all, {1, 0}), {0.5f + 2 * c, 0.25f - 2 * s});
  check_near(read_at(all, {0, 1}), {0.5f + 3 * s, 0.25f + 3 * c});
}

TEST_CASE("glTF: two sets of texture coordinates are carried, those that the textures use") {
  GltfFile file;
  const int positions = file.add_vectors({0, 0, 0, 1, 0, 0, 0, 1, 0});
  const int first = file.add_vectors({0, 0, 1, 0, 0, 1}, "VEC2");
  const int second = file.add_vectors({0.5, 0, 1, 0, 0, 1}, "VEC2");
  file.json["images"] = {{{"uri", data_uri("image/png", png(1, 1, {9, 9, 9, 9}))}}};
  file.json["textures"] = {{{"source", 0}}};
  file.json["materials"] = {{{"emissiveTexture", {{"index", 0}, {"texCoord", 1}}}, {"emissiveFactor", {1, 1, 1}}}};
  file.add_node(
      {{"mesh",
        file.add_mesh({{"material", 0},
                       {"attributes", {{"POSITION", positions}, {"TEXCOORD_0", first}, {"TEXCOORD_1", second}}}})}});
  CHECK(file.load().texture_coordinates[0] == glm::vec2(0.5f, 1));
  CHECK(file.load().warnings.empty());

  CHECK(file.load().attributes.empty());

  file.json["materials"][0]["normalTexture"] = {{"index", 0}};
  const Scene mixed = file.load();
  CHECK(mixed.warnings.empty());
  const GpuMaterial& material = mixed.materials[mixed.triangles[0].material];
  CHECK(material.attributes == vertex_attribute::texture_coordinates);
  // The emissive texture is read before the normal one.
  CHECK(mixed.textures[material.emission_texture].gpu.coordinates == 0);
  CHECK(mixed.textures[material.normal_texture].gpu.coordinates == 1);
  const std::uint32_t vertex = mixed.triangles[0].vertices[0];
  CHECK(mixed.texture_coordinates[vertex] == glm::vec2(0.5f, 1));
  CHECK(mixed.attributes[vertex].texture_coordinates == glm::vec2(0, 1));

  file.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", 0}, {"texCoord", 2}};
  file.json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_2"] = first;
  const Scene third = file.load();
  REQUIRE(third.warnings.size() == 1);
  CHECK(contains(third.warnings[0], "has no effect, because it uses TEXCOORD_"));
  file.json["materials"][0].erase("pbrMetallicRoughness");

  // The transform may name another set.
  file.json["materials"][0]["normalTexture"] = extension("KHR_texture_transform", {{"texCoord", 1}});
  file.json["materials"][0]["normalTexture"]["index"] = 0;
  CHECK(file.load().warnings.empty());

  file.json["meshes"][0]["primitives"][0]["attributes"].erase("TEXCOORD_1");
  const Scene lacking = file.load();
  REQUIRE(lacking.warnings.size() == 1);
  CHECK(contains(lacking.warnings[0], "lacks TEXCOORD_1"));
  CHECK(lacking.texture_coordinates[0] == glm::vec2(0, 1));
}

TEST_CASE("glTF: extensions of materials") {
  const auto first = [](const std::string& name, const nlohmann::json& content) {
    nlohmann::json material = extension(name, content);
    material["emissiveFactor"] = {0.5, 0.25, 0};
    const Scene scene = load(material);
    CHECK(scene.warnings.empty());
    return scene.materials[0];
  };
  CHECK(first("KHR_materials_ior", {{"ior", 1.33}}).ior == 1.33f);
  CHECK(first("KHR_materials_ior", nlohmann::json::object()).ior == 1.5f);
  CHECK(first("KHR_materials_emissive_strength", {{"emissiveStrength", 4}}).emission == glm::vec3(2, 1, 0));
  const GpuMaterial glass =
      first("KHR_materials_transmission", {{"transmissionFactor", 0.75}, {"transmissionTexture", {{"index", 0}}}});
  CHECK(glass.transmission == 0.75f);
  CHECK(glass.transmission_texture != no_texture);
  const GpuMaterial coat = first("KHR_materials_specular", {{"specularFactor", 0.5},
                                                            {"specularTexture", {{"index", 0}}},
                                                            {"specularColorFactor", {1, 2, 3}},
                                                            {"specularColorTexture", {{"index", 0}}}});
  CHECK(coat.specular == 0.5f);
  CHECK(coat.reflectance == glm::vec3(1, 2, 3));
  CHECK(coat.specular_texture != no_texture);
  CHECK(coat.reflectance_texture != no_texture);
  CHECK(coat.specular_texture != coat.reflectance_texture);

  nlohmann::json unlit = extension("KHR_materials_unlit", nlohmann::json::object());
  unlit["pbrMetallicRoughness"] = {{"baseColorFactor", {0.5, 0.25, 1, 1}}, {"baseColorTexture", {{"index", 0}}}};
  const GpuMaterial shown = load(unlit).materials[0];
  CHECK(shown.model == MaterialModel::diffuse);
  CHECK(shown.base_color == glm::vec3(0));
  CHECK(shown.base_color_texture == no_texture);
  CHECK(shown.emission == glm::vec3(0.5f, 0.25f, 1));
  CHECK(shown.emission_texture != no_texture);
}

TEST_CASE("glTF: images inside the buffer and beside the file are the same") {
  const std::vector<unsigned char> bytes = png(2, 1, {10, 20, 30, 40, 50, 60, 70, 80});
  GltfFile file = file_with({{"normalTexture", {{"index", 0}}}});
  file.json["images"] = {{{"bufferView", file.add_view(bytes.data(), bytes.size())}, {"mimeType", "image/png"}}};
  const Scene inside = file.load();
  const ScratchFolder folder;
  folder.write("two pixels.png", std::string(bytes.begin(), bytes.end()));
  file.json["images"] = {{{"uri", "two%20pixels.png"}}};
  const Scene beside = load_gltf(folder.write("test.gltf", file.text()));
  for (const Scene* scene : {&inside, &beside}) {
    REQUIRE(scene->images.size() == 1);
    CHECK(scene->images[0].width == 2);
    CHECK(scene->images[0].height == 1);
    REQUIRE(scene->images[0].texels.size() == 8);
    CHECK(scene->images[0].texels[7] == std::byte{80});
  }
}

TEST_CASE("glTF: numbers out of range are clamped, and a texture without a known image has no effect, with a warning") {
  const Scene scene = load({{"pbrMetallicRoughness", {{"roughnessFactor", 1.5}, {"metallicFactor", -1}}}});
  CHECK(scene.materials[0].roughness == 1);
  CHECK(scene.materials[0].metallic == 0);
  CHECK(scene.warnings.size() == 2);
  const Scene dense = load(extension("KHR_materials_ior", {{"ior", 0}}));
  // 0 stands for an infinite index (KHR_materials_ior).
  CHECK(dense.materials[0].ior > 1e6f);
  CHECK(dense.warnings.empty());

  GltfFile file = file_with({{"normalTexture", {{"index", 0}}}});
  file.json["textures"][0] = extension("EXT_texture_webp", {{"source", 0}});
  const Scene webp = file.load();
  CHECK(webp.materials[0].normal_texture == no_texture);
  CHECK(webp.warnings.size() == 2);
}
