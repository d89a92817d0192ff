// Random scenes against rational arithmetic, to the last bit.

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <thread>

#include "tests/rhi_cpu/trace/exact/ray_checks.hpp"

using namespace tandem;
using namespace tandem::test;
using kernel::Ray;

namespace {

float uniform(std::mt19937& random, float low, float high) {
  return std::uniform_real_distribution<float>(low, high)(random);
}

Triangle random_triangle(std::mt19937& random) {
  Triangle triangle;
  float centre[3];
  for (float& coordinate : centre) coordinate = uniform(random, -0.7f, 0.7f);
  for (std::size_t i = 0; i < 9; ++i) triangle[i] = centre[i % 3] + uniform(random, -0.4f, 0.4f);
  return triangle;
}

BoxExtent random_box(std::mt19937& random) {
  BoxExtent box;
  for (std::size_t i = 0; i < 3; ++i) {
    const float a = uniform(random, -1, 1), b = a + uniform(random, -0.5f, 0.5f);
    box[i] = std::min(a, b);
    box[i + 3] = random() % 8 == 0 ? box[i] : std::max(a, b);
  }
  return box;
}

/// Any matrix: rotated, scaled, sheared and mirrored at once.
void set_random_transform(std::mt19937& random, rhi::InstanceDesc& instance) {
  for (auto& row : instance.object_to_world) {
    for (float& element : row) element = uniform(random, -1.2f, 1.2f);
  }
}

/// Two bottom levels of triangles and one of boxes, opaque or not, with inactive primitives, and instances of them with
/// all kinds of flags, masks and transforms, some inactive.
RationalScene random_scene(std::mt19937& random, int primitive_count) {
  RationalScene scene;
  const rhi::GeometryFlags geometry_flags[] = {rhi::GeometryFlags::opaque, rhi::GeometryFlags::none,
                                               rhi::GeometryFlags::no_duplicate_any_hit};
  for (int level = 0; level < 3; ++level) {
    std::vector<PrimitiveSet>& sets = scene.bottom_levels.emplace_back();
    for (const rhi::GeometryFlags flags : geometry_flags) {
      std::vector<Triangle> triangles;
      std::vector<BoxExtent> boxes;
      for (int i = 0; i < primitive_count; ++i) {
        triangles.push_back(random_triangle(random));
        boxes.push_back(random_box(random));
        if (i % 7 != 3) continue;
        triangles.back()[0] = NAN;
        boxes.back()[0] = NAN;
      }
      if (level < 2)
        sets.push_back({.primitives = triangles, .flags = flags});
      else
        sets.push_back({.primitives = boxes, .flags = flags});
    }
  }
  const std::uint32_t instance_flags[] = {0, 1, 2, 3, 4, 8, 2 | 4, 1 | 2 | 8, 0};
  const std::uint32_t masks[] = {0xFF, 0x01, 0x80, 0xF0, 0x0F, 0xFF, 0x11, 0x00, 0xFF};
  for (std::size_t i = 0; i < std::size(instance_flags); ++i) {
    rhi::InstanceDesc& instance = scene.instances.emplace_back(instance_of(i % 3));
    if (i > 1) set_random_transform(random, instance);
    instance.mask = masks[i] & 0xFF;
    instance.flags = instance_flags[i] & 0xFF;
  }
  rhi::InstanceDesc nowhere = instance_of(0);
  nowhere.blas_address = 0;
  rhi::InstanceDesc flat = instance_of(1);
  flat.object_to_world[1][1] = 0;
  rhi::InstanceDesc infinite = instance_of(1);
  infinite.object_to_world[2][3] = INFINITY;
  scene.instances.insert(scene.instances.begin() + 2, {nowhere, flat, infinite});
  return scene;
}

Ray random_ray(std::mt19937& random, std::uint32_t flags, std::uint32_t mask) {
  Ray ray{.origin = {}, .t_min = 0, .direction = {}, .t_max = INFINITY, .flags = flags, .mask = mask};
  const float length = std::pow(10.0f, uniform(random, -1, 1));
  for (int i = 0; i < 3; ++i) {
    ray.origin[i] = uniform(random, -2, 2);
    ray.direction[i] = (uniform(random, -0.8f, 0.8f) - ray.origin[i]) * length;
  }
  if (random() % 2 == 0) ray.t_min = uniform(random, 0, 1) / length;
  if (random() % 2 == 0) ray.t_max = ray.t_min + uniform(random, 0, 2) / length;
  return ray;
}

}  // namespace

TEST_CASE("random scenes agree with rational arithmetic, for all ray flags") {
  std::mt19937 random(10);
  std::size_t hits = 0, rays = 0;
  for (int i = 0; i < 2; ++i) {
    const RationalScene scene = random_scene(random, 8);
    const BuiltScene built = build(scene);
    for (const std::uint32_t opacity : {0u, 1u, 2u, 0x40u, 0x80u}) {
      for (const std::uint32_t culling : {0u, 0x10u, 0x20u, 0x100u, 0x200u, 0x210u}) {
        for (const std::uint32_t termination : {0u, 4u}) {
          for (const std::uint32_t mask : {0xFFu, 0x0Fu, 0x00u}) {
            hits += check_ray(scene, built.top_level.view(), random_ray(random, opacity | culling | termination, mask));
            ++rays;
          }
        }
      }
    }
  }
  CHECK(hits > rays / 4);
}

TEST_CASE("every hit of larger scenes is enumerated in order") {
  std::mt19937 random(11);
  const RationalScene scene = random_scene(random, 40);
  const BuiltScene built = build(scene);
  std::size_t hits = 0;
  for (int i = 0; i < 150; ++i) hits += check_ray(scene, built.top_level.view(), random_ray(random, 0, 0xFF));
  CHECK(hits > 500);
}

TEST_CASE("rays are traced from several threads at once") {
  std::mt19937 random(12);
  const RationalScene scene = random_scene(random, 40);
  const BuiltScene built = build(scene);
  const kernel::TopLevel& view = built.top_level.view();
  std::vector<Ray> rays;
  for (int i = 0; i < 2000; ++i) rays.push_back(random_ray(random, 0, 0xFF));
  const auto trace_all = [&] {
    std::vector<float> t;
    for (const Ray& ray : rays) {
      kernel::Hit hit;
      t.push_back(view.functions->closest(view, ray, hit) ? hit.t : -1.0f);
    }
    return t;
  };
  const std::vector<float> alone = trace_all();
  std::vector<std::vector<float>> together(4);
  {
    std::vector<std::jthread> threads;
    for (auto& result : together) threads.emplace_back([&] { result = trace_all(); });
  }
  for (const auto& result : together) CHECK(result == alone);
}
