#include <doctest/doctest.h>

#include <cstring>
#include <filesystem>
#include <memory>
#include <vector>

#include "pathtracer/obj_loader.hpp"
#include "pathtracer/renderer.hpp"
#include "tests/pathtracer/scratch_folder.hpp"
#include "tests/support/device_test.hpp"

using namespace tandem;
using namespace tandem::pathtracer;

namespace {

const std::filesystem::path source_directory = TANDEM_SOURCE_DIRECTORY;

/// The test's device outlives the renderer, so it needs no owner.
rhi::DeviceHandle handle(rhi::Device& device) { return {std::shared_ptr<void>(), &device}; }

constexpr RenderSettings small = {.width = 9, .height = 7, .max_depth = 5, .seed = 3};
constexpr std::uint32_t samples = 2;

std::vector<PathId> all_paths() {
  std::vector<PathId> paths;
  for (std::uint32_t y = 0; y < small.height; ++y)
    for (std::uint32_t x = 0; x < small.width; ++x)
      for (std::uint32_t sample = 0; sample < samples; ++sample) paths.push_back({.pixel = {x, y}, .sample = sample});
  return paths;
}

std::vector<TraceForm> forms_of(const rhi::Device& device) {
  std::vector<TraceForm> forms;
  if (device.info().capabilities.ray_query) forms.push_back(TraceForm::query);
  if (device.info().capabilities.ray_tracing_pipeline) forms.push_back(TraceForm::pipeline);
  REQUIRE_FALSE(forms.empty());
  return forms;
}

/// The Cornell box behind a plate that covers half of the rays.
Scene box_behind_a_veil() {
  Scene scene = load_obj(source_directory / "scenes" / "cornell_box.obj");
  GpuMaterial veil = diffuse_material(glm::vec3(0.5f));
  veil.opacity = 0.5f;
  const auto material = static_cast<std::uint32_t>(scene.materials.size());
  scene.materials.push_back(veil);
  scene.material_names.emplace_back("veil");
  const Bounds box = bounds(scene);
  const auto first = static_cast<std::uint32_t>(scene.positions.size());
  for (const auto& [x, y] : {std::pair(box.minimum.x, box.minimum.y), std::pair(box.maximum.x, box.minimum.y),
                             std::pair(box.minimum.x, box.maximum.y)}) {
    scene.positions.emplace_back(x, y, box.centre().z);
    scene.normals.emplace_back(0, 0, 1);
    if (!scene.texture_coordinates.empty()) scene.texture_coordinates.emplace_back(0, 0);
  }
  // In front of the others in the list, so that the order on the device is another.
  scene.triangles.insert(scene.triangles.begin(), {.vertices = {first, first + 1, first + 2}, .material = material});
  return scene;
}

void check_log(rhi::Device& device, const Scene& scene) {
  const std::vector<PathId> paths = all_paths();
  std::vector<std::vector<TracedRay>> first_log;
  for (const TraceForm form : forms_of(device)) {
    CAPTURE(name(form));
    Renderer renderer(handle(device), scene, small, form);
    REQUIRE(renderer.render(samples));
    const Image before = renderer.image();
    const std::vector<std::vector<TracedRay>> log = renderer.log_paths(paths);
    CHECK(renderer.image().pixels == before.pixels);

    REQUIRE(log.size() == paths.size());
    std::vector<TracedRay> rays;
    for (const std::vector<TracedRay>& path : log) {
      REQUIRE_FALSE(path.empty());
      CHECK(path[0].origin == renderer.camera().position);
      rays.insert(rays.end(), path.begin(), path.end());
    }
    CHECK(rays.size() == renderer.ray_count());
    const std::vector<std::uint32_t> answers = renderer.answer(rays);
    REQUIRE(answers.size() == rays.size());
    bool equal = true, any_hit = false, any_miss = false;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      equal = equal && answers[i] == rays[i].answer;
      if (rays[i].kind != RayKind::closest) continue;
      any_hit = any_hit || answers[i] != no_triangle;
      any_miss = any_miss || answers[i] == no_triangle;
      if (answers[i] != no_triangle) CHECK(answers[i] < scene.triangles.size());
    }
    CHECK(equal);
    CHECK(any_hit);
    CHECK(any_miss);

    if (first_log.empty()) first_log = log;
    bool same = true;
    for (std::size_t i = 0; i < log.size(); ++i)
      same = same && log[i].size() == first_log[i].size() &&
             std::memcmp(log[i].data(), first_log[i].data(), log[i].size() * sizeof(TracedRay)) == 0;
    CHECK(same);  // both forms trace the same rays with the same answers
  }
}

}  // namespace

TANDEM_DEVICE_TEST("The rays of a path can be written down and answered again, in every form") {
  check_log(device, load_obj(source_directory / "scenes" / "cornell_box.obj"));
}

TANDEM_DEVICE_TEST("Rays through transparent triangles are answered again as they were") {
  check_log(device, box_behind_a_veil());
}
