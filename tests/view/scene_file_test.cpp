#include "tools/view/scene_file.hpp"

#include <doctest/doctest.h>

#include <fstream>

#include "base/error.hpp"
#include "pathtracer/load/scene_loader.hpp"
#include "pathtracer/scene/hash.hpp"
#include "tests/support/scratch_folder.hpp"
#include "tools/view/camera_controls.hpp"

namespace tandem::view {
namespace {

const std::filesystem::path scenes = TANDEM_SOURCE_DIRECTORY "/scenes";

View view_of(const pathtracer::Scene& scene) {
  View view;
  view.settings = pathtracer::render_settings(scene.settings);
  view.settings.camera = scene.camera ? *scene.camera : pathtracer::automatic_camera(scene, 1);
  view.lights = scene.lights;
  return view;
}

pathtracer::Scene saved(const SavedView& view, const std::filesystem::path& folder) {
  std::ofstream(folder / "saved.json") << scene_description(view, folder).dump();
  return pathtracer::load_scene(folder / "saved.json", {.allow_outside_files = true});
}

TEST_CASE("a saved view is the scene with the camera and the settings of the view") {
  for (const char* name : {"cornell_box.obj", "cornell_box_glossy.json", "veach_mis.json", "still_life.glb"}) {
    CAPTURE(name);
    const test::ScratchFolder folder;
    const pathtracer::Scene scene = pathtracer::load_scene(scenes / name);
    View view = view_of(scene);
    view.settings.camera = orbit(*view.settings.camera, {0.123, 0.045});
    view.settings.max_depth = 5;
    view.settings.sampler = pathtracer::SamplerKind::sobol;
    const pathtracer::Scene again = saved({scenes / name, scene, view, 12}, folder.path());
    pathtracer::Scene expected = scene;
    expected.camera = view.settings.camera;
    CHECK(pathtracer::scene_hash(again) == pathtracer::scene_hash(expected));
    REQUIRE(again.camera);
    CHECK(*again.camera == *view.settings.camera);
    CHECK(again.settings.samples == 12);
    pathtracer::RenderSettings settings = pathtracer::render_settings(again.settings);
    settings.camera = again.camera;
    settings.planned_samples = view.settings.planned_samples;
    CHECK(settings == view.settings);
  }
}

TEST_CASE("lights are saved as they are now") {
  const test::ScratchFolder folder;
  const pathtracer::Scene scene = pathtracer::load_scene(scenes / "cornell_box.obj");
  View view = view_of(scene);
  view.lights.push_back({.position = {0.1f, 0.7f, 0.3f}, .radiance = {1, 2, 0.3f}});
  view.lights.push_back({.kind = pathtracer::LightKind::spot,
                         .position = {0.1f, 0.7f, 0.3f},
                         .direction = {0.1f, -0.9f, 0.2f},
                         .radiance = {1, 2, 0.3f},
                         .inner_angle = 12.3f,
                         .outer_angle = 33.3f});
  view.lights.push_back(
      {.kind = pathtracer::LightKind::directional, .direction = {0.3f, -0.9f, 0.2f}, .radiance = {0.1f, 0.2f, 0.3f}});
  const pathtracer::Scene again = saved({scenes / "cornell_box.obj", scene, view, 1}, folder.path());
  pathtracer::Scene expected = scene;
  expected.lights = view.lights;
  expected.camera = view.settings.camera;
  CHECK(pathtracer::scene_hash(again) == pathtracer::scene_hash(expected));
}

TEST_CASE("a view whose lights a description cannot change is refused") {
  pathtracer::Scene scene = pathtracer::load_scene(scenes / "cornell_box.obj");
  scene.lights.push_back({.radiance = glm::vec3(1)});  // as if the model had it
  View view = view_of(scene);
  view.lights[0].radiance *= 2.0f;
  CHECK_THROWS_AS(scene_description({scenes / "cornell_box.obj", scene, view, 1}, "."), Error);
}

}  // namespace
}  // namespace tandem::view
