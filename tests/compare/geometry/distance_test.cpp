#include <doctest/doctest.h>

#include "compare/geometry/distance.hpp"

namespace tandem::compare {
namespace {

const Corners triangle = {glm::dvec3(0, 0, 0), glm::dvec3(2, 0, 0), glm::dvec3(0, 2, 0)};

GeometryRay ray(const glm::dvec3& origin, const glm::dvec3& direction) {
  return {.origin = origin, .direction = direction, .magnitude = 1};
}

TEST_CASE("the closest point of a triangle is inside it, on an edge or a corner") {
  CHECK(closest_point(triangle, {0.5, 0.5, 3}) == glm::dvec3(0.5, 0.5, 0));
  CHECK(closest_point(triangle, {1, -4, 1}) == glm::dvec3(1, 0, 0));
  CHECK(closest_point(triangle, {2, 2, 0}) == glm::dvec3(1, 1, 0));
  CHECK(closest_point(triangle, {5, -1, 2}) == glm::dvec3(2, 0, 0));
}

TEST_CASE("of a triangle without an area the edges count") {
  const Corners flat = {glm::dvec3(0, 0, 0), glm::dvec3(1, 0, 0), glm::dvec3(3, 0, 0)};
  CHECK(closest_point(flat, {2, 1, 0}) == glm::dvec3(2, 0, 0));
}

TEST_CASE("the closest points of a ray and a segment respect the ends of both") {
  const GeometryRay up = ray({0, 0, 0}, {0, 0, 2});
  const auto [crossing, crossed] = closest_points(up, 10, {-1, 1, 4}, {1, 1, 4});
  CHECK(crossing == glm::dvec3(0, 0, 4));
  CHECK(crossed == glm::dvec3(0, 1, 4));
  const auto [last, beyond] = closest_points(up, 1, {-1, 1, 4}, {1, 1, 4});  // t_max is in lengths of the direction
  CHECK(last == glm::dvec3(0, 0, 2));
  CHECK(beyond == glm::dvec3(0, 1, 4));
  const auto [first, behind] = closest_points(up, 10, {-1, 1, -4}, {1, 1, -4});
  CHECK(first == glm::dvec3(0, 0, 0));
  CHECK(behind == glm::dvec3(0, 1, -4));
  const auto [beside, corner] = closest_points(up, 10, {2, 0, 4}, {3, 0, 4});
  CHECK(beside == glm::dvec3(0, 0, 4));
  CHECK(corner == glm::dvec3(2, 0, 4));
}

TEST_CASE("the line of a ray goes on behind its origin") {
  const GeometryRay up = ray({0, 0, 0}, {0, 0, 2});
  CHECK(distance_from_line(up, {-1, 1, -4}, {1, 1, -4}) == 1);
  CHECK(distance_from_line(up, {2, 0, 4}, {3, 0, 9}) == 2);
  CHECK(distance_from_line(up, {3, 4, 1}, {3, 4, 1}) == 5);  // a point
}

}  // namespace
}  // namespace tandem::compare
