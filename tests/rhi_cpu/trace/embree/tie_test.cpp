// Hits that lie at the same t, or at one that single precision cannot tell apart: where candidate loops that restart
// behind the last hit lose or repeat some.

#include <doctest/doctest.h>

#include <cmath>
#include <set>
#include <tuple>

#include "rhi_cpu/kernel/ray_query.hpp"
#include "tests/rhi_cpu/trace/embree/brute_force.hpp"

using namespace tandem;
using namespace tandem::test;
using namespace tandem::kernel;

namespace {

using Id = std::tuple<int, int, int>;

struct Enumeration {
  std::set<Id> ids;
  int count = 0;
  bool sorted = true;
};

/// All candidates of the ray, none of them confirmed.
Enumeration enumerate(const TopLevel& top_level, vec3 origin, vec3 direction, float t_max = INFINITY) {
  rayQueryEXT query;
  rayQueryInitializeEXT(query, {&top_level}, ray_flag_no_opaque, 0xFF, origin, 0.0f, direction, t_max);
  Enumeration result;
  float last = 0;
  while (rayQueryProceedEXT(query) && result.count < 100000) {
    result.ids.emplace(rayQueryGetIntersectionInstanceIdEXT(query, false),
                       rayQueryGetIntersectionGeometryIndexEXT(query, false),
                       rayQueryGetIntersectionPrimitiveIndexEXT(query, false));
    ++result.count;
    const float t = rayQueryGetIntersectionTEXT(query, false);
    result.sorted = result.sorted && t >= last;
    last = t;
  }
  return result;
}

}  // namespace

TEST_CASE("coincident triangles of several geometries and instances are all candidates, once each") {
  const Triangle triangle = {0, 0, 0.3f, 1, 0.1f, 0.7f, 0.2f, 1, -0.4f};
  const SoupGeometry geometry{std::vector<Triangle>(50, triangle), false};
  Soup soup{{{geometry, geometry, geometry}}, {instance_of(0), instance_of(0)}};
  const cpu::EmbreeDevice device;
  SUBCASE("with an instance level") {}
  SUBCASE("without") { soup.instances.pop_back(); }
  const BuiltSoup built = build(device, soup);
  for (const float length : {0.01f, 1.0f, 37.0f}) {
    const Enumeration found = enumerate(built.top_level.view(), vec3(0.3f, 0.2f, -5), vec3(0.01f, 0.02f, 1) * length);
    CHECK(found.ids.size() == 150 * soup.instances.size());
    CHECK(found.count == static_cast<int>(found.ids.size()));
    CHECK(found.sorted);
  }
}

TEST_CASE("overlapping coplanar triangles of different shapes are all candidates, once each") {
  // Far from the origin every triangle gives a t of its own rounding, and none may be lost by it. An axis-aligned plane
  // has boxes without thickness, which the rounded hits lie outside of.
  const cpu::EmbreeDevice device;
  std::mt19937 random(31);
  std::uniform_real_distribution<float> uniform(-1, 1);
  vec3 axis_u(0.8f, 0.1f, 0.59f), axis_v(-0.3f, 0.9f, 0.31f);
  SUBCASE("tilted") {}
  SUBCASE("axis-aligned") {
    axis_u = vec3(1, 0, 0);
    axis_v = vec3(0, 1, 0);
  }
  for (const float distance : {1.0f, 100.0f, 5000.0f}) {
    const vec3 center = vec3(0.3f, -0.7f, 0.6f) * distance;
    SoupGeometry geometry{{}, false};
    for (int i = 0; i < 400; ++i) {
      Triangle& triangle = geometry.triangles.emplace_back();
      // Each surrounds the center by a wide margin.
      for (int corner = 0; corner < 3; ++corner) {
        const float angle = 2.0944f * static_cast<float>(corner) + 0.3f * uniform(random);
        const float radius = 2 + uniform(random);
        const vec3 p = center + axis_u * (radius * std::cos(angle)) + axis_v * (radius * std::sin(angle));
        for (int axis = 0; axis < 3; ++axis) triangle[static_cast<std::size_t>(corner * 3 + axis)] = p[axis];
      }
    }
    const Soup soup{{{geometry}}, {instance_of(0)}};
    const BuiltSoup built = build(device, soup);
    for (int i = 0; i < 20; ++i) {
      const vec3 origin = center + vec3(uniform(random), uniform(random), uniform(random)) * 0.1f +
                          vec3(-0.4f, -0.5f, 0.7f) * (1 + distance * (i % 2 == 0 ? 0.01f : 1.0f));
      const Enumeration found = enumerate(built.top_level.view(), origin, center - origin);
      CHECK(found.ids.size() == 400);
      CHECK(found.count == 400);
    }
  }
}

TEST_CASE("instances far from the origin lose no candidates to the rounding of their transforms") {
  // Rotated, so that rays reach object space with an error that is large against their distance from the plane, and
  // hits lie outside of the boxes of their instances. What must be found is what Embree finds in each instance alone.
  const cpu::EmbreeDevice device;
  std::mt19937 random(32);
  std::uniform_real_distribution<float> uniform(-1, 1);
  int expected_candidates = 0;
  for (const float offset : {3000.0f, 30000.0f, 300000.0f}) {
    for (int scene = 0; scene < 10; ++scene) {
      Soup soup{{{SoupGeometry{{{-9, -9, 0, 9, -9, 0, 0, 9, 0}}, false}}}, {}};
      const vec3 center = vec3(uniform(random), uniform(random), uniform(random)) * offset;
      std::vector<BuiltSoup> alone;
      for (int i = 0; i < 8; ++i) {
        rhi::InstanceDesc& instance = soup.instances.emplace_back(instance_of(0));
        const float angle = 1.5707963f + 3e-3f * uniform(random);
        instance.object_to_world[1][1] = instance.object_to_world[2][2] = std::cos(angle);
        instance.object_to_world[1][2] = -std::sin(angle);
        instance.object_to_world[2][1] = std::sin(angle);
        for (int axis = 0; axis < 3; ++axis) instance.object_to_world[axis][3] = center[axis];
        alone.push_back(build(device, {soup.bottom_levels, {instance}}));
      }
      const BuiltSoup built = build(device, soup);
      for (int i = 0; i < 50; ++i) {
        const float distance = offset * 1e-6f * (3 + uniform(random));
        const vec3 origin = center + vec3(0.5f * uniform(random), distance, 0.5f * uniform(random));
        const vec3 direction(0.1f * uniform(random), -1, 0.1f);
        int expected = 0;
        for (const BuiltSoup& one : alone) expected += enumerate(one.top_level.view(), origin, direction).count;
        const Enumeration found = enumerate(built.top_level.view(), origin, direction);
        CHECK(found.count == expected);
        CHECK(found.ids.size() == static_cast<std::size_t>(expected));
        expected_candidates += expected;
      }
    }
  }
  CHECK(expected_candidates > 8 * 50 * 30 / 2);
}

TEST_CASE("a closed mesh is hit through its edges and vertices too") {
  // A height field of unit cells over an integer grid: rays at integer and half-integer points go through vertices,
  // edges and diagonals exactly.
  constexpr int size = 16;
  const auto height = [](int x, int y) { return 0.25f * static_cast<float>((x * 7 + y * 13) % 5); };
  const auto corner = [&](int x, int y) {
    return std::array<float, 3>{static_cast<float>(x), static_cast<float>(y), height(x, y)};
  };
  SoupGeometry geometry;
  const auto add = [&](const auto& a, const auto& b, const auto& c) {
    geometry.triangles.push_back({a[0], a[1], a[2], b[0], b[1], b[2], c[0], c[1], c[2]});
  };
  for (int x = 0; x < size; ++x) {
    for (int y = 0; y < size; ++y) {
      add(corner(x, y), corner(x + 1, y), corner(x + 1, y + 1));
      add(corner(x, y), corner(x + 1, y + 1), corner(x, y + 1));
    }
  }
  const Soup soup{{{geometry}}, {instance_of(0)}};
  const cpu::EmbreeDevice device;
  const BuiltSoup built = build(device, soup);
  for (const uint flags :
       {0u, static_cast<uint>(ray_flag_no_opaque), static_cast<uint>(ray_flag_terminate_on_first_hit)}) {
    for (int x = 1; x < 2 * size; ++x) {
      for (int y = 1; y < 2 * size; ++y) {
        for (const vec3 direction : {vec3(0, 0, -1), vec3(0.25f, 0.125f, -1), vec3(-0.3f, 0.1f, -0.7f)}) {
          const vec3 target(static_cast<float>(x) * 0.5f, static_cast<float>(y) * 0.5f, 0.5f);
          if (target.x + 2 > size || target.y + 2 > size || target.x < 2 || target.y < 2) continue;
          rayQueryEXT query;
          rayQueryInitializeEXT(query, {&built.top_level.view()}, flags, 0xFF, target - direction * 8.0f, 0.0f,
                                direction, 100.0f);
          while (rayQueryProceedEXT(query)) rayQueryConfirmIntersectionEXT(query);
          CHECK(rayQueryGetIntersectionTypeEXT(query, true) == committed_intersection_triangle);
        }
      }
    }
  }
}
