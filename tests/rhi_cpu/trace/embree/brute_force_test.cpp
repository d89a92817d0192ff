#include "tests/rhi_cpu/trace/embree/brute_force.hpp"

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

/// Where the shader generates a hit in a box, in the same way on both sides of the comparison: within the box, and not
/// at its ends.
float generated_t(const ExactHit& box) {
  return static_cast<float>(box.t + (box.t_exit - box.t) * (box.primitive_index % 2 == 0 ? 0.25 : 0.75));
}

/// t of the hit that the shader commits; +infinity if it does not.
double committed_t(const ExactHit& hit) {
  if (!hit.is_box) return hit.opaque || is_accepted(id_of(hit)) ? hit.t : INFINITY;
  return is_accepted(id_of(hit)) ? double{generated_t(hit)} : INFINITY;
}

void check_candidate(const Hit& candidate, const ExactHit& exact) {
  CHECK(candidate.is_box == exact.is_box);
  CHECK(candidate.opaque == exact.opaque);
  CHECK(std::abs(double{candidate.t} - exact.t) <= exact.t_tolerance);
  if (exact.is_box) {
    // Not later than the box begins, or a hit in it could be taken for one behind another.
    CHECK(double{candidate.t} <= exact.t);
    return;
  }
  CHECK_FALSE(exact.opaque);
  CHECK(std::abs(double{candidate.barycentrics[0]} - exact.u) <= exact.uv_tolerance);
  CHECK(std::abs(double{candidate.barycentrics[1]} - exact.v) <= exact.uv_tolerance);
  CHECK(candidate.front_face == exact.front_face);
}

/// What a shader that decides by is_accepted does with a ray.
struct Outcome {
  std::set<Id> candidates;
  bool found = false;
  Hit committed = {};
};

Outcome query(const TopLevel& top_level, const Ray& ray, const ExactHits& exact) {
  Outcome outcome;
  rayQueryEXT query;
  initialize(query, top_level, ray);
  while (rayQueryProceedEXT(query)) {
    const Id id = id_of(query, false);
    CHECK(outcome.candidates.insert(id).second);
    const ExactHit* hit = find(exact, id);
    REQUIRE(hit != nullptr);
    check_candidate(query.candidate, *hit);
    const bool is_box = rayQueryGetIntersectionTypeEXT(query, false) == candidate_intersection_aabb;
    CHECK(rayQueryGetIntersectionCandidateAABBOpaqueEXT(query) == (is_box && hit->opaque));
    if (!is_accepted(id)) continue;
    if (is_box)
      rayQueryGenerateIntersectionEXT(query, generated_t(*hit));
    else
      rayQueryConfirmIntersectionEXT(query);
  }
  const uint type = rayQueryGetIntersectionTypeEXT(query, true);
  outcome.found = type != committed_intersection_none;
  if (!outcome.found) {
    CHECK(rayQueryGetIntersectionTEXT(query, true) == ray.t_max);
    return outcome;
  }
  // Before the rest is looked at: the getters find out what is not known yet.
  rayQueryGetIntersectionTEXT(query, true);
  outcome.committed = query.committed;
  CHECK((type == committed_intersection_generated) == outcome.committed.is_box);
  return outcome;
}

struct Visit {
  Outcome outcome;
  const ExactHits* exact;

  static const ExactHit* arrive(void* context, const Hit& hit) {
    Visit& self = *static_cast<Visit*>(context);
    const Id id = {hit.instance_index, hit.geometry_index, hit.primitive_index};
    CHECK(self.outcome.candidates.insert(id).second);
    const ExactHit* exact = find(*self.exact, id);
    CHECK(exact != nullptr);
    if (exact != nullptr) check_candidate(hit, *exact);
    return exact != nullptr && is_accepted(id) ? exact : nullptr;
  }
  static CandidateDecision triangle(void* context, const Hit& hit) {
    return arrive(context, hit) != nullptr ? CandidateDecision::commit : CandidateDecision::ignore;
  }
  static CandidateDecision box(void* context, Hit& hit, float t_max) {
    const ExactHit* exact = arrive(context, hit);
    if (exact == nullptr || !(generated_t(*exact) <= t_max)) return CandidateDecision::ignore;
    hit.t = generated_t(*exact);
    return CandidateDecision::commit;
  }
};

Outcome visit(const TopLevel& top_level, const Ray& ray, const ExactHits& exact) {
  if (!(ray.t_min < ray.t_max)) return {};
  Visit state{{}, &exact};
  const CandidateVisitor visitor = {&state, &Visit::triangle, &Visit::box};
  state.outcome.found = top_level.functions->visit(top_level, ray, visitor, state.outcome.committed);
  return state.outcome;
}

void check_outcome(const Outcome& outcome, const Ray& ray, const ExactHits& exact) {
  const auto nearest = std::min_element(exact.hits.begin(), exact.hits.end(),
                                        [](const auto& a, const auto& b) { return committed_t(a) < committed_t(b); });
  const bool any = nearest != exact.hits.end() && committed_t(*nearest) < INFINITY;
  CHECK(outcome.found == any);
  if (any && outcome.found) {
    const Hit& hit = outcome.committed;
    const ExactHit* committed = find(exact, {hit.instance_index, hit.geometry_index, hit.primitive_index});
    REQUIRE(committed != nullptr);
    CHECK(committed_t(*committed) < INFINITY);
    CHECK(hit.is_box == committed->is_box);
    if (hit.is_box) {
      CHECK(hit.t == generated_t(*committed));
    } else {
      CHECK(std::abs(double{hit.t} - committed->t) <= committed->t_tolerance);
      CHECK(std::abs(double{hit.barycentrics[0]} - committed->u) <= committed->uv_tolerance);
      CHECK(std::abs(double{hit.barycentrics[1]} - committed->v) <= committed->uv_tolerance);
      CHECK(hit.front_face == committed->front_face);
    }
    // Two hits that single precision cannot tell apart may be taken for each other.
    const bool tied = committed_t(*committed) - committed_t(*nearest) <= committed->t_tolerance + nearest->t_tolerance;
    if ((ray.flags & ray_flag_terminate_on_first_hit) == 0) CHECK((committed == &*nearest || tied));
  }
  if ((ray.flags & ray_flag_terminate_on_first_hit) != 0) return;
  for (const ExactHit& hit : exact.hits) {
    const bool clearly_nearer = !any || hit.t + hit.t_tolerance < committed_t(*nearest) - nearest->t_tolerance;
    if ((hit.is_box || !hit.opaque) && clearly_nearer) CHECK(outcome.candidates.count(id_of(hit)) == 1);
  }
}

/// Traces the ray as a query and as a visit, and compares everything that a shader could see.
void check_ray(const Soup& soup, const TopLevel& top_level, const Ray& ray, const ExactHits& exact) {
  const Outcome queried = query(top_level, ray, exact);
  check_outcome(queried, ray, exact);
  const Outcome visited = visit(top_level, ray, exact);
  check_outcome(visited, ray, exact);
  if (!queried.found || !visited.found || (ray.flags & ray_flag_terminate_on_first_hit) != 0) return;
  CHECK(queried.committed.t == visited.committed.t);
  CHECK(queried.committed.instance_index == visited.committed.instance_index);
  CHECK(queried.committed.geometry_index == visited.committed.geometry_index);
  CHECK(queried.committed.primitive_index == visited.committed.primitive_index);
  const Instance& instance = top_level.instances[queried.committed.instance_index];
  CHECK(instance.custom_index == soup.instances[queried.committed.instance_index].custom_index);
  CHECK(instance.sbt_offset == soup.instances[queried.committed.instance_index].sbt_offset);
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

TEST_CASE("a single instance of boxes at the origin agrees with brute force, alone and beside one of triangles") {
  const cpu::EmbreeDevice device;
  std::mt19937 random(24);
  for (const bool alone : {true, false}) {
    for (const std::uint32_t flags : {0u, 4u, 8u}) {
      Soup soup = random_soup(random, 4, 60);
      rhi::InstanceDesc boxes = instance_of(2);
      boxes.flags = flags & 0xFF;
      boxes.mask = 0x8F;
      soup.instances = {boxes};
      if (!alone) soup.instances.insert(soup.instances.begin(), instance_of(0));
      const BuiltSoup built = build(device, soup);
      CHECK(built.top_level.view().has_boxes);
      check_all_flags(soup, built.top_level.view(), random, 3);
    }
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

TEST_CASE("hits come in one order, however many are asked for at once, and end with an opaque triangle") {
  const cpu::EmbreeDevice device;
  std::mt19937 random(25);
  const Soup soup = random_soup(random, 3, 100);
  const BuiltSoup built = build(device, soup);
  const TopLevel& top_level = built.top_level.view();
  const auto enumerate = [&](const Ray& ray, std::uint32_t capacity) {
    std::vector<Hit> all;
    std::vector<Hit> hits(capacity);
    for (;;) {
      const std::uint32_t count =
          top_level.functions->next_hits(top_level, ray, all.empty() ? nullptr : &all.back(), hits.data(), capacity);
      REQUIRE(count <= capacity);
      all.insert(all.end(), hits.begin(), hits.begin() + count);
      for (std::uint32_t i = 0; i + 1 < count; ++i) CHECK((hits[i].is_box || !hits[i].opaque));
      if (count == 0) return all;
      if (count < capacity && (hits[count - 1].is_box || !hits[count - 1].opaque)) return all;
    }
  };
  std::size_t most = 0;
  for (int i = 0; i < 300; ++i) {
    const Ray ray = random_ray(random, i % 3 == 0 ? ray_flag_no_opaque : 0u, 0xFF);
    const std::vector<Hit> one_by_one = enumerate(ray, 1);
    most = std::max(most, one_by_one.size());
    for (const std::uint32_t capacity : {2u, 3u, 8u, 1000u}) {
      const std::vector<Hit> together = enumerate(ray, capacity);
      REQUIRE(together.size() == one_by_one.size());
      for (std::size_t k = 0; k < together.size(); ++k) {
        CHECK(together[k].t == one_by_one[k].t);
        CHECK(together[k].instance_index == one_by_one[k].instance_index);
        CHECK(together[k].geometry_index == one_by_one[k].geometry_index);
        CHECK(together[k].primitive_index == one_by_one[k].primitive_index);
        if (k > 0) CHECK(together[k].t >= together[k - 1].t);
      }
    }
  }
  CHECK(most >= 12);
}
