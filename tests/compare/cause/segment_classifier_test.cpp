#include <doctest/doctest.h>

#include <cmath>
#include <string>
#include <vector>

#include "compare/cause/segment_classifier.hpp"
#include "compare/cause/tie.hpp"
#include "tests/compare/path_recordings.hpp"

namespace tandem::compare {
namespace {

using pathtracer::EndReason;
using pathtracer::EventKind;
using pathtracer::no_primitive;
using pathtracer::PathEvent;
using pathtracer::PathEvents;
using pathtracer::RayKind;
using pathtracer::Scene;
namespace word = pathtracer::event_word;

/// The unit square in the plane z = 1, cut along its diagonal x = y into the triangles 0 and 1, and triangle 2, which
/// covers much of it.
Scene square(float height_of_2 = 1) {
  Scene scene;
  scene.materials = {pathtracer::diffuse_material(glm::vec3(0.5f))};
  scene.positions = {{0, 0, 1},           {1, 0, 1},           {1, 1, 1},          {0, 1, 1},
                     {0, 0, height_of_2}, {1, 0, height_of_2}, {0, 1, height_of_2}};
  scene.triangles = {{.vertices = {0, 1, 2}, .material = 0},
                     {.vertices = {0, 2, 3}, .material = 0},
                     {.vertices = {4, 5, 6}, .material = 0}};
  return scene;
}

const PathEvent state = segment_event(1, {0.25f, 0.75f, 0}, {0, 0, 1});

PathEvent upwards(float x, float y, std::uint32_t answer, RayKind kind = RayKind::closest) {
  return ray_event({x, y, 0}, {0, 0, 1}, answer, 1, kind);
}

ClassifiedSegment segment(const PathEvents& a, PathEvents b) {
  return {.path = {}, .first_event = 7, .a = a, .b = std::move(b)};
}

/// What an arbiter would say of the two answers.
ClassifiedSegment resolved_by_arbiter(const Scene& scene, const PathEvents& a, const PathEvents& b, Ruling ruling) {
  ClassifiedSegment classified = segment(a, b);
  REQUIRE(classify_segment(classified, scene, nullptr) == Pending::arbiter);
  REQUIRE(disputes_of(classified).size() == 1);
  resolve(classified, scene, std::vector<Arbitration>{{.ruling = ruling, .exact_answer = 1}});
  REQUIRE(classified.divergences.size() == 1);
  return classified;
}

bool says(const Divergence& divergence, const char* words) {
  return divergence.sentence.find(words) != std::string::npos;
}

TEST_CASE("a ray along a shared edge is a tie when the arbiter calls it one") {
  const PathEvents a = {state, upwards(0.5f, 0.5f, 0)}, b = {state, upwards(0.5f, 0.5f, 1)};
  const Divergence tie = resolved_by_arbiter(square(), a, b, Ruling::tie).divergences[0];
  CHECK(tie.difference_class == DifferenceClass::edge_or_vertex_tie);
  CHECK(tie.segment == 1);
  CHECK(tie.event_index == 8);
  CHECK(std::string(tie.field->name) == "answer");
  CHECK(tie.exact_answer == 1u);
  CHECK(says(tie, "triangle 0 on a and triangle 1 on b"));
  CHECK(says(tie, "share an edge"));
  const Divergence wrong = resolved_by_arbiter(square(), a, b, Ruling::b_right).divergences[0];
  CHECK(wrong.difference_class == DifferenceClass::mismatch);
  CHECK(says(wrong, "the exact answer is triangle 1"));
}

TEST_CASE("a ray that passes the border of what it meets on one device is a tie at an edge") {
  const PathEvents a = {state, upwards(1e-7f, 0.5f, 1)}, b = {state, upwards(1e-7f, 0.5f, no_primitive)};
  const Divergence tie = resolved_by_arbiter(square(5), a, b, Ruling::tie).divergences[0];
  CHECK(tie.difference_class == DifferenceClass::edge_or_vertex_tie);
  CHECK(says(tie, "from an edge of triangle 1"));
}

TEST_CASE("two triangles in one place are coincident geometry, two at a distance are not") {
  const PathEvents a = {state, upwards(0.5f, 0.25f, 0)}, b = {state, upwards(0.5f, 0.25f, 2)};
  CHECK(resolved_by_arbiter(square(), a, b, Ruling::tie).divergences[0].difference_class ==
        DifferenceClass::coincident_geometry);
  Scene scene = square(2);
  CHECK(class_of_tie(scene, pathtracer::ray_of({}, a[1]), 0, 2) != DifferenceClass::coincident_geometry);
  // The nearer one lets some rays through, and whether this one was among them is a decision.
  scene.materials[0].opacity = 0.5f;
  CHECK(class_of_tie(scene, pathtracer::ray_of({}, a[1]), 0, 2) == DifferenceClass::flipped_decision);
}

TEST_CASE("a shadow ray with two answers grazes what is there") {
  const PathEvents a = {state, upwards(0, 0.5f, 1, RayKind::occlusion)},
                   b = {state, upwards(0, 0.5f, 0, RayKind::occlusion)};
  const Divergence tie = resolved_by_arbiter(square(), a, b, Ruling::tie).divergences[0];
  CHECK(tie.difference_class == DifferenceClass::grazing_visibility);
  CHECK(says(tie, "shadow ray"));
}

TEST_CASE("rays that rounding has moved are classified each by itself") {
  const PathEvents a = {state, upwards(0.5f, 0.5f, 0)}, b = {state, upwards(std::nextafter(0.5f, 0.0f), 0.5f, 1)};
  ClassifiedSegment classified = segment(a, b);
  REQUIRE(classify_segment(classified, square(), nullptr) == Pending::arbiter);
  const std::vector<Dispute> disputes = disputes_of(classified);
  REQUIRE(disputes.size() == 2);
  CHECK(disputes[0].answer_a == 0);
  CHECK(disputes[0].answer_b == 0);
  CHECK(disputes[1].answer_a == 1);
  CHECK(disputes[1].ray.origin.x < 0.5f);
  resolve(classified, square(), std::vector<Arbitration>(2, {.ruling = Ruling::tie, .exact_answer = 0}));
  REQUIRE(classified.divergences.size() == 2);
  CHECK(classified.divergences[0].difference_class == DifferenceClass::rounding);
  CHECK(classified.divergences[1].difference_class == DifferenceClass::edge_or_vertex_tie);
}

TEST_CASE("values within their tolerance are rounding, and classification goes on") {
  const PathEvents a = {state, upwards(0.5f, 0.25f, 0), end_event(EndReason::depth, {1, 1, 1})};
  PathEvents b = a;
  b[2].set(word::end_radiance, glm::vec3(1, 1, 1.0000001f));
  ClassifiedSegment classified = segment(a, b);
  CHECK(classify_segment(classified, square(), nullptr) == Pending::nothing);
  REQUIRE(classified.divergences.size() == 1);
  CHECK(classified.divergences[0].difference_class == DifferenceClass::rounding);
  CHECK(classified.divergences[0].ulp_distance == 1);
  CHECK(says(classified.divergences[0], "the radiance of the end differs by 1 units"));
}

TEST_CASE("a value beyond its tolerance asks for variations, and is a mismatch when they do not explain it") {
  const PathEvents a = {state, upwards(0.5f, 0.25f, 0), end_event(EndReason::depth, {1, 1, 1})};
  PathEvents b = a;
  b[2].set(word::end_radiance, glm::vec3(1, 1, 1.1f));
  ClassifiedSegment classified = segment(a, b);
  REQUIRE(classify_segment(classified, square(), nullptr) == Pending::variations);
  const Variations none{.a = {a}, .b = {b}};
  CHECK(classify_segment(classified, square(), &none) == Pending::nothing);
  REQUIRE(classified.divergences.size() == 1);
  CHECK(classified.divergences[0].difference_class == DifferenceClass::mismatch);
  CHECK(std::string(classified.divergences[0].field->name) == "radiance");
  CHECK(says(classified.divergences[0], "(1, 1, 1) on a and (1, 1, 1.10000002) on b"));
}

TEST_CASE("random bits that differ have no excuse, and neither has a state that is not kept") {
  PathEvents a = {state, event(EventKind::scatter, 1)};
  PathEvents b = a;
  b[1].words[4] = 1;
  ClassifiedSegment classified = segment(a, b);
  CHECK(classify_segment(classified, square(), nullptr) == Pending::nothing);
  REQUIRE(classified.divergences.size() == 1);
  CHECK(classified.divergences[0].difference_class == DifferenceClass::mismatch);
  CHECK(std::string(classified.divergences[0].field->name) == "random bits");

  b = a;
  b[0].words[word::segment_depth] = 5;
  classified = segment(a, b);
  CHECK(classify_segment(classified, square(), nullptr) == Pending::nothing);
  CHECK(classified.divergences.at(0).difference_class == DifferenceClass::mismatch);
  classified = segment(a, {});
  CHECK(classify_segment(classified, square(), nullptr) == Pending::nothing);
  CHECK(classified.divergences.at(0).difference_class == DifferenceClass::mismatch);
}

TEST_CASE("roulette whose number lies between two roundings of its threshold is a flipped decision") {
  const float threshold = 0.75f, below = std::nextafter(threshold, 0.0f);
  // Random numbers have 24 bits, as fine as floats are there.
  const PathEvents a = {state, roulette_event(below, threshold, true)},
                   b = {state, roulette_event(below, below, false)};
  ClassifiedSegment classified = segment(a, b);
  CHECK(classify_segment(classified, square(), nullptr) == Pending::nothing);
  REQUIRE(classified.divergences.size() == 2);
  CHECK(classified.divergences[0].difference_class == DifferenceClass::rounding);
  CHECK(classified.divergences[1].difference_class == DifferenceClass::flipped_decision);
  CHECK(says(classified.divergences[1], "roulette continues the path on a and ends it on b") == true);
  // One that does not do what its own numbers say is wrong, unless rounding explains even that.
  const PathEvents wrong = {state, roulette_event(below, threshold, false)};
  classified = segment(a, wrong);
  CHECK(classify_segment(classified, square(), nullptr) == Pending::variations);
  const Variations same{.a = {a}, .b = {wrong}};
  CHECK(classify_segment(classified, square(), &same) == Pending::nothing);
  CHECK(classified.divergences.at(0).difference_class == DifferenceClass::mismatch);
}

TEST_CASE("a wrong t is a mismatch that nothing depends on; one of a grazing ray may be further off") {
  const PathEvents a = {state, upwards(0.5f, 0.25f, 0), end_event(EndReason::depth)};
  PathEvents b = a;
  b[1].set(word::hit_t, 1.0005f);
  ClassifiedSegment classified = segment(a, b);
  CHECK(classify_segment(classified, square(), nullptr) == Pending::nothing);
  CHECK(classified.divergences.empty());  // within the tolerance of the contract
  b[1].set(word::hit_t, 1.5f);
  b[2].words[word::end_reason] = static_cast<std::uint32_t>(EndReason::side);
  classified = segment(a, b);
  CHECK(classify_segment(classified, square(), nullptr) == Pending::variations);  // it goes on after it
  REQUIRE(classified.divergences.size() == 1);
  CHECK(classified.divergences[0].difference_class == DifferenceClass::mismatch);
  CHECK(std::string(classified.divergences[0].field->name) == "t");

  // A ray that meets the plane at 1e-5 of a radian: 1e-6 aside is 0.1 along it.
  PathEvent grazing = ray_event({0.25f, 0.25f, 1 - 5e-6f}, {1, 0, 1e-5f}, 0, 0.5f);
  PathEvent farther = grazing;
  farther.set(word::hit_t, 0.6f);
  CHECK(is_report_within_rounding(square(5), grazing, farther, word::hit_t, 1e-3));
  farther.set(word::hit_t, 5.0f);
  CHECK_FALSE(is_report_within_rounding(square(5), grazing, farther, word::hit_t, 1e-3));
}

}  // namespace
}  // namespace tandem::compare
