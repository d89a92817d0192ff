#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include <glm/geometric.hpp>

#include "compare/cause/perturbation.hpp"
#include "tests/compare/path_recordings.hpp"

namespace tandem::compare {
namespace {

using pathtracer::EventKind;
using pathtracer::PathEvent;
using pathtracer::PathEvents;
namespace word = pathtracer::event_word;

const PathEvent state = segment_event(2, {100, 1, -3}, glm::normalize(glm::vec3(1, 2, 3)));

PathEvent scatter(float weight, std::uint32_t lobe = 1) {
  PathEvent result = event(EventKind::scatter, 2);
  result.words[2] = lobe;
  result.set(12, glm::vec3(weight));
  return result;
}

/// The segment of one scattering.
PathEvents segment(float weight, std::uint32_t lobe = 1) { return {state, scatter(weight, lobe)}; }

EventPlace place_of(const char* name) {
  const std::span<const EventField> fields = fields_of(EventKind::scatter);
  for (std::size_t i = 0; i < fields.size(); ++i)
    if (std::string_view(fields[i].name) == name) return {1, i};
  FAIL("no such field");
  return {};
}

TEST_CASE("perturbed states are near the state, on all sides, and always the same") {
  const std::vector<PathEvent> states = perturbed_states(state);
  REQUIRE(states.size() == variation_count);
  CHECK(states == perturbed_states(state));
  constexpr double most = 33 * double{std::numeric_limits<float>::epsilon()};  // 32 and the rounding of the result
  int above = 0, below = 0, moved = 0;
  for (const PathEvent& each : states) {
    CHECK(glm::distance(glm::dvec3(each.vector(word::segment_origin)), glm::dvec3(100, 1, -3)) <
          2 * most * 100);  // the diagonal of a cube
    CHECK(glm::length(each.vector(word::segment_direction)) == doctest::Approx(1).epsilon(1e-6));
    const glm::vec3 throughput = each.vector(word::segment_throughput);
    CHECK(std::abs(throughput.x / 0.5 - 1) < most);
    CHECK(throughput.z == 0);  // black stays black
    above += throughput.x > 0.5f ? 1 : 0;
    below += throughput.x < 0.5f ? 1 : 0;
    moved += each != state ? 1 : 0;
    CHECK(each.words[word::segment_depth] == state.words[word::segment_depth]);
    CHECK(each.words[15] == state.words[15]);
  }
  CHECK(moved == int{variation_count});
  // Half of them each, but for those that are too small to be seen.
  CHECK(above >= 24);
  CHECK(below >= 24);
}

TEST_CASE("a decision is explained by a variation that makes it, after the same course") {
  const PathEvents a = segment(1, 1), b = segment(1, 2);
  const EventPlace lobe = place_of("lobe");
  CHECK_FALSE(explains_decision({.a = {a, a}, .b = {b, b}}, a, b, lobe));
  CHECK(explains_decision({.a = {a, b}, .b = {b, b}}, a, b, lobe));
  CHECK(explains_decision({.a = {a, a}, .b = {b, a}}, a, b, lobe));
  CHECK_FALSE(explains_decision({.a = {segment(1, 8)}, .b = {}}, a, b, lobe));
  // Random bits before it are not the same.
  PathEvents elsewhere = b;
  elsewhere[1].words[4] = 77;
  CHECK_FALSE(explains_decision({.a = {elsewhere}, .b = {}}, a, b, lobe));
}

TEST_CASE("another kind of event is a decision, too") {
  const PathEvents a = segment(1), b = {state, end_event(pathtracer::EndReason::absorbed)};
  CHECK_FALSE(explains_decision({.a = {a}, .b = {b}}, a, b, {1, 0}));
  CHECK(explains_decision({.a = {a, b}, .b = {b}}, a, b, {1, 0}));
}

TEST_CASE("a value is explained when variations spread a quarter as far") {
  const PathEvents a = segment(1), b = segment(1.4f);
  const EventPlace weight = place_of("weight");
  CHECK(explains_value({.a = {segment(1.11f)}, .b = {b}}, a, b, weight));
  CHECK(explains_value({.a = {segment(0.89f)}, .b = {b}}, a, b, weight));
  CHECK_FALSE(explains_value({.a = {segment(1.09f)}, .b = {b}}, a, b, weight));
  CHECK(explains_value({.a = {a}, .b = {segment(1.5f)}}, a, b, weight));
  // One that took another course says nothing.
  CHECK_FALSE(explains_value({.a = {segment(1.11f, 2)}, .b = {b}}, a, b, weight));
}

TEST_CASE("a NaN is explained by nothing but itself") {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const PathEvents a = segment(1), b = segment(nan);
  const EventPlace weight = place_of("weight");
  CHECK_FALSE(explains_value({.a = {segment(2)}, .b = {b}}, a, b, weight));
  CHECK(explains_value({.a = {segment(nan)}, .b = {b}}, a, b, weight));
  CHECK_FALSE(explains_value({.a = {segment(nan)}, .b = {}}, a, segment(1.5f), weight));
}

}  // namespace
}  // namespace tandem::compare
