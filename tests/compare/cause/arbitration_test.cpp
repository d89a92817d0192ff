#include <doctest/doctest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include <glm/geometric.hpp>

#include "compare/cause/arbitration.hpp"

namespace {

using namespace tandem;
using compare::Dispute;
using compare::Ruling;
using pathtracer::RayKind;
using pathtracer::TracedRay;

/// Right triangles with legs of length 2 in planes z = const, which rays along +z meet.
pathtracer::Scene plates(const std::vector<float>& heights) {
  pathtracer::Scene scene;
  for (const float z : heights) {
    const auto first = static_cast<std::uint32_t>(scene.positions.size());
    for (const glm::vec3& corner : {glm::vec3(0, 0, z), glm::vec3(2, 0, z), glm::vec3(0, 2, z)})
      scene.positions.push_back(corner);
    scene.triangles.push_back({.vertices = {first, first + 1, first + 2}, .material = 0});
  }
  return scene;
}

/// Every triangle and sphere, in double precision: what the exact device stands for here.
std::vector<std::uint32_t> trace_exactly(const pathtracer::Scene& scene, std::span<const TracedRay> rays) {
  std::vector<std::uint32_t> answers;
  for (const TracedRay& ray : rays) {
    double nearest = ray.t_max;
    std::uint32_t triangle = pathtracer::no_primitive;
    for (std::uint32_t i = 0; i < scene.triangles.size(); ++i) {
      const auto corner = [&](int k) { return glm::dvec3(scene.positions[scene.triangles[i].vertices[k]]); };
      const glm::dvec3 origin(ray.origin), direction(ray.direction);
      const glm::dvec3 normal = glm::cross(corner(1) - corner(0), corner(2) - corner(0));
      const double t = glm::dot(corner(0) - origin, normal) / glm::dot(direction, normal);
      const glm::dvec3 p = origin + t * direction;
      bool inside = t > 0 && t < nearest;
      for (int k = 0; k < 3; ++k)
        inside = inside && glm::dot(glm::cross(corner((k + 1) % 3) - corner(k), p - corner(k)), normal) >= 0;
      if (!inside) continue;
      nearest = t;
      triangle = i;
    }
    for (std::uint32_t i = 0; i < scene.spheres.size(); ++i) {
      const glm::dvec3 from_centre = glm::dvec3(ray.origin) - glm::dvec3(scene.spheres[i].centre);
      const glm::dvec3 direction(ray.direction);
      const double a = glm::dot(direction, direction), b = glm::dot(from_centre, direction);
      const double radius = scene.spheres[i].radius;
      const double discriminant = b * b - a * (glm::dot(from_centre, from_centre) - radius * radius);
      if (discriminant < 0) continue;
      for (const double t : {(-b - std::sqrt(discriminant)) / a, (-b + std::sqrt(discriminant)) / a})
        if (t > 0 && t < nearest) {
          nearest = t;
          triangle = static_cast<std::uint32_t>(scene.triangles.size()) + i;
        }
    }
    answers.push_back(ray.kind == RayKind::closest ? triangle : (triangle != pathtracer::no_primitive ? 1u : 0u));
  }
  return answers;
}

TracedRay upwards(float x, float y, RayKind kind = RayKind::closest) {
  return {.origin = {x, y, 0}, .t_max = kind == RayKind::closest ? 1e30f : 4.0f, .direction = {0, 0, 1}, .kind = kind};
}

/// Of a picture of a thousand lines that is taken from where the rays start.
constexpr compare::PixelFootprint footprint{.eye = {0, 0, 0}, .angle = 0.001, .width = 0};

compare::Arbitration arbitrated(const pathtracer::Scene& scene, const TracedRay& ray, std::uint32_t a,
                                std::uint32_t b) {
  const Dispute dispute{.ray = ray, .answer_a = a, .answer_b = b};
  return compare::arbitrate({&dispute, 1}, scene, footprint,
                            [&](std::span<const TracedRay> rays) { return trace_exactly(scene, rays); })[0];
}

constexpr std::uint32_t none = pathtracer::no_primitive;

TEST_CASE("well inside a triangle the device that sees it is right") {
  const pathtracer::Scene scene = plates({1, 3});
  const compare::Arbitration arbitration = arbitrated(scene, upwards(0.5f, 0.5f), 0, 1);
  CHECK(arbitration.ruling == Ruling::a_right);
  CHECK(arbitration.exact_answer == 0);
  CHECK(arbitrated(scene, upwards(0.5f, 0.5f), none, 0).ruling == Ruling::b_right);
  CHECK(arbitrated(scene, upwards(0.5f, 0.5f), none, 1).ruling == Ruling::both_wrong);
}

TEST_CASE("a sphere is right where the ray meets it, and a tie where it is all but touched") {
  pathtracer::Scene scene = plates({1, 3});
  scene.spheres = {{.centre = {0.5f, 0.5f, 2}, .radius = 0.25f}, {.centre = {1.5f, 1.5f, 3}, .radius = 0.25f}};
  // Above the first plate; the second sphere lies beside both.
  TracedRay ray = upwards(0.5f, 0.5f);
  ray.origin.z = 1.25f;
  CHECK(arbitrated(scene, ray, 2, 1).ruling == Ruling::a_right);
  CHECK(arbitrated(scene, ray, 1, 2).ruling == Ruling::b_right);
  CHECK(arbitrated(scene, ray, 3, none).ruling == Ruling::both_wrong);
  CHECK(arbitrated(scene, ray, 2, 1).exact_answer == 2);
  CHECK(arbitrated(scene, upwards(0.5f, 0.5f), 2, 0).ruling == Ruling::b_right);
  CHECK(arbitrated(scene, upwards(1.5f, 1.5f), 3, none).ruling == Ruling::a_right);
  // A rim that the ray all but touches, from inside and from outside.
  CHECK(arbitrated(scene, upwards(1.75f - 2e-7f, 1.5f), none, 3).ruling == Ruling::tie);
  CHECK(arbitrated(scene, upwards(1.75f + 2e-7f, 1.5f), none, 3).ruling == Ruling::tie);
  CHECK(arbitrated(scene, upwards(1.75f + 1e-3f, 1.5f), none, 3).ruling == Ruling::a_right);
  pathtracer::Scene only;
  only.spheres = {{.centre = {0, 0, 5}, .radius = 1}};
  CHECK(arbitrated(only, upwards(0, 0), 0, none).ruling == Ruling::a_right);
}

TEST_CASE("at the border of a triangle, what lies behind it is as right") {
  const pathtracer::Scene scene = plates({1, 3});
  // 2e-7 from the leg x = 0: two units in the last place of a coordinate of 2.
  CHECK(arbitrated(scene, upwards(2e-7f, 0.5f), 0, none).ruling == Ruling::tie);
  CHECK(arbitrated(scene, upwards(-2e-7f, 0.5f), 0, none).ruling == Ruling::tie);
  // A thousandth is no rounding.
  CHECK(arbitrated(scene, upwards(1e-3f, 0.5f), 0, none).ruling == Ruling::a_right);
  CHECK(arbitrated(scene, upwards(-1e-3f, 0.5f), 0, none).ruling == Ruling::b_right);
}

TEST_CASE("of two triangles in one place either is right, of two that lie apart only the nearer") {
  const float next = std::nextafter(1.0f, 2.0f);
  CHECK(arbitrated(plates({1, 1}), upwards(0.5f, 0.5f), 0, 1).ruling == Ruling::tie);
  CHECK(arbitrated(plates({1, next}), upwards(0.5f, 0.5f), 1, 0).ruling == Ruling::tie);
  CHECK(arbitrated(plates({1, 1.001f}), upwards(0.5f, 0.5f), 1, 0).ruling == Ruling::b_right);
}

TEST_CASE("a triangle seen edge-on may be taken for hit by a ray that touches it, and by no other") {
  pathtracer::Scene scene = plates({3});
  const auto first = static_cast<std::uint32_t>(scene.positions.size());
  for (const glm::vec3& corner : {glm::vec3(0.5f, 0.2f, 1), glm::vec3(0.5f, 0.2f, 2), glm::vec3(0.5f, 0.9f, 1.5f)})
    scene.positions.push_back(corner);  // in the plane x = 0.5, in front of the plate
  scene.triangles.push_back({.vertices = {first, first + 1, first + 2}, .material = 0});
  CHECK(arbitrated(scene, upwards(0.5f, 0.5f), 1, 0).ruling == Ruling::tie);
  CHECK(arbitrated(scene, upwards(0.5f + 1e-6f, 0.5f), 1, 0).ruling == Ruling::tie);
  CHECK(arbitrated(scene, upwards(0.501f, 0.5f), 1, 0).ruling == Ruling::b_right);
}

TEST_CASE("shadow rays are arbitrated by whether anything is in the way") {
  const pathtracer::Scene scene = plates({1});
  CHECK(arbitrated(scene, upwards(0.5f, 0.5f, RayKind::occlusion), 0, 1).ruling == Ruling::b_right);
  CHECK(arbitrated(scene, upwards(5, 5, RayKind::occlusion), 0, 1).ruling == Ruling::a_right);
  CHECK(arbitrated(scene, upwards(-2e-7f, 0.5f, RayKind::occlusion), 0, 1).ruling == Ruling::tie);
  // The plate lies at the very end of the ray.
  TracedRay ray = upwards(0.5f, 0.5f, RayKind::occlusion);
  ray.t_max = std::nextafter(1.0f, 2.0f);
  CHECK(arbitrated(scene, ray, 0, 1).ruling == Ruling::tie);
  ray.t_max = 1.001f;
  CHECK(arbitrated(scene, ray, 0, 1).ruling == Ruling::b_right);
}

/// A square with its centre in (0, 0, z), whose diagonal x = y divides it.
pathtracer::Scene wide_plate(float half, float z) {
  pathtracer::Scene scene;
  scene.positions = {{-half, -half, z}, {half, -half, z}, {half, half, z}, {-half, half, z}};
  scene.triangles = {{.vertices = {0, 1, 2}, .material = 0}, {.vertices = {2, 3, 0}, .material = 0}};
  return scene;
}

TEST_CASE("however large a triangle is, a ray far from its edge in the picture's terms meets it") {
  for (const float half : {1e3f, 1e6f, 1e9f}) {
    CAPTURE(half);
    const pathtracer::Scene scene = wide_plate(half, 8);
    // Beside the diagonal by less than 32 units in the last place of the corners from half = 1e6 on. A pixel is 0.008.
    CHECK(arbitrated(scene, upwards(1, 0.5f), 0, none).ruling == Ruling::a_right);
    CHECK(arbitrated(scene, upwards(0.5f, 1), none, 1).ruling == Ruling::b_right);
    // Which of the two it meets is another matter: from half = 1e6 on single precision cannot tell.
    CHECK(arbitrated(scene, upwards(1, 0.5f), 0, 1).ruling == (half < 1e6f ? Ruling::a_right : Ruling::tie));
    TracedRay shadow = upwards(1, 0.5f, RayKind::occlusion);
    shadow.t_max = 1e30f;
    CHECK(arbitrated(scene, shadow, 1, 0).ruling == Ruling::a_right);
    // At the diagonal either triangle is right, but not neither.
    const float aside = std::min(1e-4f, half * 1e-7f);
    CHECK(arbitrated(scene, upwards(1 + aside, 1), 0, 1).ruling == Ruling::tie);
    CHECK(arbitrated(scene, upwards(1 + aside, 1), 0, none).ruling == Ruling::a_right);
  }
}

TEST_CASE("a large triangle does not make what is near it uncertain") {
  pathtracer::Scene scene = wide_plate(1e9f, -8);
  scene.positions.insert(scene.positions.end(), {{0, 0, 5}, {2, 0, 5}, {0, 2, 5}});
  scene.triangles.push_back({.vertices = {4, 5, 6}, .material = 0});
  // Well inside the small triangle, and well beside it.
  CHECK(arbitrated(scene, upwards(0.5f, 0.5f), 2, none).ruling == Ruling::a_right);
  CHECK(arbitrated(scene, upwards(-1, 0.5f), none, 2).ruling == Ruling::a_right);
  for (const float t_max : {7.0f, 1e30f}) {
    CAPTURE(t_max);
    const auto shadow = [&](float x, float y) {
      TracedRay ray = upwards(x, y, RayKind::occlusion);
      ray.t_max = t_max;
      return ray;
    };
    CHECK(arbitrated(scene, shadow(0.5f, 0.5f), 1, 0).ruling == Ruling::a_right);
    CHECK(arbitrated(scene, shadow(-1, 0.5f), 0, 1).ruling == Ruling::a_right);
    CHECK(arbitrated(scene, shadow(-2e-7f, 0.5f), 0, 1).ruling == Ruling::tie);
    CHECK(arbitrated(scene, shadow(2e-7f, 0.5f), 1, 0).ruling == Ruling::tie);
  }
}

TEST_CASE("two large triangles that lie apart in the picture are not in one place") {
  pathtracer::Scene scene = wide_plate(1e9f, 8);
  const pathtracer::Scene behind = wide_plate(1e9f, 9);
  scene.positions.insert(scene.positions.end(), behind.positions.begin(), behind.positions.end());
  scene.triangles.push_back({.vertices = {4, 5, 6}, .material = 0});
  scene.triangles.push_back({.vertices = {6, 7, 4}, .material = 0});
  CHECK(arbitrated(scene, upwards(1, 0.5f), 0, 2).ruling == Ruling::a_right);
}

TEST_CASE("where a pixel is smaller than the last bits of the distance, these are allowed") {
  // A telescope: a thousand units away, a pixel of 1e-9 radians.
  pathtracer::Scene scene = plates({1000});
  constexpr compare::PixelFootprint telescope{.eye = {0, 0, 0}, .angle = 1e-9, .width = 0};
  const Dispute dispute{.ray = upwards(-1e-4f, 0.5f), .answer_a = none, .answer_b = 0};
  const auto trace = [&](std::span<const TracedRay> rays) { return trace_exactly(scene, rays); };
  CHECK(compare::arbitrate({&dispute, 1}, scene, telescope, trace)[0].ruling == Ruling::tie);
}

}  // namespace
