#include <doctest/doctest.h>

#include <cmath>
#include <string>

#include "compare/path/recording_difference.hpp"
#include "tests/compare/path_recordings.hpp"

namespace tandem::compare {
namespace {

using pathtracer::EndReason;
using pathtracer::PathEvents;
namespace word = pathtracer::event_word;

const PathEvents path = {segment_event(0, {0, 0, 0}, {0, 0, 1}), ray_event({0, 0, 0}, {0, 0, 1}, 3),
                         segment_event(1, {0, 0, 1}, {0, 1, 0}), end_event(EndReason::escaped, {1, 2, 3})};

TEST_CASE("equal recordings do not diverge") {
  CHECK_FALSE(next_difference(path, path).has_value());
  CHECK_FALSE(first_significant_difference(path, path).has_value());
  CHECK(segment_begins(path) == std::vector<std::size_t>{0, 2});
}

TEST_CASE("the first field that differs is named, in the order in which it was computed") {
  PathEvents other = path;
  other[1].words[word::ray_answer] = 4;
  other[1].set(word::ray_direction, glm::vec3(0, 1e-9f, 1));
  const auto place = first_significant_difference(path, other);
  REQUIRE(place.has_value());
  CHECK(place->event == 1);
  CHECK(std::string(field_at(path, other, *place)->name) == "direction");
  const auto next = next_difference(path, other, {place->event, place->field + 1});
  REQUIRE(next.has_value());
  CHECK(std::string(field_at(path, other, *next)->name) == "answer");
}

TEST_CASE("what is only observed differs, but is no divergence") {
  PathEvents other = path;
  other[1].set(word::hit_t, 1.5f);
  REQUIRE(next_difference(path, other).has_value());
  CHECK(std::string(field_at(path, other, *next_difference(path, other))->name) == "t");
  CHECK_FALSE(first_significant_difference(path, other).has_value());
}

TEST_CASE("another kind of event, and the end of one recording, have no field") {
  PathEvents other = path;
  other[2] = end_event(EndReason::absorbed);
  auto place = first_significant_difference(path, other);
  REQUIRE(place.has_value());
  CHECK(place->event == 2);
  CHECK(field_at(path, other, *place) == nullptr);
  place = first_significant_difference(path, std::span(path).first(3));
  REQUIRE(place.has_value());
  CHECK(place->event == 3);
  CHECK(field_at(path, std::span(path).first(3), *place) == nullptr);
}

TEST_CASE("summaries are equal by their bits, what is reserved aside") {
  pathtracer::PathSummary a{.radiance = {NAN, 0, 1}, .ray_count = 3, .event_count = 9, .digest = 7}, b = a;
  b.reserved = {1, 2};
  CHECK(a == b);
  b.radiance.y = -0.0f;
  CHECK(a != b);
  b = a;
  b.digest = 8;
  CHECK(a != b);
}

}  // namespace
}  // namespace tandem::compare
