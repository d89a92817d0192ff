#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "compare/geometry/bounding_volumes.hpp"
#include "compare/geometry/intersection.hpp"
#include "compare/probe/reference.hpp"
#include "tests/compare/probe/rays.hpp"

using namespace tandem;
using namespace tandem::compare;

namespace {

const Corners triangle = {glm::dvec3(0, 0, 0), glm::dvec3(2, 0, 0), glm::dvec3(0, 2, 0)};

/// Down onto (x, y), from z = 3, with a direction of length 2: t is 1.5 at z = 0.
GeometryRay down_at(double x, double y) { return {.origin = {x, y, 3}, .direction = {0, 0, -2}, .magnitude = 3}; }

}  // namespace

TEST_CASE("A ray through the inside of a triangle meets it for certain, where its plane is") {
  const auto met = meet(down_at(0.5, 0.25), triangle);
  REQUIRE(met);
  CHECK(met->certain);
  CHECK(met->front_face == true);
  CHECK(met->t_low < 1.5);
  CHECK(met->t_high > 1.5);
  // 32 ULP of 3, about 1.2e-5, in units of half a length, on either side and once more for the plane.
  CHECK(met->t_high - met->t_low < 3e-5);
  CHECK(met->barycentrics[0] == doctest::Approx(0.25));
  CHECK(met->barycentrics[1] == doctest::Approx(0.125));
  CHECK(met->barycentric_errors[0] < 3e-5);
  CHECK(meet({.origin = {0.5, 0.25, -3}, .direction = {0, 0, 2}, .magnitude = 3}, triangle)->front_face == false);
}

TEST_CASE("A ray at an edge or a vertex may meet a triangle or not, one farther off passes it by") {
  for (const GeometryRay& ray :
       {down_at(1, 0), down_at(0, 0), down_at(1, 1), down_at(1, -1e-6), down_at(2 + 1e-6, 0)}) {
    const auto met = meet(ray, triangle);
    REQUIRE(met);
    CHECK_FALSE(met->certain);
  }
  CHECK_FALSE(meet(down_at(1, -1e-4), triangle));
  CHECK_FALSE(meet(down_at(1.1, 1), triangle));
  CHECK_FALSE(meet(down_at(-1, -1), triangle));
}

TEST_CASE("The flatter a ray meets a triangle, the less is known of where, and edge-on nothing") {
  const GeometryRay slanting = {.origin = {-3, 0.5, 0.2}, .direction = {1, 0, -0.05}, .magnitude = 3};
  const auto met = meet(slanting, triangle);
  REQUIRE(met);
  CHECK(met->certain);
  CHECK((met->t_low + met->t_high) / 2 == doctest::Approx(4));
  CHECK(met->t_high - met->t_low > 1e-4);
  const auto edge_on = meet({.origin = {-3, 0.5, 0}, .direction = {1, 0, 0}, .magnitude = 3}, triangle);
  REQUIRE(edge_on);
  CHECK_FALSE(edge_on->certain);
  CHECK_FALSE(edge_on->front_face);
  CHECK(edge_on->t_high == std::numeric_limits<double>::infinity());
  const Corners needle = {glm::dvec3(0, 0, 0), glm::dvec3(2, 0, 0), glm::dvec3(1, 0, 0)};
  REQUIRE(meet(down_at(0.5, 0), needle));
  CHECK_FALSE(meet(down_at(0.5, 0), needle)->certain);
}

TEST_CASE("A ray enters and leaves a sphere, and may touch it") {
  pathtracer::GpuSphere sphere;
  sphere.centre = {0.5f, 0.25f, 0};
  sphere.radius = 1;
  const std::vector<Intersection> met = meet(down_at(0.5, 0.25), sphere);
  REQUIRE(met.size() == 2);
  for (const Intersection& intersection : met) CHECK(intersection.certain);
  CHECK((met[0].t_low + met[0].t_high) / 2 == doctest::Approx(1.0));
  CHECK((met[1].t_low + met[1].t_high) / 2 == doctest::Approx(2.0));
  const std::vector<Intersection> touched = meet(down_at(1.5, 0.25), sphere);
  REQUIRE(touched.size() == 2);
  CHECK_FALSE(touched[0].certain);
  CHECK(meet(down_at(1.5 + 1e-4, 0.25), sphere).empty());
}

TEST_CASE("The hierarchy of boxes finds every primitive that a ray meets") {
  const pathtracer::Scene scene = test::soup(500, 0, 3);
  std::vector<pathtracer::Bounds> boxes;
  std::vector<Corners> all;
  for (const pathtracer::GpuTriangle& each : scene.triangles) {
    Corners corners;
    for (std::size_t i = 0; i < 3; ++i) corners[i] = glm::dvec3(scene.positions[each.vertices[i]]);
    all.push_back(corners);
    const auto least = [&](int axis) { return std::min({corners[0][axis], corners[1][axis], corners[2][axis]}); };
    const auto greatest = [&](int axis) { return std::max({corners[0][axis], corners[1][axis], corners[2][axis]}); };
    boxes.push_back({glm::vec3(least(0), least(1), least(2)), glm::vec3(greatest(0), greatest(1), greatest(2))});
  }
  const BoundingVolumes volumes(boxes);
  std::size_t found = 0;
  for (const PathRay& each : test::rays_through(scene, 300, 5)) {
    const GeometryRay ray = {.origin = glm::dvec3(each.ray.origin),
                             .direction = glm::dvec3(each.ray.direction),
                             .magnitude = mapped_magnitude({}, glm::dvec3(each.ray.origin))};
    std::vector<bool> visited(all.size());
    volumes.traverse(ray, [&](std::uint32_t primitive) {
      CHECK_FALSE(visited[primitive]);
      visited[primitive] = true;
      return std::numeric_limits<double>::infinity();
    });
    for (std::size_t i = 0; i < all.size(); ++i) {
      const auto met = meet(ray, all[i]);
      if (!met || met->t_high < 0) continue;
      CHECK(visited[i]);
      ++found;
    }
  }
  CHECK(found > 300);
}
