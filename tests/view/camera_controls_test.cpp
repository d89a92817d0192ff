#include "tools/view/camera_controls.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

namespace tandem::view {
namespace {

using pathtracer::Camera;

constexpr double quarter = std::numbers::pi / 2;
// Positions of about 10 are stored as floats, half of whose last place is 5e-7; a few operations add up.
constexpr double tolerance = 5e-6;

const Camera from_front{.position = {1, 2, 13}, .target = {1, 2, 3}};

double distance_of(const glm::vec3& point, const glm::dvec3& expected) {
  return glm::distance(glm::dvec3(point), expected);
}
double view_length(const Camera& camera) {
  return glm::distance(glm::dvec3(camera.position), glm::dvec3(camera.target));
}
/// Of the target as the picture shows it, from its centre, in heights of the picture.
glm::dvec2 seen_at(const Camera& camera, const glm::dvec3& point) {
  const ViewAxes axes = view_axes(camera);
  const glm::dvec3 way = point - glm::dvec3(camera.position);
  const double height =
      2 * std::tan(double{camera.vertical_fov} * std::numbers::pi / 360) * glm::dot(way, axes.forward);
  return {glm::dot(way, axes.right) / height, -glm::dot(way, axes.up) / height};
}

TEST_CASE("a quarter of an orbit to the right is at the right of the target") {
  const Camera moved = orbit(from_front, {quarter, 0});
  CHECK(distance_of(moved.position, {11, 2, 3}) < tolerance);
  CHECK(moved.target == from_front.target);
}

TEST_CASE("an orbit upwards looks down, keeps the distance and stops before the pole") {
  const Camera moved = orbit(from_front, {0, quarter / 2});
  const double side = 10 * std::sqrt(0.5);
  CHECK(distance_of(moved.position, {1, 2 + side, 3 + side}) < tolerance);
  for (const double angle : {-9.0, 9.0}) {
    const Camera polar = orbit(from_front, {0.3, angle});
    CHECK(std::abs(view_length(polar) - 10) < tolerance);
    const double from_up = std::acos(view_axes(polar).forward.y);
    CHECK(std::abs((angle > 0 ? std::numbers::pi - from_up : from_up) - std::numbers::pi / 180) < 1e-5);
  }
}

TEST_CASE("orbits in small steps and in one arrive at one place") {
  Camera moved = from_front;
  for (int i = 0; i < 100; ++i) moved = orbit(moved, {quarter / 100, 0});
  // Each step rounds the position.
  CHECK(distance_of(moved.position, {11, 2, 3}) < 100 * tolerance);
}

TEST_CASE("looking around turns the target about the camera") {
  const Camera right = look(from_front, {quarter, 0});
  CHECK(right.position == from_front.position);
  CHECK(distance_of(right.target, {11, 2, 13}) < tolerance);
  const Camera up = look(from_front, {0, quarter / 2});
  CHECK(distance_of(up.target, {1, 2 + 10 * std::sqrt(0.5), 13 - 10 * std::sqrt(0.5)}) < tolerance);
}

TEST_CASE("dolly scales the distance, and what an orthographic camera sees") {
  CHECK(distance_of(dolly(from_front, 0.5).position, {1, 2, 8}) < tolerance);
  CHECK(dolly(from_front, 0.5).target == from_front.target);
  Camera parallel = from_front;
  parallel.kind = pathtracer::CameraKind::orthographic;
  parallel.height = 4;
  CHECK(dolly(parallel, 0.25).height == 1);
  CHECK(dolly(from_front, 1e-30) == from_front);  // would stand in its target
}

TEST_CASE("what is at the target follows the hand that pans") {
  for (const double angle : {0.0, 0.4}) {
    const Camera camera = orbit(from_front, {0.7, angle});
    const glm::dvec2 drag(0.25, -0.1);
    const glm::dvec2 seen = seen_at(pan(camera, drag), glm::dvec3(camera.target));
    CHECK(glm::distance(seen, drag) < 1e-5);
    CHECK(std::abs(view_length(pan(camera, drag)) - view_length(camera)) < tolerance);
  }
}

TEST_CASE("walking moves along the view's axes") {
  const Camera moved = walk(from_front, {1, 2, 3});
  CHECK(distance_of(moved.position, {2, 4, 10}) < tolerance);
  CHECK(distance_of(moved.target, {2, 4, 0}) < tolerance);
}

}  // namespace
}  // namespace tandem::view
