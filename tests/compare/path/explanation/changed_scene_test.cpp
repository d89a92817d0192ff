#include <doctest/doctest.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "compare/path/alignment.hpp"
#include "compare/path/scene_names.hpp"
#include "pathtracer/load/obj/obj_loader.hpp"
#include "pathtracer/render/device_scene.hpp"
#include "pathtracer/render/path_recorder.hpp"
#include "tests/support/device_test.hpp"

// A device that is given another scene than the other one: what differs first must be what was changed.

using namespace tandem;
using namespace tandem::compare;
using pathtracer::EventKind;
using pathtracer::PathEvent;
using pathtracer::PathEvents;
using pathtracer::Scene;

namespace {

constexpr pathtracer::RenderSettings settings = {.width = 12, .height = 12, .max_depth = 6, .seed = 5};

Scene cornell_box() {
  return pathtracer::load_obj(std::filesystem::path(TANDEM_SOURCE_DIRECTORY) / "scenes/cornell_box.obj");
}

std::uint32_t material(const Scene& scene, std::string_view name) {
  const auto found = std::ranges::find(scene.material_names, name);
  REQUIRE(found != scene.material_names.end());
  return static_cast<std::uint32_t>(found - scene.material_names.begin());
}

std::vector<PathEvents> record(const rhi::DeviceHandle& device, const Scene& scene) {
  std::vector<pathtracer::PathStart> starts;
  for (std::uint32_t y = 0; y < settings.height; ++y)
    for (std::uint32_t x = 0; x < settings.width; ++x) starts.push_back({.path = {.pixel = {x, y}, .sample = 1}});
  pathtracer::SceneOnDevice on_device(device, scene, settings);
  return pathtracer::record_paths(on_device, starts);
}

const EventField& field(EventKind kind, std::string_view name) {
  const std::span<const EventField> fields = fields_of(kind);
  const auto found = std::ranges::find(fields, name, &EventField::name);
  REQUIRE(found != fields.end());
  return *found;
}

/// A path's first difference with the event in which it is.
struct Found {
  std::vector<EventPair> pairs;
  std::optional<FirstDifference> first;
  const EventPair& pair() const { return pairs[first->pair]; }
  std::string_view field() const { return first->field == nullptr ? "" : first->field->name; }
};

std::vector<Found> compare_scenes(const rhi::DeviceHandle& device, const Scene& a, const Scene& b) {
  const std::vector<PathEvents> of_a = record(device, a), of_b = record(device, b);
  std::vector<Found> found;
  for (std::size_t i = 0; i < of_a.size(); ++i) {
    found.push_back({.pairs = pair_events(of_a[i], of_b[i]), .first = {}});
    found.back().first = first_difference(found.back().pairs);
  }
  return found;
}

}  // namespace

TANDEM_DEVICE_TEST("Another albedo is named where a path first meets it") {
  const Scene scene = cornell_box();
  const std::uint32_t red = material(scene, "red");
  Scene other = scene;
  other.materials[red].base_color.x *= 0.9f;
  std::size_t differing = 0;
  for (const Found& path : compare_scenes(device_handle, scene, other)) {
    const auto meets_red = std::ranges::find_if(path.pairs, [&](const EventPair& pair) {
      return pair.kind() == EventKind::surface && pair.event().words[field(EventKind::surface, "material").word] == red;
    });
    if (!path.first) continue;
    ++differing;
    REQUIRE(meets_red != path.pairs.end());
    CHECK(path.pair().segment() == meets_red->segment());
    const bool value = path.pair().kind() == EventKind::light_value && path.field() == "bsdf";
    const bool weight = path.pair().kind() == EventKind::scatter && path.field() == "weight";
    CAPTURE(name(path.pair().kind()));
    CAPTURE(path.field());
    CHECK((value || weight));
    // A tenth of what it was: more than any rounding.
    CHECK(path.first->relative_difference > 0.01);
  }
  CHECK(differing > 20);
}

TANDEM_DEVICE_TEST("Another light is named where a path first sees it") {
  const Scene scene = cornell_box();
  Scene other = scene;
  other.materials[material(scene, "light")].emission *= 1.25f;
  std::size_t differing = 0;
  for (const Found& path : compare_scenes(device_handle, scene, other)) {
    const auto sees_light = std::ranges::find_if(path.pairs, [](const EventPair& pair) {
      if (pair.kind() != EventKind::light_sample && pair.kind() != EventKind::emission) return false;
      return pair.event().vector(field(pair.kind(), "radiance").word) != glm::vec3(0);
    });
    REQUIRE(path.first.has_value() == (sees_light != path.pairs.end()));
    if (!path.first) continue;
    ++differing;
    CHECK(path.first->pair == static_cast<std::size_t>(sees_light - path.pairs.begin()));
    CHECK(path.field() == "radiance");
    CHECK(path.first->relative_difference == doctest::Approx(0.2).epsilon(1e-3));
  }
  CHECK(differing > 100);
}

TANDEM_DEVICE_TEST("A moved vertex is named by a ray or a surface of a triangle that has it") {
  const Scene scene = cornell_box();
  Scene other = scene;
  // The last vertex belongs to a block, which nothing else touches.
  const std::uint32_t moved = scene.triangles.back().vertices[2];
  other.positions[moved] += glm::vec3(20, 10, 0);
  const std::vector<pathtracer::GpuTriangle> triangles = pathtracer::in_device_order(scene).triangles;
  const auto has_vertex = [&](std::uint32_t answer) {
    return answer < triangles.size() && std::ranges::count(triangles[answer].vertices, moved) > 0;
  };
  std::size_t differing = 0;
  for (const Found& path : compare_scenes(device_handle, scene, other)) {
    if (!path.first) continue;
    ++differing;
    const EventKind kind = path.pair().kind();
    REQUIRE((kind == EventKind::ray || kind == EventKind::surface));
    const bool shadow = kind == EventKind::ray && path.pair().event().words[pathtracer::event_word::ray_kind] != 0;
    if (kind == EventKind::ray) CHECK(path.field() == "answer");
    if (shadow) continue;  // what blocks it has no name
    bool named = false;
    for (const EventPair& pair : path.pairs) {
      if (pair.kind() != EventKind::ray || pair.segment() != path.pair().segment()) continue;
      if (!pair.a || !pair.b || pair.a->words[pathtracer::event_word::ray_kind] != 0) continue;
      named = has_vertex(pair.a->words[pathtracer::event_word::ray_answer]) ||
              has_vertex(pair.b->words[pathtracer::event_word::ray_answer]);
    }
    CHECK(named);
  }
  CHECK(differing > 5);
}
