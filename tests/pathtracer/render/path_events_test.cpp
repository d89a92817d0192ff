#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <vector>

#include <glm/geometric.hpp>

#include "devices/devices.hpp"
#include "pathtracer/load/obj/obj_loader.hpp"
#include "pathtracer/load/scene_loader.hpp"
#include "pathtracer/render/device_scene.hpp"
#include "pathtracer/render/path_recorder.hpp"
#include "pathtracer/render/ray_tracer.hpp"
#include "pathtracer/render/renderer.hpp"
#include "tests/support/device_test.hpp"
#include "tests/support/scratch_folder.hpp"

using namespace tandem;
using namespace tandem::pathtracer;

namespace {

const std::filesystem::path source_directory = TANDEM_SOURCE_DIRECTORY;

constexpr RenderSettings small = {.width = 9, .height = 7, .max_depth = 5, .seed = 3};
constexpr std::uint32_t samples = 2;

std::vector<PathId> all_paths() {
  std::vector<PathId> paths;
  for (std::uint32_t y = 0; y < small.height; ++y)
    for (std::uint32_t x = 0; x < small.width; ++x)
      for (std::uint32_t sample = 0; sample < samples; ++sample) paths.push_back({.pixel = {x, y}, .sample = sample});
  return paths;
}

std::vector<TracingMode> forms_of(const rhi::Device& device) {
  std::vector<TracingMode> forms;
  if (device.info().capabilities.ray_query) forms.push_back(TracingMode::query);
  if (device.info().capabilities.ray_tracing_pipeline) forms.push_back(TracingMode::pipeline);
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

std::vector<PathStart> all_starts() {
  std::vector<PathStart> starts;
  for (const PathId& path : all_paths()) starts.push_back({.path = path});
  return starts;
}

/// Without what no result depends on: t and barycentrics, which pipelines and queries may compute differently.
PathEvents without_reports(PathEvents events) {
  for (PathEvent& event : events)
    for (std::size_t word = event_word::hit_t; word < event.words.size(); ++word) event.words[word] = 0;
  return events;
}

void check_rays(Renderer& renderer, const Scene& scene, const std::vector<PathId>& paths,
                const std::vector<PathEvents>& events) {
  std::vector<TracedRay> rays;
  for (std::size_t i = 0; i < paths.size(); ++i) {
    const std::vector<TracedRay> of_path = rays_of(paths[i], events[i]);
    REQUIRE_FALSE(of_path.empty());
    rays.insert(rays.end(), of_path.begin(), of_path.end());
  }
  CHECK(rays.size() == renderer.ray_count());
  const std::vector<std::uint32_t> answers = pathtracer::trace(renderer.scene(), rays);
  REQUIRE(answers.size() == rays.size());
  bool equal = true, any_hit = false, any_miss = false;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    equal = equal && answers[i] == rays[i].answer;
    if (rays[i].kind != RayKind::closest) continue;
    any_hit = any_hit || answers[i] != no_primitive;
    any_miss = any_miss || answers[i] == no_primitive;
    if (answers[i] != no_primitive) CHECK(answers[i] < scene.triangles.size() + scene.spheres.size());
  }
  CHECK(equal);
  CHECK(any_hit);
  CHECK(any_miss);
}

/// Summaries say what recordings hold, and their sums are the picture, bit by bit: recording changes no result.
void check_summaries(const Image& image, const std::vector<PathSummary>& summaries,
                     const std::vector<PathEvents>& events) {
  for (std::size_t i = 0; i < events.size(); ++i) {
    REQUIRE(events[i].size() == summaries[i].event_count);
    const PathEvent& end = events[i].back();
    REQUIRE(end.kind() == EventKind::end);
    CHECK(end.vector(event_word::end_radiance) == summaries[i].radiance);
    CHECK(events[i][0].kind() == EventKind::camera);
    CHECK(events[i][1].kind() == EventKind::segment);
  }
  for (std::size_t pixel = 0; pixel < image.pixels.size(); ++pixel) {
    glm::vec3 sum(0);
    for (std::size_t sample = 0; sample < samples; ++sample) sum += summaries[pixel * samples + sample].radiance;
    CHECK(sum / static_cast<float>(samples) == image.pixels[pixel]);
  }
}

/// Whatever segment a path is resumed from, the rest of it stays as it was.
void check_resumption(Renderer& renderer, const std::vector<PathId>& paths, const std::vector<PathEvents>& events) {
  std::vector<PathStart> starts;
  std::vector<std::pair<std::size_t, std::size_t>> places;  // the path, and the event in it
  for (std::size_t i = 0; i < paths.size(); ++i) {
    for (std::size_t j = 0; j < events[i].size(); ++j) {
      if (events[i][j].kind() != EventKind::segment) continue;
      starts.push_back({.path = paths[i], .state = events[i][j]});
      places.emplace_back(i, j);
    }
  }
  REQUIRE(starts.size() > paths.size());
  std::vector<PathEvents> resumed = record_paths(renderer.scene(), starts);
  for (PathStart& start : starts) start.segment_count = 1;
  const std::vector<PathEvents> single = record_paths(renderer.scene(), starts);
  bool same = true, single_same = true;
  for (std::size_t i = 0; i < starts.size(); ++i) {
    const auto& [path, event] = places[i];
    PathEvents rest(events[path].begin() + static_cast<std::ptrdiff_t>(event), events[path].end());
    // How many rays were traced before is not part of the state.
    for (PathEvents* list : {&rest, &resumed[i]}) list->back().words[3] = 0;
    same = same && resumed[i] == rest;
    // One segment, and how the next one begins, if there is one.
    for (std::size_t j = 0; j + 1 < single[i].size(); ++j) single_same = single_same && single[i][j] == rest[j];
    const bool goes_on = std::any_of(rest.begin() + 1, rest.end(),
                                     [](const PathEvent& each) { return each.kind() == EventKind::segment; });
    const auto reason = static_cast<EndReason>(single[i].back().words[event_word::end_reason]);
    single_same = single_same && (reason == EndReason::limit) == goes_on;
  }
  CHECK(same);
  CHECK(single_same);
}

void check_events(const rhi::DeviceHandle& device, const Scene& scene) {
  const std::vector<PathId> paths = all_paths();
  std::vector<PathEvents> first_form;
  for (const TracingMode form : forms_of(*device)) {
    CAPTURE(name(form));
    Renderer renderer(device, scene, small, form);
    REQUIRE(renderer.render(samples));
    const Image before = renderer.image();
    const std::vector<PathEvents> events = record_paths(renderer.scene(), all_starts());
    CHECK(renderer.image().pixels == before.pixels);
    REQUIRE(events.size() == paths.size());
    check_summaries(before, summarize_paths(renderer.scene(), all_starts()), events);
    check_rays(renderer, scene, paths, events);
    check_resumption(renderer, paths, events);

    if (first_form.empty()) first_form = events;
    bool same = true;
    for (std::size_t i = 0; i < events.size(); ++i)
      same = same && without_reports(events[i]) == without_reports(first_form[i]);
    CHECK(same);  // both forms find the same
  }
}

}  // namespace

TANDEM_DEVICE_TEST("The events of a path can be written down, resumed and summed, in every form") {
  check_events(device_handle, load_obj(source_directory / "scenes" / "cornell_box.obj"));
}

TANDEM_DEVICE_TEST("Events of paths through transparent triangles are as those of the picture") {
  check_events(device_handle, box_behind_a_veil());
}

TANDEM_DEVICE_TEST("Events of paths among spheres say where a procedural hit was") {
  const Scene scene = load_scene(source_directory / "scenes" / "cornell_box_spheres.json");
  REQUIRE_FALSE(scene.spheres.empty());
  check_events(device_handle, scene);
}

TANDEM_DEVICE_TEST("What a device reports of a hit belongs to the primitive that it names") {
  const Scene scene = in_device_order(load_obj(source_directory / "scenes" / "cornell_box.obj"));
  Renderer renderer(device_handle, scene, small);
  std::size_t hits = 0;
  for (const PathEvents& events : record_paths(renderer.scene(), all_starts())) {
    for (const PathEvent& event : events) {
      if (event.kind() != EventKind::ray || event.words[event_word::ray_kind] != 0) continue;
      const std::uint32_t answer = event.words[event_word::ray_answer];
      const auto kind = static_cast<HitKind>(event.words[event_word::hit_kind]);
      REQUIRE((kind == HitKind::none) == (answer == no_primitive));
      if (answer == no_primitive) continue;
      ++hits;
      const auto corner = [&](int i) { return glm::dvec3(scene.positions[scene.triangles[answer].vertices[i]]); };
      const double u = event.number(event_word::hit_barycentrics), v = event.number(event_word::hit_barycentrics + 1);
      const glm::dvec3 by_triangle = corner(0) * (1 - u - v) + corner(1) * u + corner(2) * v;
      const glm::dvec3 by_ray =
          glm::dvec3(event.vector(event_word::ray_origin)) +
          double{event.number(event_word::hit_t)} * glm::dvec3(event.vector(event_word::ray_direction));
      // The box is 560 wide: a few units in the last place of that, twice more along a grazing ray.
      CHECK(glm::distance(by_triangle, by_ray) < 1e-2);
      const glm::dvec3 normal = glm::cross(corner(1) - corner(0), corner(2) - corner(0));
      const bool front = glm::dot(normal, glm::dvec3(event.vector(event_word::ray_direction))) < 0;
      CHECK(front == (kind == HitKind::front));
    }
  }
  CHECK(hits > 100);
}

TEST_CASE("Where no vertex has texture coordinates, shaders that read them find zero") {
  // One device is enough, and this one does not take minutes to compile all features.
  const rhi::DeviceHandle device = create_device({.name = "cpu"});
  const Scene scene = load_obj(source_directory / "scenes" / "cornell_box.obj");
  REQUIRE(scene.texture_coordinates.empty());
  RenderSettings settings = small;
  settings.further_features = feature::all;
  Renderer renderer(device, scene, settings);
  std::size_t surfaces = 0;
  bool zero = true;
  for (const PathEvents& events : record_paths(renderer.scene(), all_starts())) {
    for (const PathEvent& event : events) {
      if (event.kind() != EventKind::surface) continue;
      ++surfaces;
      zero = zero && event.words[event_word::surface_texture_coordinates] == 0 &&
             event.words[event_word::surface_texture_coordinates + 1] == 0;
    }
  }
  CHECK(surfaces > 100);
  CHECK(zero);
}
