// Packets find what their rays find one by one.

#include <doctest/doctest.h>

#include <cstdint>
#include <limits>
#include <random>

#include "rhi_cpu/trace/packets.hpp"
#include "tests/rhi_cpu/trace/embree/brute_force.hpp"

using namespace tandem;
using namespace tandem::test;
using namespace tandem::kernel;

namespace {

Soup random_soup(std::mt19937& random) {
  std::uniform_real_distribution<float> uniform(-1, 1);
  SoupGeometry geometry{{}, true};
  for (int i = 0; i < 200; ++i) {
    Triangle& triangle = geometry.triangles.emplace_back();
    for (std::size_t k = 0; k < triangle.size(); ++k) triangle[k] = uniform(random);
  }
  rhi::InstanceDesc moved = instance_of(0);  // where two instances coincide, each may answer
  moved.object_to_world[0][3] = 0.125f;
  return Soup{{{geometry}}, {instance_of(0), moved}};
}

RayPacket random_packet(std::mt19937& random, std::uint32_t count) {
  std::uniform_real_distribution<float> uniform(-1, 1);
  RayPacket rays{};
  rays.count = count;
  rays.mask = 0xff;
  rays.active = static_cast<std::uint32_t>(random()) & ((1u << count) - 1);
  for (std::uint32_t i = 0; i < count; ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      rays.origin[axis][i] = 2 * uniform(random);
      rays.direction[axis][i] = uniform(random);
    }
    rays.t_min[i] = 0.01f;
    rays.t_max[i] = 3 + 2 * uniform(random);
  }
  return rays;
}

/// How many hits there were.
int compare(const TopLevel& scene, const RayPacket& rays) {
  HitPacket together{}, alone{};
  const std::uint32_t found = scene.functions->closest_of_packet(scene, rays, together);
  REQUIRE(found == cpu::closest_by_ray(scene, rays, alone));
  CHECK((found & ~rays.active) == 0);
  int hits = 0;
  for (std::uint32_t i = 0; i < rays.count; ++i) {
    if ((found >> i & 1) == 0) continue;
    ++hits;
    // No two triangles of the soup are equally far. t and the barycentrics may round in another way.
    CHECK(together.instance_index[i] == alone.instance_index[i]);
    CHECK(together.geometry_index[i] == alone.geometry_index[i]);
    CHECK(together.primitive_index[i] == alone.primitive_index[i]);
    CHECK((together.front_face >> i & 1) == (alone.front_face >> i & 1));
    CHECK(together.t[i] == doctest::Approx(alone.t[i]).epsilon(1e-5));
    CHECK(together.barycentrics[0][i] == doctest::Approx(alone.barycentrics[0][i]).epsilon(1e-3));
    CHECK(together.barycentrics[1][i] == doctest::Approx(alone.barycentrics[1][i]).epsilon(1e-3));
  }
  CHECK(scene.functions->occluded_of_packet(scene, rays) == cpu::occluded_by_ray(scene, rays));
  return hits;
}

}  // namespace

TEST_CASE("a packet meets what its rays meet, whichever of them are active, under every flag") {
  std::mt19937 random(5);
  const cpu::EmbreeDevice device;
  Soup soup = random_soup(random);
  SUBCASE("with an instance level") {}
  SUBCASE("without") { soup.instances.pop_back(); }
  const BuiltSoup built = build(device, soup);
  int hits = 0;
  for (const std::uint32_t count : {4u, 8u, 16u})
    for (const std::uint32_t flags :
         {0u, std::uint32_t{ray_flag_cull_back_facing_triangles}, std::uint32_t{ray_flag_skip_triangles}})
      for (int i = 0; i < 200; ++i) {
        RayPacket rays = random_packet(random, count);
        rays.flags = flags;
        hits += compare(built.top_level.view(), rays);
      }
  CHECK(hits > 500);
}

TEST_CASE("rays that Embree may not be given meet nothing, beside rays that it traces") {
  std::mt19937 random(6);
  const cpu::EmbreeDevice device;
  const BuiltSoup built = build(device, random_soup(random));
  for (int i = 0; i < 100; ++i) {
    RayPacket rays = random_packet(random, 8);
    rays.active = 0xff;
    rays.origin[1][2] = std::numeric_limits<float>::quiet_NaN();
    rays.direction[0][5] = std::numeric_limits<float>::infinity();
    HitPacket hits;
    CHECK((built.top_level.view().functions->closest_of_packet(built.top_level.view(), rays, hits) & 0x24) == 0);
    compare(built.top_level.view(), rays);
  }
}
