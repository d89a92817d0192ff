#include "conformance/kit/reference.hpp"

#include <doctest/doctest.h>

namespace tandem::conformance {
namespace {

const std::array<glm::dvec3, 3> corners = {glm::dvec3(0, 0, 0), glm::dvec3(1, 0, 0), glm::dvec3(0, 1, 0)};

TEST_CASE("the reference meets a triangle where geometry says") {
  const std::optional<TriangleHit> hit = intersect(corners, {0.25, 0.5, 3}, {0, 0, -2});
  REQUIRE(hit.has_value());
  CHECK(hit->t == 1.5);
  CHECK(hit->u == 0.25);
  CHECK(hit->v == 0.5);
  CHECK(hit->front_face);
  const std::optional<TriangleHit> behind = intersect(corners, {0.25, 0.5, -3}, {0, 0, 1});
  REQUIRE(behind.has_value());
  CHECK(behind->t == 3);
  CHECK_FALSE(behind->front_face);
  CHECK_FALSE(intersect(corners, {0.75, 0.5, 3}, {0, 0, -1}).has_value());
  CHECK_FALSE(intersect(corners, {-0.25, 0.5, 3}, {0, 0, -1}).has_value());
  CHECK_FALSE(intersect(corners, {0.25, 0.5, 3}, {1, 0, 0}).has_value());
}

TEST_CASE("an affine map times its inverse is the identity") {
  const Transform transform = {2, 0.5f, 0, 1, 0, -1, 0.25f, 2, 0, 0, 4, 3};
  CHECK(transform_of(matrix_of(transform)) == transform);
  const glm::dmat4x3 matrix = matrix_of(transform);
  const glm::dvec3 there = transform_point(matrix, {1, 2, 3});
  CHECK(there == glm::dvec3(2 + 1 + 1, -2 + 0.75 + 2, 12 + 3));
  const glm::dvec3 back = transform_point(inverse(matrix), there);
  for (int i = 0; i < 3; ++i) CHECK(back[i] == doctest::Approx(i + 1.0).epsilon(1e-14));
}

}  // namespace
}  // namespace tandem::conformance
