#include "compare/cause/unexplained_difference.hpp"

#include <doctest/doctest.h>

namespace tandem::compare {
namespace {

using pathtracer::Image;

/// Four pixels in a row, of which b differs at the first three.
struct Case {
  Image a{.width = 4, .height = 1, .pixels = {glm::vec3(1), glm::vec3(1), glm::vec3(1), glm::vec3(1)}};
  Image b{.width = 4, .height = 1, .pixels = {glm::vec3(3), glm::vec3(2), glm::vec3(5), glm::vec3(1)}};
  Classification classification;

  Case() { classification.differing_pixels = 3; }

  void add(std::uint32_t x, DifferenceClass difference_class) {
    ++classification.classed_pixels;
    ++classification.pixel_counts[static_cast<std::size_t>(difference_class)];
    classification.pixels.push_back({.pixel = {x, 0}, .difference_class = difference_class, .wrong_sum = 0});
    if (difference_class != DifferenceClass::mismatch) return;
    Divergence divergence;
    divergence.difference_class = difference_class;
    classification.paths.push_back({.path = {.pixel = {x, 0}, .sample = 0}, .divergences = {divergence}});
  }
  UnexplainedDifference left() const { return leave_out_explained(classification, a, b); }
};

TEST_CASE("pixels in an explained class are left out, mismatches stay") {
  Case each;
  each.add(0, DifferenceClass::coincident_geometry);
  each.add(1, DifferenceClass::mismatch);
  each.add(2, DifferenceClass::edge_or_vertex_tie);
  const UnexplainedDifference left = each.left();
  CHECK(left.metrics.bit_equal == 0.75);
  CHECK(left.metrics.mean_b == 1.25);
  CHECK(left.sentence ==
        "3 of 3 differing pixels were classed (1 mismatch, 1 coincident geometry, 1 edge or vertex tie).");
}

TEST_CASE("rounding is explained pixel by pixel, but still counts in the mean") {
  Case each;
  each.add(0, DifferenceClass::rounding);
  each.add(1, DifferenceClass::grazing_visibility);
  each.add(2, DifferenceClass::flipped_decision);
  CHECK(each.left().metrics.bit_equal == 1);
  CHECK(each.left().metrics.mean_b == 1.5);
}

TEST_CASE("pixels that were not classed are like those that were, unless one of these is a mismatch") {
  Case good;
  good.add(0, DifferenceClass::coincident_geometry);
  CHECK(good.left().metrics.bit_equal == 1);
  CHECK(good.left().metrics.mean_b == 1);
  Case bad;
  bad.add(0, DifferenceClass::mismatch);
  CHECK(bad.left().metrics.bit_equal == 0.25);
  Case unknown;
  CHECK(unknown.left().metrics.bit_equal == 0.25);
}

}  // namespace
}  // namespace tandem::compare
