#include "tests/rhi_cpu/trace/brute_force.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>

#include "rhi_cpu/kernel/ray_query.hpp"

using namespace tandem;
using namespace tandem::test;
using namespace tandem::kernel;

namespace {

using Id = std::tuple<std::uint32_t, std::uint32_t, std::uint32_t>;

Id id_of(const ExactHit& hit) { return {hit.instance_index, hit.geometry_index, hit.primitive_index}; }

Id id_of(rayQueryEXT& query, bool committed) {
  return {rayQueryGetIntersectionInstanceIdEXT(query, committed),
          rayQueryGetIntersectionGeometryIndexEXT(query, committed),
          rayQueryGetIntersectionPrimitiveIndexEXT(query, committed)};
}

/// Which candidates the shader confirms: a third of them, by a hash of what they are.
bool is_accepted(const Id& id) {
  const auto [instance, geometry, primitive] = id;
  std::uint32_t hash = instance * 0x9E3779B9u + geometry * 0x85EBCA6Bu + primitive * 0xC2B2AE35u;
  hash ^= hash >> 15;
  hash *= 0x2C1B3C6Du;
  return ((hash ^ (hash >> 12)) % 3) == 0;
}

void initialize(rayQueryEXT& query, const TopLevel& top_level, const Ray& ray) {
  rayQueryInitializeEXT(query, {&top_level}, ray.flags, ray.mask, vec3(ray.origin[0], ray.origin[1], ray.origin[2]),
                        ray.t_min, vec3(ray.direction[0], ray.direction[1], ray.direction[2]), ray.t_max);
}

const ExactHit* find(const ExactHits& exact, const Id& id) {
  const auto found =
      std::find_if(exact.hits.begin(), exact.hits.end(), [&](const auto& hit) { return id_of(hit) == id; });
  return found != exact.hits.end() ? &*found : nullptr;
}

void check_details(rayQueryEXT& query, bool committed, const ExactHit& hit, const Soup& soup) {
  CHECK(std::abs(double{rayQueryGetIntersectionTEXT(query, committed)} - hit.t) <= hit.t_tolerance);
  const vec2 uv = rayQueryGetIntersectionBarycentricsEXT(query, committed);
  CHECK(std::abs(double{uv.x} - hit.u) <= hit.uv_tolerance);
  CHECK(std::abs(double{uv.y} - hit.v) <= hit.uv_tolerance);
  CHECK(rayQueryGetIntersectionFrontFaceEXT(query, committed) == hit.front_face);
  const rhi::InstanceDesc& instance = soup.instances[hit.instance_index];
  CHECK(rayQueryGetIntersectionInstanceCustomIndexEXT(query, committed) == static_cast<int>(instance.custom_index));
  CHECK(rayQueryGetIntersectionInstanceShaderBindingTableRecordOffsetEXT(query, committed) == instance.sbt_offset);
}

/// Traces the ray as a shader that confirms by is_accepted would, and compares everything that it could see.
void check_ray(const Soup& soup, const TopLevel& top_level, const Ray& ray, const ExactHits& exact) {
  rayQueryEXT query;
  initialize(query, top_level, ray);
  std::set<Id> candidates;
  while (rayQueryProceedEXT(query)) {
    const Id id = id_of(query, false);
    CHECK(candidates.insert(id).second);
    const ExactHit* hit = find(exact, id);
    REQUIRE(hit != nullptr);
    CHECK_FALSE(hit->opaque);
    check_details(query, false, *hit, soup);
    if (is_accepted(id)) rayQueryConfirmIntersectionEXT(query);
  }

  const auto commits = [](const ExactHit& hit) { return hit.opaque || is_accepted(id_of(hit)); };
  const auto nearest = std::find_if(exact.hits.begin(), exact.hits.end(), commits);
  const bool any = nearest != exact.hits.end();
  CHECK((rayQueryGetIntersectionTypeEXT(query, true) == committed_intersection_triangle) == any);
  if (!any) {
    CHECK(rayQueryGetIntersectionTEXT(query, true) == ray.t_max);
  } else {
    const ExactHit* committed = find(exact, id_of(query, true));
    REQUIRE(committed != nullptr);
    CHECK(commits(*committed));
    check_details(query, true, *committed, soup);
    // Two hits that single precision cannot tell apart may be taken for each other.
    const bool tied = committed->t - nearest->t <= committed->t_tolerance + nearest->t_tolerance;
    if ((ray.flags & ray_flag_terminate_on_first_hit) == 0) CHECK((committed == &*nearest || tied));
  }
  if ((ray.flags & ray_flag_terminate_on_first_hit) != 0) return;
  for (const ExactHit& hit : exact.hits) {
    const bool clearly_nearer = !any || hit.t + hit.t_tolerance < nearest->t - nearest->t_tolerance;
    if (!hit.opaque && clearly_nearer) CHECK(candidates.count(id_of(hit)) == 1);
  }
}

/// Every legal combination of ray flags, with several masks.
void check_all_flags(const Soup& soup, const TopLevel& top_level, std::mt19937& random, int rays_each) {
  int unambiguous = 0, total = 0, hits = 0;
  for (const std::uint32_t opacity : {0u, 1u, 2u, 0x40u, 0x80u}) {
    for (const std::uint32_t culling : {0u, 0x10u, 0x20u, 0x100u, 0x200u, 0x210u}) {
      for (const std::uint32_t termination : {0u, 4u, 8u, 12u}) {
        for (const std::uint32_t mask : {0xFFu, 0x0Fu, 0x80u, 0x00u}) {
          for (int i = 0; i < rays_each; ++i) {
            const Ray ray = random_ray(random, opacity | culling | termination, mask);
            const ExactHits exact = all_hits(soup, ray);
            ++total;
            if (exact.ambiguous) continue;
            ++unambiguous;
            hits += !exact.hits.empty();
            CAPTURE(ray.flags);
            CAPTURE(ray.mask);
            check_ray(soup, top_level, ray, exact);
          }
        }
      }
    }
  }
  // The test must not have excluded what it tests.
  CHECK(unambiguous > total / 2);
  CHECK(hits > total / 8);
}

}  // namespace

TEST_CASE("instances of triangle soups agree with brute force, for all ray flags") {
  const cpu::EmbreeDevice device;
  std::mt19937 random(20);
  for (int scene = 0; scene < 3; ++scene) {
    const Soup soup = random_soup(random, 3, 24);
    const BuiltSoup built = build(device, soup);
    check_all_flags(soup, built.top_level.view(), random, 6);
  }
}

TEST_CASE("a single instance at the origin agrees with brute force, for all ray flags and instance flags") {
  const cpu::EmbreeDevice device;
  std::mt19937 random(21);
  for (const std::uint32_t flags : {0u, 1u, 2u, 3u, 4u, 8u}) {
    Soup soup = random_soup(random, 4, 60);
    // Behind an inactive instance, so that its index is not the one Embree would give it.
    rhi::InstanceDesc nowhere = instance_of(0);
    nowhere.blas_address = 0;
    rhi::InstanceDesc only = instance_of(1);
    only.flags = flags & 0xFF;
    only.mask = 0x8F;
    only.custom_index = 77;
    only.sbt_offset = 78;
    soup.instances = {nowhere, only};
    const BuiltSoup built = build(device, soup);
    check_all_flags(soup, built.top_level.view(), random, 3);
  }
}

TEST_CASE("opaque scenes agree with brute force, for all ray flags") {
  const cpu::EmbreeDevice device;
  std::mt19937 random(22);
  Soup soup = random_soup(random, 3, 40);
  for (auto& geometries : soup.bottom_levels) {
    for (SoupGeometry& geometry : geometries) geometry.opaque = true;
  }
  for (rhi::InstanceDesc& instance : soup.instances) instance.flags = instance.flags & 0x7u;
  const BuiltSoup built = build(device, soup);
  CHECK(built.top_level.view().all_opaque);
  check_all_flags(soup, built.top_level.view(), random, 6);
}

TEST_CASE("every candidate is enumerated exactly once when none is confirmed") {
  const cpu::EmbreeDevice device;
  std::mt19937 random(23);
  const Soup soup = random_soup(random, 3, 150);
  const BuiltSoup built = build(device, soup);
  int unambiguous = 0;
  std::size_t most = 0;
  for (int i = 0; i < 1500; ++i) {
    const Ray ray = random_ray(random, ray_flag_no_opaque, 0xFF);
    const ExactHits exact = all_hits(soup, ray);
    if (exact.ambiguous) continue;
    ++unambiguous;
    most = std::max(most, exact.hits.size());
    std::set<Id> expected, offered;
    for (const ExactHit& hit : exact.hits) expected.insert(id_of(hit));
    rayQueryEXT query;
    initialize(query, built.top_level.view(), ray);
    while (rayQueryProceedEXT(query)) CHECK(offered.insert(id_of(query, false)).second);
    CHECK(offered == expected);
  }
  CHECK(unambiguous > 500);
  CHECK(most >= 12);
}
