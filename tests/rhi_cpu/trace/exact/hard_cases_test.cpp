// Cases in which floating point goes wrong, against rational arithmetic, to the last bit.

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "tests/rhi_cpu/trace/exact/ray_checks.hpp"

using namespace tandem;
using namespace tandem::test;
using kernel::Ray;

namespace {

/// A small integer: coordinates coincide often, so that rays meet edges and vertices exactly, lie in planes, and start
/// on surfaces.
float lattice(std::mt19937& random, int size) {
  return static_cast<float>(static_cast<int>(random() % static_cast<unsigned>(2 * size + 1)) - size);
}

/// A rounded number that is no multiple of anything.
float shaken(std::mt19937& random, float size) { return std::uniform_real_distribution<float>(-size, size)(random); }

template <class Coordinate>
std::vector<Triangle> triangles_of(int count, const Coordinate& coordinate) {
  std::vector<Triangle> triangles(static_cast<std::size_t>(count));
  for (Triangle& triangle : triangles) {
    for (float& value : triangle) value = coordinate();
  }
  return triangles;
}

template <class Coordinate>
std::vector<BoxExtent> boxes_of(int count, const Coordinate& coordinate) {
  std::vector<BoxExtent> boxes(static_cast<std::size_t>(count));
  for (BoxExtent& box : boxes) {
    for (std::size_t i = 0; i < 3; ++i) {
      const float a = coordinate(), b = coordinate();
      box[i] = std::min(a, b);
      box[i + 3] = std::max(a, b);
    }
  }
  return boxes;
}

template <class Coordinate, class Component>
Ray ray_of(const Coordinate& origin, const Component& direction) {
  Ray ray{.origin = {}, .t_min = 0, .direction = {}, .t_max = INFINITY, .flags = 0, .mask = 0xFF};
  for (float& value : ray.origin) value = origin();
  for (float& value : ray.direction) value = direction();
  return ray;
}

RationalScene scene_of(std::vector<Triangle> triangles, std::vector<BoxExtent> boxes) {
  RationalScene scene;
  scene.bottom_levels = {{{.primitives = std::move(triangles)}}, {{.primitives = std::move(boxes)}}};
  scene.instances = {instance_of(0), instance_of(1)};
  return scene;
}

/// Moves the scene by a matrix whose every element comes from `element`.
template <class Element>
void transform_all(RationalScene& scene, const Element& element) {
  for (rhi::InstanceDesc& instance : scene.instances) {
    for (auto& row : instance.object_to_world) {
      for (float& value : row) value = element();
    }
  }
}

/// Towards a random point of a random triangle, one that is often on its edges.
void aim(std::mt19937& random, Ray& ray, const std::vector<Triangle>& triangles) {
  const Triangle& triangle = triangles[random() % triangles.size()];
  const float weights[] = {0, 0.5f, 1, 0.25f, 0.7f};
  const float u = weights[random() % std::size(weights)];
  const float v = std::min(1 - u, weights[random() % std::size(weights)]);
  for (std::size_t i = 0; i < 3; ++i) {
    const float point = triangle[i] + u * (triangle[3 + i] - triangle[i]) + v * (triangle[6 + i] - triangle[i]);
    ray.direction[i] = point - ray.origin[i];
  }
}

}  // namespace

TEST_CASE("rays through edges, vertices and planes of a lattice") {
  std::mt19937 random(20);
  std::size_t hits = 0;
  for (int i = 0; i < 12; ++i) {
    const auto coordinate = [&] { return lattice(random, 2); };
    RationalScene scene = scene_of(triangles_of(30, coordinate), boxes_of(10, coordinate));
    if (i % 2 == 1) transform_all(scene, [&] { return lattice(random, 2); });
    const BuiltScene built = build(scene);
    for (int ray = 0; ray < 25; ++ray) {
      Ray each = ray_of(coordinate, coordinate);
      if (ray % 3 == 0) each.t_max = static_cast<float>(ray % 4 + 1);
      if (ray % 5 == 0) each.t_min = std::min(1.0f, each.t_max / 2);
      hits += check_ray(scene, built.top_level.view(), each);
    }
  }
  CHECK(hits > 500);
}

TEST_CASE("origins far away") {
  std::mt19937 random(21);
  for (const float distance : {1e3f, 1e6f, 1e9f, 1e15f, 1e30f}) {
    const auto coordinate = [&] { return shaken(random, 1); };
    const RationalScene scene = scene_of(triangles_of(20, coordinate), boxes_of(5, coordinate));
    const BuiltScene built = build(scene);
    const auto& triangles = std::get<std::vector<Triangle>>(scene.bottom_levels[0][0].primitives);
    std::size_t hits = 0;
    for (int i = 0; i < 40; ++i) {
      Ray ray = ray_of([&] { return shaken(random, distance); }, [&] { return shaken(random, distance); });
      aim(random, ray, triangles);
      hits += check_ray(scene, built.top_level.view(), ray);
    }
    // From beyond 1e8 the direction is rounded past the scene, whatever it aimed at.
    if (distance <= 1e6f) CHECK(hits > 40);
  }
}

TEST_CASE("tiny and huge scenes") {
  std::mt19937 random(22);
  for (const float scale : {std::numeric_limits<float>::denorm_min() * 50, 1e-37f, 1e-20f, 1e12f, 1e25f, 1e38f}) {
    const auto coordinate = [&] { return shaken(random, scale); };
    RationalScene scene = scene_of(triangles_of(20, coordinate), boxes_of(5, coordinate));
    const auto triangles = std::get<std::vector<Triangle>>(scene.bottom_levels[0][0].primitives);
    const BuiltScene built = build(scene);
    // Instances that take the scene back to about 1, or, where floats do not reach that far, towards it.
    RationalScene scaled = scene;
    const float back = std::clamp(1 / scale, 1e-37f, 1e37f);
    transform_all(scaled, [&] { return shaken(random, back); });
    const BuiltScene built_scaled = build(scaled);
    std::size_t hits = 0;
    for (int i = 0; i < 30; ++i) {
      Ray ray = ray_of(coordinate, coordinate);
      aim(random, ray, triangles);
      hits += check_ray(scene, built.top_level.view(), ray);
      const auto around_one = [&] { return shaken(random, 1); };
      hits += check_ray(scaled, built_scaled.top_level.view(), ray_of(around_one, around_one));
    }
    CHECK(hits > 15);
  }
}

TEST_CASE("slivers") {
  std::mt19937 random(23);
  std::vector<Triangle> triangles;
  for (int i = 0; i < 40; ++i) {
    Triangle triangle;
    for (float& value : triangle) value = shaken(random, 1);
    // The third vertex is as close to the line between the others as floats allow, without being on it.
    for (std::size_t axis = 0; axis < 3; ++axis) triangle[6 + axis] = (triangle[axis] + triangle[3 + axis]) / 2;
    triangle[6] = std::nextafter(triangle[6], 2.0f);
    triangles.push_back(triangle);
  }
  const RationalScene scene = scene_of(triangles, {});
  const BuiltScene built = build(scene);
  for (int i = 0; i < 400; ++i) {
    Ray ray = ray_of([&] { return shaken(random, 3); }, [&] { return shaken(random, 3); });
    aim(random, ray, triangles);
    check_ray(scene, built.top_level.view(), ray);
  }
  // Each of them is met where it can be told: the middle of a sliver, exactly.
  std::size_t met = 0;
  for (const Triangle& triangle : triangles) {
    Ray ray{.origin = {triangle[6], triangle[7], triangle[8]},
            .t_min = 0,
            .direction = {0.25f, 0.5f, 1},
            .t_max = 4,
            .flags = 0,
            .mask = 0xFF};
    for (std::size_t i = 0; i < 3; ++i) ray.origin[i] -= ray.direction[i];
    met += check_ray(scene, built.top_level.view(), ray);
  }
  CHECK(met > 0);
}

TEST_CASE("grazing rays and triangles that are almost in one plane") {
  std::mt19937 random(24);
  for (const float height : {1e-7f, 1e-20f, 1e-40f}) {
    std::vector<Triangle> triangles = triangles_of(30, [&] { return lattice(random, 3); });
    for (Triangle& triangle : triangles) {
      for (std::size_t corner = 0; corner < 3; ++corner) triangle[3 * corner + 2] = shaken(random, height);
    }
    const RationalScene scene = scene_of(triangles, {});
    const BuiltScene built = build(scene);
    std::size_t hits = 0;
    for (int i = 0; i < 60; ++i) {
      Ray ray = ray_of([&] { return shaken(random, 5); }, [&] { return lattice(random, 3); });
      ray.origin[2] = shaken(random, height);
      ray.direction[2] = shaken(random, height);
      hits += check_ray(scene, built.top_level.view(), ray);
    }
    CHECK(hits > 10);
  }
}

TEST_CASE("hits whose t differ by less than a float tells are ordered by instance, geometry and primitive") {
  std::mt19937 random(25);
  std::vector<Triangle> triangles;
  for (int i = 0; i < 12; ++i) {
    const float z = 1 + 1e-9f * shaken(random, 1);
    triangles.push_back({-1, -1, z + shaken(random, 1e-7f), 1, -1, z, 0, 1, z});
  }
  const RationalScene scene = scene_of(triangles, {});
  const BuiltScene built = build(scene);
  for (int i = 0; i < 40; ++i) {
    const Ray ray{.origin = {shaken(random, 0.2f), shaken(random, 0.2f), -1e3f},
                  .t_min = 0,
                  .direction = {0, 0, 1},
                  .t_max = INFINITY,
                  .flags = 0,
                  .mask = 0xFF};
    REQUIRE(check_ray(scene, built.top_level.view(), ray) == 12);
  }
}

TEST_CASE("sheared, squeezed and mirrored instances") {
  std::mt19937 random(26);
  for (int i = 0; i < 8; ++i) {
    const auto coordinate = [&] { return shaken(random, 1); };
    RationalScene scene = scene_of(triangles_of(20, coordinate), boxes_of(8, coordinate));
    for (rhi::InstanceDesc& instance : scene.instances) {
      auto& m = instance.object_to_world;
      m[0][1] = shaken(random, 1e4f);
      m[1][2] = shaken(random, 1e4f);
      m[2][2] = i % 2 == 0 ? 1e-4f : -1e3f;
      if (i % 4 > 1) m[1][1] = -m[1][1];
      m[0][3] = shaken(random, 100);
    }
    const BuiltScene built = build(scene);
    std::size_t hits = 0;
    for (int ray = 0; ray < 30; ++ray) {
      // From and to points of the instance, so that the ray goes where it has been sheared to.
      const rhi::InstanceDesc& instance = scene.instances[static_cast<std::size_t>(ray % 2)];
      Ray each = ray_of(coordinate, coordinate);
      const float a[3] = {each.origin[0] * 2, each.origin[1] * 2, each.origin[2] * 2};
      const float b[3] = {each.direction[0], each.direction[1], each.direction[2]};
      for (std::size_t row = 0; row < 3; ++row) {
        const auto& m = instance.object_to_world[row];
        each.origin[row] = m[0] * a[0] + m[1] * a[1] + m[2] * a[2] + m[3];
        each.direction[row] = m[0] * b[0] + m[1] * b[1] + m[2] * b[2] + m[3] - each.origin[row];
      }
      hits += check_ray(scene, built.top_level.view(), each);
    }
    CHECK(hits > 10);
  }
}

TEST_CASE("boxes from inside, from their surface, flat ones, points, and rays that end inside") {
  RationalScene scene =
      scene_of({}, {{-1, -1, -1, 1, 1, 1}, {-2, 0, -2, 2, 0, 2}, {0, 0, 0, 0, 0, 0}, {0, -3, 0, 0, 3, 0}});
  const BuiltScene built = build(scene);
  for (const float x : {-3.0f, -1.0f, 0.0f, 0.5f, 1.0f}) {
    for (const float y : {-2.0f, -1.0f, 0.0f, 0.25f}) {
      for (const float t_max : {0.25f, 1.0f, 2.0f, INFINITY}) {
        for (const auto& direction : {std::array{1.0f, 0.0f, 0.0f}, std::array{0.0f, 1.0f, 0.0f},
                                      std::array{1.0f, 1.0f, 0.0f}, std::array{-0.5f, 2.0f, 1e-30f}}) {
          const Ray ray{.origin = {x, y, 0},
                        .t_min = 0,
                        .direction = {direction[0], direction[1], direction[2]},
                        .t_max = t_max,
                        .flags = 0,
                        .mask = 0xFF};
          check_ray(scene, built.top_level.view(), ray);
        }
      }
    }
  }
  kernel::Hit hit;
  const Ray inside{
      .origin = {0.5f, 0.5f, 0.5f}, .t_min = 0.125f, .direction = {1, 0, 0}, .t_max = 0.25f, .flags = 0, .mask = 0xFF};
  REQUIRE(built.top_level.view().functions->next_hits(built.top_level.view(), inside, nullptr, &hit, 1) == 1);
  CHECK(hit.t == 0.125f);
}
