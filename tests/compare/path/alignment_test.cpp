#include "compare/path/alignment.hpp"

#include <doctest/doctest.h>

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "compare/path/scene_names.hpp"

using namespace tandem;
using namespace tandem::compare;
using pathtracer::EventKind;
using pathtracer::PathEvent;
using pathtracer::PathEvents;

namespace {

PathEvent event(EventKind kind, std::uint32_t segment) {
  PathEvent result;
  result.words[0] = static_cast<std::uint32_t>(kind);
  result.words[1] = segment;
  return result;
}

PathEvent ray(std::uint32_t segment, std::uint32_t kind, std::uint32_t answer) {
  PathEvent result = event(EventKind::ray, segment);
  result.words[pathtracer::event_word::ray_kind] = kind;
  result.words[pathtracer::event_word::ray_answer] = answer;
  return result;
}

constexpr std::uint32_t closest = 0, occlusion = 1;

/// "segment|ray|-scatter+surface": kinds, with a sign where only a (-) or only b (+) has the event.
std::string shape(const std::vector<EventPair>& pairs) {
  std::string text;
  for (const EventPair& pair : pairs) {
    text += !pair.b ? "-" : !pair.a ? "+" : "=";
    text += name(pair.kind());
    text += std::to_string(pair.segment());
    text += " ";
  }
  return text;
}

const PathEvents two_segments = {
    event(EventKind::camera, 0),  event(EventKind::segment, 0), ray(0, closest, 7), event(EventKind::surface, 0),
    event(EventKind::scatter, 0), event(EventKind::segment, 1), ray(1, closest, 8), event(EventKind::end, 1)};

}  // namespace

TEST_CASE("A path and itself are paired event by event and do not differ") {
  const std::vector<EventPair> pairs = pair_events(two_segments, two_segments);
  REQUIRE(pairs.size() == two_segments.size());
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    CHECK(pairs[i].a == two_segments[i]);
    CHECK(pairs[i].b == two_segments[i]);
    CHECK_FALSE(differs(pairs[i]));
  }
  CHECK_FALSE(first_difference(pairs));
}

TEST_CASE("What one device did and the other did not stands alone, and both go on side by side") {
  // b meets nothing where a meets a surface, and ends there; a shadow ray is not the pendant of a segment's ray.
  const PathEvents a = {
      event(EventKind::segment, 0),      ray(0, closest, 7),           event(EventKind::surface, 0),
      event(EventKind::light_sample, 0), ray(0, occlusion, 0),         event(EventKind::visibility, 0),
      event(EventKind::direct_light, 0), event(EventKind::segment, 1), event(EventKind::end, 1)};
  const PathEvents b = {event(EventKind::segment, 0), ray(0, closest, 0xffffffffu), event(EventKind::emission, 0),
                        event(EventKind::end, 0)};
  const std::vector<EventPair> pairs = pair_events(a, b);
  CHECK(shape(pairs) ==
        "=segment0 =ray0 -surface0 -light sample0 -ray0 -visibility0 -direct light0 +emission0 +end0 -segment1 -end1 ");
  // Nothing is lost or moved, whichever device comes first.
  PathEvents first_of_pairs, second_of_pairs;
  for (const EventPair& pair : pair_events(b, a)) {
    if (pair.a) first_of_pairs.push_back(*pair.a);
    if (pair.b) second_of_pairs.push_back(*pair.b);
  }
  CHECK(first_of_pairs == b);
  CHECK(second_of_pairs == a);
  const std::optional<FirstDifference> first = first_difference(pairs);
  REQUIRE(first);
  CHECK(first->pair == 1);
  CHECK(std::string_view(first->field->name) == "answer");
}

TEST_CASE("Of several rays for the same purpose in a segment the first are paired") {
  const PathEvents a = {ray(2, occlusion, 0), ray(2, occlusion, 0), event(EventKind::visibility, 2)};
  const PathEvents b = {ray(2, occlusion, 0), event(EventKind::visibility, 2)};
  CHECK(shape(pair_events(a, b)) == "=ray2 -ray2 =visibility2 ");
  CHECK(shape(pair_events({}, b)) == "+ray2 +visibility2 ");
  CHECK(pair_events({}, {}).empty());
}

TEST_CASE("The first difference is named with its field and its distance") {
  PathEvents other = two_segments;
  other[4].set(12, 1.0f);
  PathEvents reference = two_segments;
  reference[4].set(12, 1.0000002384185791f);  // two units in the last place beyond 1
  // Differences after it do not count; nor does one before it in what is just observed.
  other[6].words[pathtracer::event_word::ray_answer] = 9;
  other[2].set(pathtracer::event_word::hit_t, 3.0f);
  const std::vector<EventPair> pairs = pair_events(reference, other);
  const std::optional<FirstDifference> first = first_difference(pairs);
  REQUIRE(first);
  CHECK(first->pair == 4);
  CHECK(std::string_view(first->field->name) == "weight");
  CHECK(first->ulp_distance == 2);
  CHECK(first->relative_difference == doctest::Approx(2.384e-7).epsilon(1e-3));
  const ObservedDifferences observed = observed_differences(pairs);
  CHECK(observed.fields == 2);  // t and barycentrics of the first ray; the second has another answer
  CHECK(observed.differing == 1);
  CHECK(observed.relative_difference == 1);
}

TEST_CASE("Names are those of the scene, and triangles are counted as devices do, opaque ones first") {
  pathtracer::Scene scene;
  scene.materials = {pathtracer::diffuse_material(glm::vec3(0.5f)), pathtracer::diffuse_material(glm::vec3(0.5f)),
                     pathtracer::diffuse_material(glm::vec3(0.5f))};
  scene.materials[0].opacity = 0.5f;
  scene.material_names = {"veil", "wall", ""};
  scene.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  scene.triangles = {{.vertices = {0, 1, 2}, .material = 0},
                     {.vertices = {0, 1, 2}, .material = 1 | pathtracer::triangle_smooth}};
  scene.spheres = {{.material = 2}};
  const SceneNames names(scene);
  CHECK(names.primitive(0) == "triangle 0 (wall)");
  CHECK(names.primitive(1) == "triangle 1 (veil)");
  CHECK(names.primitive(2) == "sphere 0 (material 2)");
  CHECK(names.primitive(0xffffffffu) == "nothing");
  CHECK(names.primitive(3) == "primitive 3, which the scene does not have");
  const auto field = [](EventKind kind, std::string_view name) -> const EventField& {
    for (const EventField& each : fields_of(kind))
      if (each.name == name) return each;
    FAIL("no such field");
    return fields_of(kind).front();
  };
  CHECK(names.text(field(EventKind::ray, "answer"), ray(0, closest, 1)) == "triangle 1 (veil)");
  CHECK(names.text(field(EventKind::ray, "answer"), ray(0, occlusion, 1)) == "blocked");
  CHECK(names.text(field(EventKind::ray, "answer"), ray(0, occlusion, 0)) == "free");
  PathEvent surface = event(EventKind::surface, 0);
  surface.words[2] = 1;
  CHECK(names.text(field(EventKind::surface, "material"), surface) == "1 (wall)");
}
