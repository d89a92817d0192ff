// Boxes: which rays are offered which, and where the search begins and ends.

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "rhi/error.hpp"
#include "rhi_cpu/kernel/ray_query.hpp"
#include "tests/rhi_cpu/trace/embree/brute_force.hpp"
#include "tests/support/few_ulp.hpp"

using namespace tandem;
using namespace tandem::test;
using namespace tandem::kernel;

namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr float not_a_number = std::numeric_limits<float>::quiet_NaN();

Soup one_box(const BoxCorners& box) { return {{{SoupGeometry{{}, false, {box}}}}, {instance_of(0)}}; }

constexpr float nowhere = -1;

/// Where the ray enters the first box that it is offered, or `nowhere`.
float entry(const TopLevel& top_level, vec3 origin, vec3 direction, float t_min = 0, float t_max = infinity,
            uint flags = 0) {
  rayQueryEXT query;
  rayQueryInitializeEXT(query, {&top_level}, flags, 0xFF, origin, t_min, direction, t_max);
  if (!rayQueryProceedEXT(query)) return nowhere;
  CHECK(rayQueryGetIntersectionTypeEXT(query, false) == candidate_intersection_aabb);
  return rayQueryGetIntersectionTEXT(query, false);
}

/// The same, with and without an instance level.
float entry(const Soup& soup, vec3 origin, vec3 direction, float t_min = 0, float t_max = infinity) {
  const cpu::EmbreeDevice device;
  const float direct = entry(build(device, soup).top_level.view(), origin, direction, t_min, t_max);
  Soup two = soup;
  two.instances.push_back(instance_of(0));
  two.instances.back().mask = 0;
  CHECK(entry(build(device, two).top_level.view(), origin, direction, t_min, t_max) == direct);
  return direct;
}

}  // namespace

TEST_CASE("a box is offered to rays that are anywhere in it between t_min and t_max") {
  const Soup soup = one_box({1, 1, 1, 2, 2, 2});
  const vec3 origin(-1, 1.5f, 1.5f), x(2, 0, 0);
  // Entered a few units in the last place early, never late.
  const auto is_entered_at = [](float t, float expected) { return t <= expected && t >= expected * (1 - 2e-6f); };
  CHECK(is_entered_at(entry(soup, origin, x), 1));
  CHECK(is_entered_at(entry(soup, origin, x, 0.5f), 1));
  CHECK(entry(soup, origin, x, 1.25f) == 1.25f);          // begins inside
  CHECK(entry(soup, origin, x, 1.5f) == 1.5f);            // begins where it is left
  CHECK(entry(soup, origin, x, 1.6f) == nowhere);         // behind
  CHECK(entry(soup, origin, x, 0, 0.9f) == nowhere);      // not there yet
  CHECK(is_entered_at(entry(soup, origin, x, 0, 1), 1));  // ends where it is entered
  CHECK(entry(soup, origin, x, 1.25f, 1.3f) == 1.25f);    // inside from end to end
  CHECK(entry(soup, vec3(1.5f), x) == 0);
  CHECK(entry(soup, vec3(2), x) == 0);  // from a corner away
  CHECK(entry(soup, vec3(3), x) == nowhere);
  CHECK(entry(soup, origin, -x) == nowhere);
  CHECK(entry(soup, vec3(-1, 3, 1.5f), x) == nowhere);
}

TEST_CASE("rays that only touch a box, and boxes without thickness, are offered") {
  for (const vec3 at : {vec3(0), vec3(-3, 5, 7), vec3(0.1f, -0.3f, 1e-3f), vec3(1000, 3000, -777)}) {
    const BoxCorners box = {at.x, at.y, at.z, at.x + 1, at.y + 1, at.z + 1};
    const vec3 corner(box[3], box[4], box[5]);
    for (const float sign : {-1.0f, 1.0f}) {
      const vec3 x(sign, 0, 0), start = x * -3.0f;
      // Along all four edges that are parallel to x, which are on two faces each, and along the faces.
      CHECK(entry(one_box(box), at + start, x) != nowhere);
      CHECK(entry(one_box(box), vec3(at.x, corner.y, at.z) + start, x) != nowhere);
      CHECK(entry(one_box(box), vec3(at.x, at.y, corner.z) + start, x) != nowhere);
      CHECK(entry(one_box(box), vec3(at.x, corner.y, corner.z) + start, x) != nowhere);
      CHECK(entry(one_box(box), vec3(at.x, at.y + 0.5f, corner.z) + start, x) != nowhere);
      CHECK(entry(one_box(box), vec3(at.x, at.y + 0.5f, at.z) + start, x) != nowhere);
      // Flat: a wall across the ray, one that the ray runs in, a line and a point.
      CHECK(entry(one_box({at.x, at.y, at.z, at.x, corner.y, corner.z}), at + vec3(0, 0.5f, 0.5f) + start, x) !=
            nowhere);
      CHECK(entry(one_box({at.x, at.y, at.z, corner.x, corner.y, at.z}), at + vec3(0, 0.5f, 0) + start, x) != nowhere);
      CHECK(entry(one_box({at.x, at.y, at.z, corner.x, at.y, at.z}), at + start, x) != nowhere);
      CHECK(entry(one_box({at.x, at.y, at.z, at.x, at.y, at.z}), at + start, x) != nowhere);
      // Through an edge and through a corner, at an angle.
      const vec3 diagonal(1, -1, 0);
      CHECK(entry(one_box(box), vec3(at.x, at.y, at.z + 0.5f) - diagonal * 2.0f, diagonal) != nowhere);
      CHECK(entry(one_box(box), at - vec3(1, -2, 1) * 2.0f, vec3(1, -2, 1)) != nowhere);
    }
  }
}

TEST_CASE("rays through the corners of boxes in rotated, scaled and moved instances are offered them") {
  const cpu::EmbreeDevice device;
  std::mt19937 random(41);
  std::uniform_real_distribution<float> uniform(-1, 1);
  for (int scene = 0; scene < 200; ++scene) {
    Soup soup = one_box({-1, -1, -1, 1, 1, 1});
    rhi::InstanceDesc& instance = soup.instances[0];
    const float angle = 3 * uniform(random), scale = std::pow(10.0f, 2 * uniform(random));
    instance.object_to_world[0][0] = instance.object_to_world[1][1] = scale * std::cos(angle);
    instance.object_to_world[1][0] = scale * std::sin(angle);
    instance.object_to_world[0][1] = -instance.object_to_world[1][0];
    instance.object_to_world[2][2] = -scale;
    for (auto& row : instance.object_to_world) row[3] = 30 * scale * uniform(random);
    const BuiltSoup built = build(device, soup);
    for (int corner = 0; corner < 8; ++corner) {
      const vec3 object((corner & 1) != 0 ? 1 : -1, (corner & 2) != 0 ? 1 : -1, (corner & 4) != 0 ? 1 : -1);
      vec3 world;
      for (int row = 0; row < 3; ++row) {
        const auto& m = instance.object_to_world[row];
        world[row] = m[0] * object.x + m[1] * object.y + m[2] * object.z + m[3];
      }
      const vec3 direction = vec3(uniform(random), uniform(random), uniform(random)) * scale;
      CHECK(entry(built.top_level.view(), world - direction * 3.0f, direction) != nowhere);
      // From the corner itself.
      CHECK(entry(built.top_level.view(), world, direction) != nowhere);
    }
  }
}

TEST_CASE("boxes with a NaN or turned inside out are inactive, those with infinite sides are not") {
  const vec3 origin(0.5f, 0.5f, -2), z(0, 0, 1);
  CHECK(entry(one_box({not_a_number, 0, 0, 1, 1, 1}), origin, z) == nowhere);
  CHECK(entry(one_box({0, 0, not_a_number, 1, 1, 1}), origin, z) == nowhere);
  CHECK(entry(one_box({0, 0, 0, 1, not_a_number, 1}), origin, z) == nowhere);
  CHECK(entry(one_box({0, 0, 1, 1, 1, 0}), origin, z) == nowhere);
  CHECK(entry(one_box({-infinity, -infinity, 0, infinity, infinity, 1}), origin, z) != nowhere);
  CHECK(entry(one_box({-infinity, -infinity, -infinity, infinity, infinity, infinity}), origin, z) == 0);
  CHECK(entry(one_box({0, 0, 3, 1, 1, infinity}), origin, z, 100, 200) == 100);
  CHECK(entry(one_box({2, 0, 0, infinity, 1, 1}), origin, z) == nowhere);
}

TEST_CASE("rays that are no rays meet no box") {
  const Soup soup = one_box({-1, -1, -1, 1, 1, 1});
  CHECK(entry(soup, vec3(0), vec3(0)) == nowhere);
  CHECK(entry(soup, vec3(not_a_number), vec3(1)) == nowhere);
  CHECK(entry(soup, vec3(0), vec3(1, not_a_number, 0)) == nowhere);
  CHECK(entry(soup, vec3(0, infinity, 0), vec3(1)) == nowhere);
  CHECK(entry(soup, vec3(0), vec3(1, infinity, 0)) == nowhere);
  CHECK(entry(soup, vec3(0), vec3(1), 2, 1) == nowhere);
}

TEST_CASE("the primitives before and behind inactive boxes keep their numbers, and empty geometries theirs") {
  const cpu::EmbreeDevice device;
  struct Record {
    BoxCorners box;
    std::uint32_t unused[2];
  };
  const Record records[] = {{{not_a_number, 0, 0, 1, 1, 1}, {}}, {{0, 0, 5, 1, 1, 6}, {}}};
  const cpu::GeometryInput inputs[] = {
      cpu::BoxInput{},
      cpu::BoxInput{.boxes = std::as_bytes(std::span(records)), .box_count = 2, .stride = sizeof(Record)}};
  const cpu::BottomLevel bottom_level = cpu::BottomLevel::build(device, inputs, rhi::BuildFlags::none, "boxes");
  const rhi::InstanceDesc instances[] = {instance_of(0), instance_of(0)};
  const cpu::TopLevel top_level = cpu::TopLevel::build(
      device, instances, [&](std::uint64_t) { return &bottom_level; }, rhi::BuildFlags::none, "top");
  rayQueryEXT query;
  rayQueryInitializeEXT(query, {&top_level.view()}, 0, 0xFF, vec3(0.5f, 0.5f, 0), 0, vec3(0, 0, 1), 100);
  for (const int instance : {0, 1}) {
    REQUIRE(rayQueryProceedEXT(query));
    CHECK(rayQueryGetIntersectionInstanceIdEXT(query, false) == instance);
    CHECK(rayQueryGetIntersectionGeometryIndexEXT(query, false) == 1);
    CHECK(rayQueryGetIntersectionPrimitiveIndexEXT(query, false) == 1);
    CHECK(rayQueryGetIntersectionCandidateAABBOpaqueEXT(query));
  }
  CHECK_FALSE(rayQueryProceedEXT(query));
}

TEST_CASE("closest and occluded look at triangles only, whatever boxes there are") {
  const cpu::EmbreeDevice device;
  const Triangle triangle = {-1, -1, 5, 1, -1, 5, 0, 1, 5};
  Soup soup{{{SoupGeometry{{triangle}, true}}, {SoupGeometry{{}, true, {{-1, -1, 2, 1, 1, 3}}}}},
            {instance_of(0), instance_of(1), instance_of(1)}};
  const Ray ray = {.origin = {0, 0, 0}, .t_min = 0, .direction = {0, 0, 1}, .t_max = 100, .flags = 0, .mask = 0xFF};
  const auto hits = [&] {
    const BuiltSoup built = build(device, soup);
    const TopLevel& top_level = built.top_level.view();
    Hit hit;
    const bool found = top_level.functions->closest(top_level, ray, hit);
    if (found) CHECK((within_few_ulp(hit.t, 5) && !hit.is_box));
    CHECK(top_level.functions->occluded(top_level, ray) == found);
    CHECK(top_level.has_boxes);
    CHECK(top_level.all_opaque);
    return found;
  };
  CHECK(hits());
  soup.instances.erase(soup.instances.begin());
  CHECK_FALSE(hits());
  soup.instances.pop_back();
  CHECK_FALSE(hits());
}

TEST_CASE("a bottom level of triangles and boxes is an error") {
  const cpu::EmbreeDevice device;
  const cpu::GeometryInput inputs[] = {cpu::TriangleInput{}, cpu::BoxInput{}};
  CHECK_THROWS_WITH_AS(cpu::BottomLevel::build(device, inputs, rhi::BuildFlags::none, "mixture"),
                       doctest::Contains("mixture: geometry 1 is not of the kind of geometry 0"), rhi::Error);
}
