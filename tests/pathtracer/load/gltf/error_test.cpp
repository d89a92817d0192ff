#include <limits>

#include <doctest/doctest.h>

#include "base/error.hpp"
#include "pathtracer/load/gltf/loader.hpp"
#include "pathtracer/load/scene_loader.hpp"
#include "tests/pathtracer/load/gltf/file.hpp"
#include "tests/support/scratch_folder.hpp"

using namespace tandem::pathtracer;
using namespace tandem::test;

namespace {

std::string error_of(std::string_view name, std::string_view content) {
  const ScratchFolder folder;
  try {
    load_gltf(folder.write(name, content));
  } catch (const tandem::Error& error) {
    return error.what();
  }
  return "no error";
}

/// The error of a file of one triangle after a change.
template <class Change>
std::string error_after(Change change) {
  GltfFile file;
  file.add_triangle({{"name", "paint"}});
  change(file);
  return file.error();
}

void check_sentence(const std::string& sentence, std::string_view object, std::string_view fault) {
  CAPTURE(sentence);
  CHECK(contains(sentence, "test.gltf"));
  CHECK(contains(sentence, object));
  CHECK(contains(sentence, fault));
  CHECK_FALSE(contains(sentence, "\n"));
}

}  // namespace

TEST_CASE("glTF: files that are none") {
  CHECK_THROWS_AS(load_gltf("/nowhere/test.gltf"), tandem::Error);
  for (const char* text :
       {"", "no JSON", "{}", "[]", "{\"asset\": 3}", "\"asset\"", "{\"asset\": {\"version\": \"2.0\"}",
        "{\"asset\": {\"version\": \"1.0\"}}", "{\"asset\": {\"version\": \"2.0\"}}"}) {
    const std::string sentence = error_of("test.gltf", text);
    CAPTURE(text);
    CAPTURE(sentence);
    CHECK(contains(sentence, "test.gltf"));
  }
  CHECK(contains(error_of("test.gltf", std::string(100000, '[')), "nested"));
}

TEST_CASE("glTF: a binary file that is cut off anywhere is an error") {
  GltfFile file;
  file.add_triangle();
  const std::string whole = file.binary();
  REQUIRE(error_of("test.glb", whole) == "no error");
  for (std::size_t size = 0; size < whole.size(); size += size < 40 ? 1 : 37)
    CHECK_MESSAGE(error_of("test.glb", whole.substr(0, size)) != "no error", size);
  // Lengths that lie.
  for (const std::size_t word : {std::size_t{8}, std::size_t{12}, whole.size() - file.buffer.size() - 8})
    for (const char byte : {'\x7f', '\xff'}) {
      std::string changed = whole;
      changed[word + 3] = byte;
      CHECK(error_of("test.glb", changed) != "no error");
    }
  std::string other_version = whole;
  other_version[4] = 1;
  CHECK(contains(error_of("test.glb", other_version), "version 1"));
}

TEST_CASE("glTF: indices that are out of range name who refers to what") {
  const auto set = [](std::string path, const nlohmann::json& value) {
    return error_after([&](GltfFile& file) { file.json[nlohmann::json::json_pointer(path)] = value; });
  };
  check_sentence(set("/scene", 3), "the file", "scene 3");
  check_sentence(set("/scenes/0/nodes/0", 9), "the scene", "node 9");
  check_sentence(set("/nodes/0/mesh", 9), "node 0", "mesh 9");
  check_sentence(set("/nodes/0/camera", 0), "node 0", "camera 0");
  check_sentence(set("/nodes/0/children", {7}), "node 0", "node 7");
  check_sentence(set("/nodes/0/extensions/KHR_lights_punctual/light", 2), "node 0", "light 2");
  check_sentence(set("/meshes/0/primitives/0/material", 5), "mesh 0", "material 5");
  check_sentence(set("/meshes/0/primitives/0/attributes/POSITION", 8), "mesh 0", "accessor 8");
  check_sentence(set("/accessors/0/bufferView", 8), "accessor 0", "buffer view 8");
  check_sentence(set("/bufferViews/0/buffer", 8), "buffer view 0", "buffer 8");
  check_sentence(set("/materials/0/normalTexture/index", 4), "paint", "texture 4");
}

TEST_CASE("glTF: accessors and buffer views must stay within their buffers") {
  const auto set = [](std::string path, const nlohmann::json& value) {
    return error_after([&](GltfFile& file) { file.json[nlohmann::json::json_pointer(path)] = value; });
  };
  check_sentence(set("/accessors/0/count", 4), "accessor 0", "beyond");
  check_sentence(set("/accessors/0/count", 0x7fffffffffffffff), "accessor 0", "beyond");
  check_sentence(set("/accessors/0/byteOffset", 1), "accessor 0", "beyond");
  check_sentence(set("/accessors/0/byteOffset", 0xffffffffffffffffu), "accessor 0", "beyond");
  check_sentence(set("/accessors/0/componentType", 5130), "accessor 0", "componentType");
  check_sentence(set("/accessors/0/componentType", 5124), "accessor 0", "componentType");
  check_sentence(set("/accessors/0/type", "VEC2"), "accessor 0", "type");
  check_sentence(set("/accessors/0/type", "MAT4"), "accessor 0", "type");
  check_sentence(error_after([](GltfFile& file) {
                   file.json["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] = file.add_vectors({0, 0, 1});
                 }),
                 "primitive 0 of mesh 0", "NORMAL has 1");
  check_sentence(set("/bufferViews/0/byteLength", 100000), "buffer view 0", "beyond");
  check_sentence(set("/bufferViews/0/byteOffset", 0xffffffffffffffffu), "buffer view 0", "beyond");
  check_sentence(set("/bufferViews/0/byteStride", 8), "accessor 0", "apart");
  check_sentence(error_after([](GltfFile& file) {
                   file.json["accessors"][0].erase("bufferView");
                   file.json["accessors"][0]["count"] = 0x7fffffffffff;
                 }),
                 "accessor 0", "no data");
}

TEST_CASE("glTF: indices of vertices and of sparse elements must exist") {
  check_sentence(error_after([](GltfFile& file) {
                   file.json["meshes"][0]["primitives"][0]["indices"] = file.add_indices({0, 1, 3});
                 }),
                 "accessor 2", "index 2 is 3");
  check_sentence(error_after([](GltfFile& file) {
                   file.json["meshes"][0]["primitives"][0]["indices"] = file.add_indices({0, 1, 2, 0});
                 }),
                 "primitive 0 of mesh 0", "4 corners");
  check_sentence(error_after([](GltfFile& file) {
                   file.json["meshes"][0]["primitives"][0]["indices"] = file.add_vectors({0, 1, 2}, "VEC3");
                 }),
                 "accessor 2", "unsigned integers");
  const auto sparse = [](int count, std::vector<std::uint8_t> where) {
    return error_after([&](GltfFile& file) {
      const std::vector<float> values = {1, 2, 3, 4, 5, 6};
      file.json["accessors"][0]["sparse"] = {
          {"count", count},
          {"indices",
           {{"bufferView", file.add_view(where.data(), where.size())}, {"componentType", component_unsigned_byte}}},
          {"values", {{"bufferView", file.add_view(values.data(), 24)}}}};
    });
  };
  CHECK(sparse(2, {0, 2}) == "no error");
  check_sentence(sparse(2, {0, 3}), "accessor 0", "index 1 is 3");
  check_sentence(sparse(3, {0, 1, 2}), "accessor 0", "beyond");
  check_sentence(sparse(4, {0, 1, 2, 2}), "accessor 0", "sparse");
  check_sentence(sparse(-1, {0}), "accessor 0", "sparse");
}

TEST_CASE("glTF: positions must be finite and within reach, wherever a node puts them") {
  for (const float wrong : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), 1e13f})
    check_sentence(error_after([&](GltfFile& file) {
                     file.json["meshes"][0]["primitives"][0]["attributes"]["POSITION"] =
                         file.add_vectors({0, 0, 0, 1, 0, 0, 0, wrong, 0});
                   }),
                   "primitive 0 of mesh 0", "vertex 2");
  check_sentence(error_after([](GltfFile& file) {
                   file.json["nodes"][0]["scale"] = {1e300, 1e300, 1};
                 }),
                 "node 0", "vertex 1");
}

TEST_CASE("glTF: nodes form trees, and their transforms are some") {
  check_sentence(error_after([](GltfFile& file) { file.json["nodes"][0]["children"] = {0}; }), "node 0", "two parents");
  check_sentence(error_after([](GltfFile& file) {
                   file.json["nodes"] = {{{"children", {1}}}, {{"children", {0}}}};
                   file.json.erase("scenes");
                 }),
                 "node 0", "two parents");
  check_sentence(error_after([](GltfFile& file) { file.json["nodes"][0]["matrix"] = {1, 2, 3}; }), "node 0", "matrix");
  check_sentence(error_after([](GltfFile& file) {
                   file.json["nodes"][0]["rotation"] = {0, 0, 0, 0};
                 }),
                 "node 0", "quaternion");
  check_sentence(error_after([](GltfFile& file) {
                   file.json["nodes"][0]["camera"] = 0;
                   file.json["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 4}, {"znear", 1}}}}};
                 }),
                 "camera 0", "yfov");
}

TEST_CASE("glTF: buffers and images that are missing or broken") {
  check_sentence(error_after([](GltfFile& file) {
                   file.json["buffers"] = {{{"byteLength", 84}, {"uri", "gone.bin"}}};
                 }),
                 "gone.bin", "");
  const auto image = [](const nlohmann::json& source) {
    return error_after([&](GltfFile& file) {
      file.json["materials"][0]["normalTexture"]["index"] = 0;
      file.json["textures"] = {{{"source", 0}}};
      file.json["images"] = {source};
    });
  };
  check_sentence(image({{"uri", "gone.png"}}), "gone.png", "does not exist");
  check_sentence(image({{"uri", data_uri("image/png", {1, 2, 3})}}), "image 0", "");
  check_sentence(image({{"uri", "data:image/png;base64,"}}), "", "");
  check_sentence(image({{"bufferView", 0}, {"mimeType", "image/png"}}), "image 0", "");
  check_sentence(image({{"bufferView", 70}, {"mimeType", "image/png"}}), "image 0", "buffer view 70");
  check_sentence(image(nlohmann::json::object()), "", "uri");
}

TEST_CASE("glTF: an extension that the file requires and Tandem lacks is an error") {
  check_sentence(error_after([](GltfFile& file) {
                   file.json["extensionsUsed"] = file.json["extensionsRequired"] = {"KHR_draco_mesh_compression"};
                 }),
                 "KHR_draco_mesh_compression", "requires");
  check_sentence(error_after([](GltfFile& file) { file.json["materials"][0]["alphaMode"] = "SOME"; }), "paint", "SOME");
  check_sentence(error_after([](GltfFile& file) { file.json["nodes"][0].erase("mesh"); }), "", "no triangles");
}

TEST_CASE("A scene's loader knows glTF by either extension") {
  GltfFile file;
  file.add_triangle();
  const ScratchFolder folder;
  CHECK(load_scene(folder.write("a.gltf", file.text())).triangles.size() == 1);
  CHECK(load_scene(folder.write("a.GLB", file.binary())).triangles.size() == 1);
}
