#include <array>
#include <limits>

#include <doctest/doctest.h>
#include <glm/geometric.hpp>

#include "pathtracer/load/gltf/loader.hpp"
#include "tests/pathtracer/load/gltf/file.hpp"
#include "tests/support/scratch_folder.hpp"

using namespace tandem::pathtracer;
using namespace tandem::test;

namespace {

constexpr int strip = 5, fan = 6;

/// The unit square, counter-clockwise as seen from +z.
const std::vector<float> square = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};

glm::vec3 normal(const Scene& scene, std::size_t triangle) {
  const auto& [a, b, c] = scene.triangles[triangle].vertices;
  return glm::cross(scene.positions[b] - scene.positions[a], scene.positions[c] - scene.positions[a]);
}

bool is_smooth(const GpuTriangle& triangle) { return (triangle.material & triangle_smooth) != 0; }

double total_area(const Scene& scene) {
  double area = 0;
  for (const GpuTriangle& triangle : scene.triangles) area += triangle_area(scene, triangle);
  return area;
}

/// Whether all triangles are seen counter-clockwise from +z and cover the unit square once.
void check_square(const Scene& scene, std::size_t triangles) {
  CHECK(scene.triangles.size() == triangles);
  CHECK(total_area(scene) == doctest::Approx(1));
  for (std::size_t i = 0; i < scene.triangles.size(); ++i) CHECK(normal(scene, i).z > 0);
}

}  // namespace

TEST_CASE("glTF: lists with every type of index, and without indices, strips and fans mean the same square") {
  const auto load = [](int mode, const std::vector<float>& positions, auto indices, int type) {
    GltfFile file;
    nlohmann::json primitive = {{"mode", mode}, {"attributes", {{"POSITION", file.add_vectors(positions)}}}};
    if (!indices.empty()) primitive["indices"] = file.add_accessor(indices, type, "SCALAR");
    file.add_node({{"mesh", file.add_mesh(primitive)}});
    const Scene scene = file.load();
    CHECK(scene.warnings.empty());
    return scene;
  };
  check_square(load(4, square, std::vector<std::uint8_t>{0, 1, 2, 0, 2, 3}, component_unsigned_byte), 2);
  check_square(load(4, square, std::vector<std::uint16_t>{0, 1, 2, 0, 2, 3}, component_unsigned_short), 2);
  check_square(load(4, square, std::vector<std::uint32_t>{0, 1, 2, 0, 2, 3}, component_unsigned_int), 2);
  check_square(load(4, {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 0, 0, 1, 1, 0, 0, 1, 0}, std::vector<std::uint8_t>{}, 0), 2);
  check_square(load(fan, square, std::vector<std::uint8_t>{}, 0), 2);
  check_square(load(strip, square, std::vector<std::uint8_t>{0, 1, 3, 2}, component_unsigned_byte), 2);
  // Three triangles, so that every parity occurs and the winding of each counts.
  check_square(load(strip, {0, 0, 0, 1, 0, 0, 0, 0.5f, 0, 1, 1, 0, 0, 1, 0}, std::vector<std::uint8_t>{}, 0), 3);
  check_square(load(fan, {0, 0, 0, 1, 0, 0, 1, 0.5f, 0, 1, 1, 0, 0, 1, 0}, std::vector<std::uint8_t>{}, 0), 3);
}

TEST_CASE("glTF: a binary file, a buffer beside the file and one inside it mean the same") {
  GltfFile file;
  file.add_triangle();
  const ScratchFolder folder;
  const Scene binary = load_gltf(folder.write("binary.glb", file.binary()));
  const std::string data(file.buffer.begin(), file.buffer.end());
  folder.write("the data.bin", data);
  GltfFile external = file;
  external.json["buffers"] = {{{"byteLength", file.buffer.size()}, {"uri", "the%20data.bin"}}};
  const Scene beside = load_gltf(folder.write("external.gltf", external.text()));
  const Scene inside = file.load();
  CHECK(inside.positions == std::vector<glm::vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
  CHECK(binary.positions == inside.positions);
  CHECK(beside.positions == inside.positions);
  CHECK(binary.name == "binary.glb");
}

TEST_CASE("glTF: interleaved attributes, offsets of accessors, and vertices that nothing uses") {
  GltfFile file;
  // Position, four bytes of something else, and a first vertex that is no number and belongs to nobody.
  std::vector<float> data = {std::numeric_limits<float>::quiet_NaN(), 0, 0, 7, 0, 0, 0, 7, 1, 0, 0, 7, 0, 1, 0, 7};
  const int view = file.add_view(data.data(), data.size() * sizeof(float), 16);
  const nlohmann::json accessor = {{"bufferView", view}, {"componentType", component_float}, {"type", "VEC3"}};
  nlohmann::json whole = accessor, offset = accessor;
  whole["count"] = 4;
  offset["count"] = 3;
  offset["byteOffset"] = 16;
  const int indexed = file.add_mesh(
      {{"attributes", {{"POSITION", file.add("accessors", whole)}}}, {"indices", file.add_indices({1, 2, 3})}});
  const int plain = file.add_mesh({{"attributes", {{"POSITION", file.add("accessors", offset)}}}});
  file.add_node({{"mesh", indexed}});
  file.add_node({{"mesh", plain}});
  const Scene scene = file.load();
  CHECK(scene.positions == std::vector<glm::vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
}

TEST_CASE("glTF: sparse accessors replace elements, of a buffer view or of zeros") {
  GltfFile file;
  const std::vector<std::uint8_t> where = {1, 2};
  const std::vector<float> values = {1, 0, 0, 0, 2, 0};
  const nlohmann::json sparse = {
      {"count", 2},
      {"indices", {{"bufferView", file.add_view(where.data(), 2)}, {"componentType", component_unsigned_byte}}},
      {"values", {{"bufferView", file.add_view(values.data(), values.size() * sizeof(float))}}}};
  const int zeros =
      file.add("accessors", {{"componentType", component_float}, {"count", 3}, {"type", "VEC3"}, {"sparse", sparse}});
  const int replaced = file.add_vectors({5, 5, 5, 6, 6, 6, 7, 7, 7});
  file.json["accessors"][static_cast<std::size_t>(replaced)]["sparse"] = sparse;
  file.add_node({{"mesh", file.add_mesh({{"attributes", {{"POSITION", zeros}}}})}});
  file.add_node({{"mesh", file.add_mesh({{"attributes", {{"POSITION", replaced}}}})}});
  CHECK(file.load().positions ==
        std::vector<glm::vec3>{{0, 0, 0}, {1, 0, 0}, {0, 2, 0}, {5, 5, 5}, {1, 0, 0}, {0, 2, 0}});
}

TEST_CASE("glTF: quantised attributes are what glTF's equations make of them") {
  GltfFile file;
  file.json["extensionsUsed"] = file.json["extensionsRequired"] = {"KHR_mesh_quantization"};
  file.json["materials"] = {{{"emissiveTexture", {{"index", 0}}}, {"emissiveFactor", {1, 1, 1}}}};
  file.json["textures"] = {{{"source", 0}}};
  file.json["images"] = {{{"uri", data_uri("image/png", png(1, 1, {1, 2, 3, 255}))}}};
  const auto add = [&](int positions, int normals, int coordinates) {
    file.add_node(
        {{"mesh", file.add_mesh(
                      {{"material", 0},
                       {"attributes", {{"POSITION", positions}, {"NORMAL", normals}, {"TEXCOORD_0", coordinates}}}})}});
  };
  add(file.add_accessor(std::vector<std::int16_t>{-32768, 0, 0, 32767, 0, 0, 0, 32767, 0}, component_short, "VEC3",
                        true, 8),
      file.add_accessor(std::vector<std::int8_t>{127, 0, 0, 0, 127, 0, 0, 0, -128}, component_byte, "VEC3", true, 4),
      file.add_accessor(std::vector<std::uint16_t>{0, 65535, 65535, 0, 13107, 0}, component_unsigned_short, "VEC2",
                        true));
  add(file.add_accessor(std::vector<std::uint8_t>{0, 0, 0, 200, 0, 0, 0, 7, 0}, component_unsigned_byte, "VEC3", false,
                        4),
      file.add_accessor(std::vector<std::int16_t>{32767, 0, 0, 0, 32767, 0, 0, 0, 32767}, component_short, "VEC3", true,
                        8),
      file.add_accessor(std::vector<std::uint8_t>{0, 255, 51, 0, 255, 255}, component_unsigned_byte, "VEC2", true, 4));
  const Scene scene = file.load();
  REQUIRE(scene.positions.size() == 6);
  CHECK(scene.positions[0] == glm::vec3(-1, 0, 0));  // the least integer is clamped
  CHECK(scene.positions[1] == glm::vec3(1, 0, 0));
  CHECK(scene.normals[2] == glm::vec3(0, 0, -1));
  CHECK(scene.positions[4] == glm::vec3(200, 0, 0));
  CHECK(scene.positions[5] == glm::vec3(0, 7, 0));
  // v points upwards here, downwards in the file.
  CHECK(scene.texture_coordinates[0] == glm::vec2(0, 0));
  CHECK(scene.texture_coordinates[1] == glm::vec2(1, 1));
  CHECK(scene.texture_coordinates[2].x == doctest::Approx(0.2f));
  CHECK(scene.texture_coordinates[4].x == doctest::Approx(0.2f));
  CHECK(scene.warnings.empty());
}

TEST_CASE("glTF: triangles are smooth where their normals differ from their own") {
  const auto first = [](const std::vector<float>& normals) {
    GltfFile file;
    nlohmann::json attributes = {{"POSITION", file.add_vectors({0, 0, 0, 1, 0, 0, 0, 1, 0})}};
    if (!normals.empty()) attributes["NORMAL"] = file.add_vectors(normals);
    file.add_node({{"mesh", file.add_mesh({{"attributes", attributes}})}});
    return file.load();
  };
  CHECK_FALSE(is_smooth(first({}).triangles[0]));
  CHECK_FALSE(is_smooth(first({0, 0, 1, 0, 0, 1, 0, 0, 1}).triangles[0]));
  const Scene smooth = first({0, 0, 2, 0, 0, 1, 3, 0, 4});
  CHECK(is_smooth(smooth.triangles[0]));
  CHECK(smooth.warnings.empty());
  CHECK(smooth.normals[0] == glm::vec3(0, 0, 1));
  CHECK(smooth.normals[2] == glm::vec3(0.6f, 0, 0.8f));
  for (const float wrong : {0.0f, std::numeric_limits<float>::quiet_NaN()}) {
    const Scene scene = first({0, 0, wrong, 0, 0, 1, 3, 0, 4});
    CHECK_FALSE(is_smooth(scene.triangles[0]));
    CHECK(scene.normals[0] == glm::vec3(0, 0, 1));
    REQUIRE(scene.warnings.size() == 1);
    CHECK(contains(scene.warnings[0], "normals without direction"));
  }
}

TEST_CASE("glTF: a colour that all vertices share multiplies the material's; one that varies stays with the vertices") {
  GltfFile file;
  file.json["materials"] = {{{"name", "paint"},
                             {"alphaMode", "BLEND"},
                             {"pbrMetallicRoughness", {{"baseColorFactor", {1, 0.5, 0.25, 0.5}}}}}};
  const int positions = file.add_vectors({0, 0, 0, 1, 0, 0, 0, 1, 0});
  const auto add = [&](int colors) {
    file.add_node(
        {{"mesh", file.add_mesh({{"material", 0}, {"attributes", {{"POSITION", positions}, {"COLOR_0", colors}}}})}});
  };
  add(file.add_vectors({1, 1, 1, 1, 1, 1, 1, 1, 1}));
  add(file.add_vectors({0.5f, 0.5f, 0.5f, 0.5f, 0.5f, 0.5f, 0.5f, 0.5f, 0.5f, 0.5f, 0.5f, 0.5f}, "VEC4"));
  add(file.add_accessor(std::vector<std::uint8_t>{255, 0, 0, 255, 255, 0, 0, 255, 255, 0, 0, 255},
                        component_unsigned_byte, "VEC4", true));
  const Scene constant = file.load();
  CHECK(constant.warnings.empty());
  REQUIRE(constant.materials.size() == 3);
  CHECK(constant.triangles[0].material == 0);
  CHECK(constant.materials[1].base_color == glm::vec3(0.5f, 0.25f, 0.125f));
  CHECK(constant.materials[1].opacity == 0.25f);
  CHECK(constant.materials[2].base_color == glm::vec3(1, 0, 0));
  CHECK(constant.material_names == std::vector<std::string>{"paint", "paint", "paint"});

  CHECK(constant.attributes.empty());

  for (int repetition = 0; repetition < 2; ++repetition) add(file.add_vectors({1, 1, 1, 1, 1, 1, 1, 1, 0}));
  add(file.add_vectors({1, 1, 1, 1, 1, 1, 1, 0.5f, 0, 1, 1, 1}, "VEC4"));
  const Scene varying = file.load();
  CHECK(varying.warnings.empty());
  REQUIRE(varying.materials.size() == 5);
  CHECK(varying.materials[0].attributes == 0);
  CHECK(varying.materials[3].attributes == vertex_attribute::color);
  CHECK(varying.materials[3].base_color == glm::vec3(1, 0.5f, 0.25f));
  CHECK(varying.materials[4].attributes == (vertex_attribute::color | vertex_attribute::opacity));
  CHECK(is_transparent(varying.materials[4]));
  REQUIRE(varying.attributes.size() == varying.positions.size());
  const GpuTriangle& last = varying.triangles.back();
  CHECK(varying.attributes[last.vertices[1]].color == glm::vec3(1, 1, 1));
  CHECK(varying.attributes[last.vertices[1]].opacity == 0.5f);
  CHECK(varying.attributes[last.vertices[2]].color == glm::vec3(0, 1, 1));
  CHECK(varying.attributes[varying.triangles[0].vertices[2]].color == glm::vec3(1));

  // Alpha counts where the material says so; an unlit material shows its colour by emitting it.
  file.json["materials"][0].erase("alphaMode");
  CHECK(file.load().materials.back().attributes == vertex_attribute::color);
  file.json["materials"][0]["extensions"] = {{"KHR_materials_unlit", nlohmann::json::object()}};
  CHECK(file.load().materials.back().attributes == (vertex_attribute::color | vertex_attribute::emission));
}

TEST_CASE("glTF: tangents that are given go with a normal map, and turn with their node") {
  GltfFile file;
  const auto attributes = nlohmann::json{{"POSITION", file.add_vectors({0, 0, 0, 1, 0, 0, 0, 1, 0})},
                                         {"NORMAL", file.add_vectors({0, 0, 1, 0, 0, 1, 0, 0, 1})},
                                         {"TEXCOORD_0", file.add_vectors({0, 0, 1, 0, 0, 1}, "VEC2")},
                                         {"TANGENT", file.add_vectors({0, 2, 0, 1, 0, 2, 0, 1, 0, 2, 0, 1}, "VEC4")}};
  file.json["images"] = {{{"uri", data_uri("image/png", png(1, 1, {9, 9, 9, 9}))}}};
  file.json["textures"] = {{{"source", 0}}};
  file.json["materials"] = {{{"normalTexture", {{"index", 0}}}}};
  // A quarter turn about z and a mirror of x.
  const int node = file.add_node({{"mesh", file.add_mesh({{"material", 0}, {"attributes", attributes}})}});
  const auto tangent = [&](const nlohmann::json& matrix) {
    file.json["nodes"][static_cast<std::size_t>(node)]["matrix"] = matrix;
    const Scene scene = file.load();
    CHECK(scene.warnings.empty());
    CHECK(scene.materials[scene.triangles[0].material & ~triangle_smooth].attributes == vertex_attribute::tangent);
    return scene.attributes[scene.triangles[0].vertices[0]].tangent;
  };
  CHECK(tangent({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}) == glm::vec4(0, 1, 0, 1));
  CHECK(tangent({0, 3, 0, 0, -3, 0, 0, 0, 0, 0, 3, 0, 0, 0, 0, 1}) == glm::vec4(-1, 0, 0, 1));
  CHECK(tangent({-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}) == glm::vec4(0, 1, 0, -1));
  // Without a normal map they mean nothing, and without normals they are to be ignored.
  file.json["meshes"][0]["primitives"][0]["attributes"].erase("NORMAL");
  CHECK(file.load().attributes.empty());
}

TEST_CASE("glTF: what is not drawn is one warning each") {
  GltfFile file;
  file.add_triangle();
  const int positions = file.add_vectors({0, 0, 0, 1, 0, 0, 0, 1, 0});
  for (const int mode : {0, 1, 2, 3})
    file.add_node({{"mesh", file.add_mesh({{"mode", mode}, {"attributes", {{"POSITION", positions}}}})}});
  const int targets = file.add(
      "meshes",
      {{"weights", {0.5}},
       {"primitives", {{{"attributes", {{"POSITION", positions}}}, {"targets", {{{"POSITION", positions}}}}}}}});
  file.add_node({{"mesh", targets}, {"skin", 0}});
  file.add_node({{"mesh", targets}, {"skin", 0}});
  file.json["skins"] = {{{"joints", {0}}}};
  file.json["animations"] = {{{"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "scale"}}}}}},
                              {"samplers", {{{"input", positions}, {"output", positions}}}}}};
  file.json["extensionsUsed"] = {"KHR_materials_clearcoat", "KHR_materials_ior"};
  file.json["nodes"][0]["extensions"] = {{"EXT_mesh_gpu_instancing", {{"attributes", {{"SCALE", 0}}}}}};
  const Scene scene = file.load();
  CHECK(scene.triangles.size() == 3);
  REQUIRE(scene.warnings.size() == 5);
  std::string all;
  for (const std::string& warning : scene.warnings) all += warning;
  for (const char* part :
       {"KHR_materials_clearcoat", "EXT_mesh_gpu_instancing", "points and lines", "skin", "animations"})
    CHECK_MESSAGE(contains(all, part), part);
}
