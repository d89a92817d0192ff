// Rules that need no arithmetic.

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "rhi/error.hpp"
#include "tests/rhi_cpu/trace/exact/ray_checks.hpp"

using namespace tandem;
using namespace tandem::test;
using kernel::Hit;
using kernel::Ray;

namespace {

constexpr Triangle triangle_at(float z) { return {-1, -1, z, 1, -1, z, 0, 1, z}; }

Ray ray_along_z(float origin_z = -1) {
  return {.origin = {0, 0, origin_z}, .t_min = 0, .direction = {0, 0, 1}, .t_max = INFINITY, .flags = 0, .mask = 0xFF};
}

bool closest(const cpu::exact::TopLevel& top_level, const Ray& ray, Hit& hit) {
  return top_level.view().functions->closest(top_level.view(), ray, hit);
}

RationalScene one_triangle() {
  RationalScene scene;
  scene.bottom_levels = {{{.primitives = std::vector{triangle_at(0)}}}};
  scene.instances = {instance_of(0)};
  return scene;
}

}  // namespace

TEST_CASE("facing is decided in object space: mirroring keeps it, flipping does not") {
  for (const bool mirrored : {false, true}) {
    for (const bool flipped : {false, true}) {
      RationalScene scene = one_triangle();
      // Seen along +z the vertices run clockwise in a left-handed system: (v1 - v0) x (v2 - v0) is +z, along the ray.
      if (mirrored) scene.instances[0].object_to_world[0][0] = -1;
      if (flipped)
        scene.instances[0].flags = static_cast<std::uint32_t>(rhi::InstanceFlags::triangle_flip_facing) & 0xFF;
      const BuiltScene built = build(scene);
      Hit hit;
      REQUIRE(closest(built.top_level, ray_along_z(), hit));
      CHECK(hit.front_face == flipped);
    }
  }
}

TEST_CASE("a triangle is met between t_min and t_max, both excluded") {
  const BuiltScene built = build(one_triangle());
  Hit hit;
  Ray ray = ray_along_z();
  CHECK(closest(built.top_level, ray, hit));
  CHECK(hit.t == 1);
  ray.t_max = 1;
  CHECK_FALSE(closest(built.top_level, ray, hit));
  ray.t_max = std::nextafter(1.0f, 2.0f);
  CHECK(closest(built.top_level, ray, hit));
  ray.t_min = 1;
  CHECK_FALSE(closest(built.top_level, ray, hit));
  ray.t_min = std::nextafter(1.0f, 0.0f);
  CHECK(closest(built.top_level, ray, hit));
  CHECK_FALSE(closest(built.top_level, ray_along_z(0), hit));
}

TEST_CASE("rays with a NaN or an infinity meet nothing") {
  const BuiltScene built = build(one_triangle());
  for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    for (std::size_t i = 0; i < 3; ++i) {
      Hit hit;
      Ray ray = ray_along_z();
      ray.origin[i] = bad;
      CHECK_FALSE(closest(built.top_level, ray, hit));
      ray = ray_along_z();
      ray.direction[i] = -bad;
      CHECK_FALSE(closest(built.top_level, ray, hit));
    }
  }
}

TEST_CASE("null, empty and inactive structures") {
  RationalScene scene = one_triangle();
  scene.bottom_levels.push_back({});
  scene.instances = {};
  Hit hit;
  CHECK_FALSE(closest(build(scene).top_level, ray_along_z(), hit));
  rhi::InstanceDesc nowhere = instance_of(0);
  nowhere.blas_address = 0;
  rhi::InstanceDesc unseen = instance_of(0);
  unseen.mask = 0;
  scene.instances = {nowhere, unseen, instance_of(1)};
  const BuiltScene built = build(scene);
  CHECK(built.top_level.view().instance_count == 3);
  CHECK_FALSE(closest(built.top_level, ray_along_z(), hit));
}

TEST_CASE("an infinite box reaches as far as floats do") {
  RationalScene scene;
  const float end = std::numeric_limits<float>::infinity();
  scene.bottom_levels = {{{.primitives = std::vector<BoxExtent>{{-end, -end, 1, end, end, end}}}}};
  scene.instances = {instance_of(0)};
  const BuiltScene built = build(scene);
  Hit hit;
  CHECK(built.top_level.view().functions->next_hits(built.top_level.view(), ray_along_z(), nullptr, &hit, 1) == 1);
  CHECK(hit.t == 2);
}

TEST_CASE("what a kernel reads of an instance") {
  RationalScene scene = one_triangle();
  rhi::InstanceDesc& instance = scene.instances[0];
  instance.custom_index = 0xABCDEF;
  instance.sbt_offset = 0x123456;
  instance.object_to_world[0][0] = 2;
  instance.object_to_world[0][3] = 6;
  instance.object_to_world[1][1] = -4;
  const BuiltScene built = build(scene);
  const kernel::Instance& read = built.top_level.view().instances[0];
  CHECK(read.custom_index == 0xABCDEF);
  CHECK(read.sbt_offset == 0x123456);
  CHECK(read.object_to_world[0][3] == 6);
  CHECK(read.world_to_object[0][0] == 0.5f);
  CHECK(read.world_to_object[0][3] == -3);
  CHECK(read.world_to_object[1][1] == -0.25f);
}

TEST_CASE("what a top level says of its candidates") {
  RationalScene scene = one_triangle();
  CHECK(build(scene).top_level.view().all_opaque);
  CHECK_FALSE(build(scene).top_level.view().has_boxes);
  scene.instances[0].flags = static_cast<std::uint32_t>(rhi::InstanceFlags::force_no_opaque) & 0xFF;
  CHECK_FALSE(build(scene).top_level.view().all_opaque);
  scene.bottom_levels[0][0].flags = rhi::GeometryFlags::none;
  scene.instances[0].flags = 0;
  CHECK_FALSE(build(scene).top_level.view().all_opaque);
  scene.instances[0].flags = static_cast<std::uint32_t>(rhi::InstanceFlags::force_opaque) & 0xFF;
  CHECK(build(scene).top_level.view().all_opaque);
  scene.bottom_levels.push_back({{.primitives = std::vector<BoxExtent>{{-1, -1, -1, 1, 1, 1}}}});
  scene.instances.push_back(instance_of(1));
  CHECK(build(scene).top_level.view().has_boxes);
}

TEST_CASE("an updated bottom level is seen by the top levels that are built after it") {
  RationalScene scene = one_triangle();
  BuiltScene built = build(scene);
  const std::vector<PrimitiveSet> moved = {{.primitives = std::vector{triangle_at(5)}}};
  built.bottom_levels[0].update(inputs_of(moved), "moved");
  Hit hit;
  REQUIRE(closest(built.top_level, ray_along_z(), hit));
  CHECK(hit.t == 1);
  const auto rebuilt = cpu::exact::TopLevel::build(
      scene.instances, [&](std::uint64_t) { return &built.bottom_levels[0]; }, "rebuilt");
  REQUIRE(closest(rebuilt, ray_along_z(), hit));
  CHECK(hit.t == 6);
}

TEST_CASE("structures know how large they are") {
  RationalScene small = one_triangle();
  RationalScene large = small;
  large.bottom_levels[0][0].primitives = std::vector(1000, triangle_at(1));
  large.instances = std::vector(1000, instance_of(0));
  const BuiltScene a = build(small), b = build(large);
  CHECK(a.bottom_levels[0].bytes() > 0);
  CHECK(a.top_level.bytes() > 0);
  CHECK(b.bottom_levels[0].bytes() > 36 * 1000);
  CHECK(b.top_level.bytes() > 64 * 1000);
}

TEST_CASE("an instance of nothing known is an error") {
  const rhi::InstanceDesc instance = instance_of(6);
  try {
    cpu::exact::TopLevel::build(
        std::span(&instance, 1), [](std::uint64_t) { return nullptr; }, "my scene");
    FAIL("no error");
  } catch (const rhi::Error& error) {
    CHECK(std::string(error.what()).find("my scene") != std::string::npos);
    CHECK(std::string(error.what()).find("0x7") != std::string::npos);
  }
}
