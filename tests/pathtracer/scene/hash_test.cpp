#include "pathtracer/scene/hash.hpp"

#include <doctest/doctest.h>

#include <functional>
#include <set>
#include <string>
#include <vector>

#include "pathtracer/load/scene_loader.hpp"

namespace tandem::pathtracer {
namespace {

const std::string scenes = TANDEM_SOURCE_DIRECTORY "/scenes/";

TEST_CASE("a scene has the same hash whenever it is loaded, whatever it is called") {
  Scene scene = load_scene(scenes + "still_life.glb");
  const std::string hash = scene_hash(scene);
  CHECK(hash.size() == 32);
  CHECK(scene_hash(load_scene(scenes + "still_life.glb")) == hash);
  scene.name = "other";
  scene.material_names.front() = "other";
  scene.settings.samples = 1000;
  scene.warnings.push_back("other");
  CHECK(scene_hash(scene) == hash);
}

TEST_CASE("every member that a picture can depend on changes the hash") {
  const Scene original = load_scene(scenes + "still_life.glb");
  REQUIRE(!original.images.empty());
  REQUIRE(!original.texture_coordinates.empty());
  // Each changes the last bit or the last entry of one member.
  const std::vector<std::function<void(Scene&)>> changes = {
      [](Scene&) {},
      [](Scene& scene) { scene.positions.back().z += 1e-3f; },
      [](Scene& scene) { scene.normals.back().x *= -1; },
      [](Scene& scene) { scene.texture_coordinates.back().y += 1e-3f; },
      [](Scene& scene) { scene.triangles.back().material ^= triangle_smooth; },
      [](Scene& scene) { scene.triangles.pop_back(); },
      [](Scene& scene) { scene.spheres.push_back({}); },
      [](Scene& scene) { scene.materials.back().bump_texture = 0; },
      [](Scene& scene) { scene.images.back().texels.back() ^= std::byte{1}; },
      [](Scene& scene) { scene.images.back().format = TexelFormat::half; },
      [](Scene& scene) { std::swap(scene.images.back().width, scene.images.back().height += 1); },
      [](Scene& scene) { scene.textures.back().gpu.alpha_b = 0.5f; },
      [](Scene& scene) { scene.textures.back().image += 1; },
      [](Scene& scene) { scene.lights.push_back({}); },
      [](Scene& scene) { scene.environment.emplace(); },
      [](Scene& scene) { scene.environment = Environment{.rotation = 1}; },
      [](Scene& scene) { scene.media.push_back({}); },
      [](Scene& scene) { scene.medium = 0; },
      [](Scene& scene) { scene.camera.emplace(); },
      [](Scene& scene) {
        scene.camera = Camera{.motion = {0, 0, 1}};
      },
  };
  std::set<std::string> hashes;
  for (const auto& change : changes) {
    Scene scene = original;
    scene.camera.reset();
    scene.environment.reset();
    change(scene);
    hashes.insert(scene_hash(scene));
  }
  CHECK(hashes.size() == changes.size());
}

}  // namespace
}  // namespace tandem::pathtracer
