// What is valid but rare: sparse accessors, morph targets, skins, data URIs of other kinds, hidden nodes; and members
// of the wrong kind, which are refused.

#include <string>

#include <doctest/doctest.h>
#include <glm/vec3.hpp>

#include "base/error.hpp"
#include "pathtracer/load/gltf/loader.hpp"
#include "tests/pathtracer/load/gltf/file.hpp"
#include "tests/support/scratch_folder.hpp"

using namespace tandem;
using namespace tandem::pathtracer;
using tandem::test::ScratchFolder;

namespace {

/// A file of one triangle (0 0 0, 1 0 0, 0 1 0) after a change.
template <class Change>
Scene loaded_after(Change change) {
  test::GltfFile file;
  file.add_triangle();
  change(file);
  return file.load();
}

}  // namespace

TEST_CASE("glTF: sparse accessors replace values, of positions and of indices") {
  const Scene scene = loaded_after([](test::GltfFile& file) {
    const int moved = file.add_vectors({0, 0, 5});
    const int at = file.add_indices({2});
    const auto view_of = [&](int accessor) {
      return file.json["accessors"][static_cast<std::size_t>(accessor)]["bufferView"];
    };
    const int positions = file.json["meshes"][0]["primitives"][0]["attributes"]["POSITION"];
    file.json["accessors"][static_cast<std::size_t>(positions)]["sparse"] = {
        {"count", 1},
        {"indices", {{"bufferView", view_of(at)}, {"componentType", 5123}}},
        {"values", {{"bufferView", view_of(moved)}}}};
  });
  REQUIRE(scene.triangles.size() == 1);
  CHECK(scene.positions[scene.triangles[0].vertices[2]] == glm::vec3(0, 0, 5));
  CHECK(scene.positions[scene.triangles[0].vertices[1]] == glm::vec3(1, 0, 0));
}

TEST_CASE("glTF: morph targets have the weights of the node, or else of the mesh") {
  const auto morphed = [](const nlohmann::json& mesh_weights, const nlohmann::json& node_weights) {
    return loaded_after([&](test::GltfFile& file) {
             const int up = file.add_vectors({0, 0, 2, 0, 0, 2, 0, 0, 2});
             file.json["meshes"][0]["primitives"][0]["targets"] = {{{"POSITION", up}}};
             if (!mesh_weights.is_null()) file.json["meshes"][0]["weights"] = mesh_weights;
             if (!node_weights.is_null()) file.json["nodes"][0]["weights"] = node_weights;
           })
        .positions[0]
        .z;
  };
  CHECK(morphed(nullptr, nullptr) == 0);
  CHECK(morphed({0.5}, nullptr) == 1);
  CHECK(morphed({0.5}, {0.25}) == 0.5f);
}

TEST_CASE("glTF: a skinned mesh follows its joints and not its node") {
  const Scene scene = loaded_after([](test::GltfFile& file) {
    const int joints = file.add_accessor<std::uint16_t>({0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}, 5123, "VEC4");
    const int weights = file.add_vectors({1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, "VEC4");
    file.json["meshes"][0]["primitives"][0]["attributes"]["JOINTS_0"] = joints;
    file.json["meshes"][0]["primitives"][0]["attributes"]["WEIGHTS_0"] = weights;
    const int joint = file.add_node({{"translation", {0, 3, 0}}});
    file.json["skins"] = {{{"joints", {joint}}}};
    file.json["nodes"][0]["skin"] = 0;
    file.json["nodes"][0]["translation"] = {100, 0, 0};
  });
  CHECK(scene.positions[scene.triangles[0].vertices[1]] == glm::vec3(1, 3, 0));
}

TEST_CASE("glTF: a light below a node that is scaled to nothing is hidden") {
  const Scene scene = loaded_after([](test::GltfFile& file) {
    file.json["extensionsUsed"] = {"KHR_lights_punctual"};
    file.json["extensions"] = {
        {"KHR_lights_punctual", {{"lights", {{{"type", "spot"}, {"spot", nlohmann::json::object()}}}}}}};
    file.add_node({{"scale", {0, 0, 0}}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
  });
  CHECK(scene.lights.empty());
  CHECK(scene.triangles.size() == 1);
}

TEST_CASE("glTF: members of the wrong kind or range are named") {
  struct Case {
    const char* pointer;
    nlohmann::json value;
    const char* object;
    const char* member;
  };
  for (const auto& [pointer, value, object, member] :
       {Case{"/asset/minVersion", "3.0", "asset", "minVersion"}, Case{"/nodes/0/scale", "big", "node 0", "scale"},
        Case{"/nodes/0/translation", {1, 2}, "node 0", "translation"}, Case{"/nodes/0/mesh", -1, "node 0", "mesh"},
        Case{"/accessors/0/byteOffset", -4, "accessor 0", "byteOffset"},
        Case{"/accessors/0/count", 2.5, "accessor 0", "count"},
        Case{"/bufferViews/0/byteStride", -12, "buffer view 0", "byteStride"},
        Case{"/bufferViews/0/byteLength", "36", "buffer view 0", "byteLength"}}) {
    CAPTURE(pointer);
    test::GltfFile file;
    file.add_triangle();
    file.json[nlohmann::json::json_pointer(pointer)] = value;
    const std::string sentence = file.error();
    CAPTURE(sentence);
    CHECK(sentence.find(std::string(object) + ": ") != std::string::npos);
    CHECK(sentence.find(member) != std::string::npos);
  }
}

TEST_CASE("glTF: files outside of the scene's folder are read where that is allowed only") {
  const ScratchFolder folder;
  std::filesystem::create_directory(folder.path() / "scene");
  test::GltfFile file;
  file.add_triangle();
  folder.write("secret.bin", std::string(36, '\0'));
  file.json["buffers"] = {{{"byteLength", 36}, {"uri", "../secret.bin"}}};
  const std::filesystem::path path = folder.write("scene/x.gltf", file.json.dump());
  std::filesystem::create_symlink(folder.path() / "secret.bin", folder.path() / "scene/link.bin");
  CHECK_THROWS_WITH_AS(load_gltf(path), doctest::Contains("outside of the scene's folder"), Error);
  file.json["buffers"][0]["uri"] = "link.bin";
  CHECK_THROWS_WITH_AS(load_gltf(folder.write("scene/y.gltf", file.json.dump())),
                       doctest::Contains("outside of the scene's folder"), Error);
  // All zeros is one degenerate triangle, which is read.
  CHECK(load_gltf(path, {.allow_outside_files = true}).triangles.size() == 1);
}
