#include "compare/cause/divergence_sentence.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <string>
#include <string_view>

#include "tests/compare/path_recordings.hpp"

namespace tandem::compare {
namespace {

using pathtracer::EventKind;
using pathtracer::PathEvent;
using pathtracer::RayKind;
namespace word = pathtracer::event_word;

const EventField* field(EventKind kind, std::string_view name) {
  const auto found = std::ranges::find(fields_of(kind), name, &EventField::name);
  REQUIRE(found != fields_of(kind).end());
  return &*found;
}

/// Two triangles side by side in the plane z = 1, and a sphere.
pathtracer::Scene two_triangles() {
  pathtracer::Scene scene;
  scene.positions = {{0, 0, 1}, {2, 0, 1}, {0, 2, 1}, {2, 2, 1}};
  scene.triangles = {{.vertices = {0, 1, 2}, .material = 0}, {.vertices = {1, 3, 2}, .material = 0}};
  scene.spheres = {{.centre = {9, 9, 9}, .radius = 1, .material = 0}};
  return scene;
}

/// Both devices trace the ray of segment 2 and get these answers.
Divergence two_answers(DifferenceClass difference_class, std::uint32_t of_a, std::uint32_t of_b,
                       RayKind kind = RayKind::closest) {
  return {.difference_class = difference_class,
          .segment = 2,
          .a = ray_event({1, 1, 0}, {0, 0, 1}, of_a, 1, kind),
          .b = ray_event({1, 1, 0}, {0, 0, 1}, of_b, 1, kind)};
}

TEST_CASE("answers are named by what they mean") {
  const pathtracer::Scene scene = two_triangles();
  CHECK(answer_text(scene, RayKind::closest, 1) == "triangle 1");
  CHECK(answer_text(scene, RayKind::closest, 2) == "sphere 0");
  CHECK(answer_text(scene, RayKind::closest, pathtracer::no_primitive) == "nothing");
  CHECK(answer_text(scene, RayKind::occlusion, 1) == "something");
  CHECK(answer_text(scene, RayKind::occlusion, 0) == "nothing");
}

TEST_CASE("a value that rounding moved says by how much, and one that it does not says both") {
  PathEvent a = segment_event(3, {1, 2, 3}, {0, 0, 1}), b = a;
  b.set(word::segment_throughput, glm::vec3(0.5f, 0.25f, 0.125f));
  Divergence divergence{.difference_class = DifferenceClass::rounding,
                        .segment = 3,
                        .a = a,
                        .b = b,
                        .field = field(EventKind::segment, "throughput"),
                        .ulp_distance = 7,
                        .relative_difference = 0.25};
  CHECK(sentence_of(divergence) ==
        "Segment 3: the throughput of the segment differs by 7 units in the last place (0.25 relative): rounding.");
  divergence.difference_class = DifferenceClass::mismatch;
  CHECK(sentence_of(divergence) ==
        "Segment 3: the throughput of the segment is (0.5, 0.25, 0) on a and (0.5, 0.25, 0.125) on b, 0.25 relative, "
        "from the same state: more than rounding explains.");
}

TEST_CASE("what a device reports of a hit is said to be about the same hit") {
  const PathEvent a = ray_event({1, 1, 0}, {0, 0, 1}, 0, 1.0f), b = ray_event({1, 1, 0}, {0, 0, 1}, 0, 1.5f);
  CHECK(sentence_of({.segment = 1, .a = a, .b = b, .field = field(EventKind::ray, "t")}) ==
        "Segment 1: the t of the ray is (1) on a and (1.5) on b, for the same hit of the same ray: more than rounding "
        "explains.");
}

TEST_CASE("the camera has no segment") {
  const PathEvent a = event(EventKind::camera);
  PathEvent b = a;
  b.words[7] = 1;
  CHECK(
      sentence_of({.a = a, .b = b, .field = field(EventKind::camera, "sample")}) ==
      "Camera: the sample of the camera is 0 on a and 1 on b: from the same state, and rounding does not explain it.");
}

TEST_CASE("a flipped roulette names its number and threshold, on whichever device it goes on") {
  Divergence divergence{.difference_class = DifferenceClass::flipped_decision,
                        .segment = 4,
                        .a = roulette_event(0.5f, 0.5f, false),
                        .b = roulette_event(0.5f, 0.5f, true),
                        .field = field(EventKind::roulette, "survives")};
  CHECK(sentence_of(divergence) ==
        "Segment 4: roulette ends it on a and continues the path on b: the number 0.5 lies within rounding of the "
        "threshold 0.5.");
  std::swap(divergence.a, divergence.b);
  CHECK(sentence_of(divergence).find("roulette continues the path on a and ends it on b") != std::string::npos);
}

TEST_CASE("devices that go on with different events say with which") {
  Divergence divergence{.difference_class = DifferenceClass::flipped_decision,
                        .segment = 1,
                        .a = event(EventKind::emission),
                        .b = end_event(pathtracer::EndReason::side)};
  CHECK(sentence_of(divergence) ==
        "Segment 1: a continues with an emission, b with the end of the path: moving the segment's state by rounding "
        "flips this decision on one device.");
  divergence.difference_class = DifferenceClass::mismatch;
  divergence.a = segment_event(2, {}, {});
  divergence.b = PathEvent{};
  CHECK(sentence_of(divergence) ==
        "Segment 1: a continues with the next segment, b with nothing: from the same state, and rounding does not "
        "explain it.");
}

TEST_CASE("two answers to a ray say who met what, and why either or one is right") {
  const pathtracer::Scene scene = two_triangles();
  const std::string start = "Segment 2: the ray from (1, 1, 0) meets triangle 0 on a and triangle 1 on b";
  const auto sentence = [&](const Divergence& divergence) { return sentence_of_answers(divergence, scene, {}); };

  Divergence wrong = two_answers(DifferenceClass::mismatch, 0, 1);
  CHECK(sentence(wrong) == start + "; the exact answer is nothing, and rounding does not explain the difference.");
  wrong.exact_answer = 1;
  CHECK(sentence(wrong) == start + "; the exact answer is triangle 1, and rounding does not explain the difference.");

  // Their common edge runs through (1, 1, 1).
  const std::string tie = sentence(two_answers(DifferenceClass::edge_or_vertex_tie, 0, 1));
  CHECK(tie.starts_with(start + "; "));
  CHECK(tie.find("edge") != std::string::npos);
  CHECK(tie.ends_with(": either is right."));

  CHECK(sentence(two_answers(DifferenceClass::coincident_geometry, 0, 1)) ==
        start + "; both lie in the same place: either is right.");
  CHECK(sentence(two_answers(DifferenceClass::flipped_decision, 0, 1)) ==
        start + "; the nearer one is transparent, and whether the ray passes it lies within rounding.");
  CHECK(sentence(two_answers(DifferenceClass::grazing_visibility, 1, 0, RayKind::occlusion)) ==
        "Segment 2: the shadow ray from (1, 1, 0) finds something on a and nothing on b in its way; it grazes an "
        "occluder: either is right.");
}

}  // namespace
}  // namespace tandem::compare
