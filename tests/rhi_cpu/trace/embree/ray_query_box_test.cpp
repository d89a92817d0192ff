// What a ray query does with boxes, and with more candidates than it asks for at once.

#include <doctest/doctest.h>

#include <limits>
#include <vector>

#include "rhi_cpu/kernel/ray_query.hpp"
#include "tests/rhi_cpu/trace/embree/scripted_level.hpp"

using namespace tandem::kernel;
using namespace tandem::test;

namespace {

/// The primitive that Proceed stops at; -1 when it returns false.
int proceed(rayQueryEXT& query) {
  return rayQueryProceedEXT(query) ? rayQueryGetIntersectionPrimitiveIndexEXT(query, false) : -1;
}

struct Committed {
  uint type;
  float t;
  int primitive;
  bool operator==(const Committed&) const = default;
};

Committed committed(rayQueryEXT& query) {
  return {rayQueryGetIntersectionTypeEXT(query, true), rayQueryGetIntersectionTEXT(query, true),
          rayQueryGetIntersectionPrimitiveIndexEXT(query, true)};
}

Committed nothing() { return {committed_intersection_none, 100, 0}; }
Committed confirmed(float t, int primitive) { return {committed_intersection_triangle, t, primitive}; }
Committed generated(float t, int primitive) { return {committed_intersection_generated, t, primitive}; }

}  // namespace

TEST_CASE("a box is a candidate of its own type, opaque or not, and commits nothing by itself") {
  const ScriptedLevel level({box(1, 10, false), box(2, 20, true)});
  rayQueryEXT query;
  initialize(query, level);
  REQUIRE(proceed(query) == 10);
  CHECK(rayQueryGetIntersectionTypeEXT(query, false) == candidate_intersection_aabb);
  CHECK_FALSE(rayQueryGetIntersectionCandidateAABBOpaqueEXT(query));
  CHECK(rayQueryGetIntersectionTEXT(query, false) == 1);
  CHECK(rayQueryGetIntersectionGeometryIndexEXT(query, false) == 4);
  CHECK(rayQueryGetIntersectionInstanceIdEXT(query, false) == 1);
  CHECK(rayQueryGetIntersectionInstanceCustomIndexEXT(query, false) == 0xABCDEF);
  CHECK(rayQueryGetIntersectionObjectRayDirectionEXT(query, false) == vec3(2, 0.75f, -1.25f));
  REQUIRE(proceed(query) == 20);
  CHECK(rayQueryGetIntersectionCandidateAABBOpaqueEXT(query));
  CHECK(proceed(query) == -1);
  CHECK(committed(query) == nothing());
  CHECK(level.closest_calls + level.occluded_calls == 0);
}

TEST_CASE("a generated hit commits, with the getters of its box") {
  const ScriptedLevel level({box(1, 10)});
  rayQueryEXT query;
  initialize(query, level);
  REQUIRE(proceed(query) == 10);
  rayQueryGenerateIntersectionEXT(query, 3);
  CHECK(committed(query) == generated(3, 10));
  CHECK(rayQueryGetIntersectionGeometryIndexEXT(query, true) == 4);
  CHECK(rayQueryGetIntersectionInstanceIdEXT(query, true) == 1);
  CHECK(rayQueryGetIntersectionInstanceShaderBindingTableRecordOffsetEXT(query, true) == 22);
  CHECK(rayQueryGetIntersectionBarycentricsEXT(query, true) == vec2(0));
  CHECK_FALSE(rayQueryGetIntersectionFrontFaceEXT(query, true));
  CHECK(rayQueryGetIntersectionTEXT(query, false) == 1);
  CHECK(proceed(query) == -1);
  CHECK(committed(query) == generated(3, 10));
}

TEST_CASE("a hit is generated between t_min and the committed hit, both included, and nowhere else") {
  const ScriptedLevel level({box(1, 10)});
  rayQueryEXT query;
  initialize(query, level);
  REQUIRE(proceed(query) == 10);
  for (const float t :
       {0.25f, 100.5f, -1.0f, std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    rayQueryGenerateIntersectionEXT(query, t);
    CHECK(committed(query) == nothing());
  }
  rayQueryGenerateIntersectionEXT(query, 100);
  CHECK(committed(query) == generated(100, 10));
  rayQueryGenerateIntersectionEXT(query, 7);
  CHECK(committed(query) == generated(7, 10));
  rayQueryGenerateIntersectionEXT(query, 8);
  CHECK(committed(query) == generated(7, 10));
  rayQueryGenerateIntersectionEXT(query, 0.5f);
  CHECK(committed(query) == generated(0.5f, 10));
  CHECK(proceed(query) == -1);
}

TEST_CASE("behind a generated hit the search goes on with what begins in front of it") {
  rayQueryEXT query;
  SUBCASE("other boxes, of which one has the closer hit") {
    const ScriptedLevel level({box(1, 10), box(2, 20), box(3, 30), box(5, 40), box(7, 50)});
    initialize(query, level);
    REQUIRE(proceed(query) == 10);
    rayQueryGenerateIntersectionEXT(query, 6);
    REQUIRE(proceed(query) == 20);
    rayQueryGenerateIntersectionEXT(query, 6.5f);  // behind
    CHECK(committed(query) == generated(6, 10));
    REQUIRE(proceed(query) == 30);
    rayQueryGenerateIntersectionEXT(query, 4);
    CHECK(proceed(query) == -1);
    CHECK(committed(query) == generated(4, 30));
  }
  SUBCASE("triangles") {
    const ScriptedLevel level({box(1, 10), triangle(2, 20, false), triangle(3, 30, true), box(4, 40)});
    initialize(query, level);
    REQUIRE(proceed(query) == 10);
    rayQueryGenerateIntersectionEXT(query, 6);
    REQUIRE(proceed(query) == 20);
    rayQueryGenerateIntersectionEXT(query, 1.5f);  // not for a triangle
    CHECK(committed(query) == generated(6, 10));
    CHECK(proceed(query) == -1);
    CHECK(committed(query) == confirmed(3, 30));
  }
  SUBCASE("a triangle that is confirmed ends it") {
    const ScriptedLevel level({box(1, 10), triangle(2, 20, false), box(2, 30)});
    initialize(query, level);
    REQUIRE(proceed(query) == 10);
    rayQueryConfirmIntersectionEXT(query);  // not for a box
    CHECK(committed(query) == nothing());
    rayQueryGenerateIntersectionEXT(query, 6);
    REQUIRE(proceed(query) == 20);
    rayQueryConfirmIntersectionEXT(query);
    CHECK(committed(query) == confirmed(2, 20));
    CHECK(proceed(query) == -1);
  }
  SUBCASE("what lies at its t is not in front of it") {
    const ScriptedLevel level({box(1, 10), triangle(4, 20, true), box(4, 30)});
    initialize(query, level);
    REQUIRE(proceed(query) == 10);
    rayQueryGenerateIntersectionEXT(query, 4);
    CHECK(proceed(query) == -1);
    CHECK(committed(query) == generated(4, 10));
  }
}

TEST_CASE("terminate keeps a generated hit, and with terminate-on-first-hit the first one ends the search") {
  const ScriptedLevel level({box(1, 10), box(2, 20)});
  rayQueryEXT query;
  initialize(query, level);
  REQUIRE(proceed(query) == 10);
  rayQueryGenerateIntersectionEXT(query, 6);
  SUBCASE("terminated") {
    rayQueryTerminateEXT(query);
    CHECK(proceed(query) == -1);
    CHECK(committed(query) == generated(6, 10));
  }
  SUBCASE("terminated with the candidate still at hand") {
    rayQueryTerminateEXT(query);
    rayQueryGenerateIntersectionEXT(query, 5);
    CHECK(proceed(query) == -1);
    CHECK(committed(query) == generated(5, 10));
    rayQueryGenerateIntersectionEXT(query, 4);
    CHECK(committed(query) == generated(5, 10));
  }
  SUBCASE("not terminated") { CHECK(proceed(query) == 20); }
  SUBCASE("the flag") {
    initialize(query, level, ray_flag_terminate_on_first_hit);
    REQUIRE(proceed(query) == 10);
    REQUIRE(proceed(query) == 20);
    rayQueryGenerateIntersectionEXT(query, 6);
    CHECK(proceed(query) == -1);
    CHECK(committed(query) == generated(6, 20));
  }
}

TEST_CASE("flags decide whether boxes make a query look for candidates") {
  const ScriptedLevel level({box(1, 10), triangle(2, 20, true)});
  rayQueryEXT query;
  const auto asks_for_candidates = [&](uint flags) {
    level.next_calls = level.closest_calls = level.occluded_calls = 0;
    initialize(query, level, flags);
    rayQueryProceedEXT(query);
    CHECK(level.next_calls + level.closest_calls + level.occluded_calls <= 1);
    return level.next_calls == 1;
  };
  for (const uint flags : {0u, 1u, 2u, 4u, 0x40u, 0x80u, 0x100u}) CHECK(asks_for_candidates(flags));
  for (const uint flags : {0x200u, 0x201u, 0x204u, 0x240u, 0x280u, 0x300u}) CHECK_FALSE(asks_for_candidates(flags));
  CHECK(asks_for_candidates(ray_flag_skip_aabbs | ray_flag_no_opaque));
  initialize(query, level, ray_flag_skip_aabbs);
  CHECK(proceed(query) == -1);
  CHECK(committed(query) == confirmed(2, 20));
  initialize(query, level, ray_flag_skip_aabbs | ray_flag_skip_triangles);
  level.next_calls = level.closest_calls = 0;
  CHECK(proceed(query) == -1);
  CHECK(level.next_calls + level.closest_calls == 0);
}

TEST_CASE("any number of candidates comes in order, without one twice") {
  std::vector<Hit> script;
  for (std::uint32_t i = 0; i < 4 * hits_at_once; ++i) {
    const float t = 1 + static_cast<float>(i / 3);  // three of each t
    script.push_back(i % 3 == 1 ? box(t, i) : triangle(t, i, false));
    const ScriptedLevel level(script);
    rayQueryEXT query;
    initialize(query, level);
    for (std::uint32_t k = 0; k <= i; ++k) REQUIRE(proceed(query) == static_cast<int>(k));
    CHECK(proceed(query) == -1);
    CHECK(proceed(query) == -1);
    CHECK(committed(query) == nothing());
    CHECK(level.next_calls == static_cast<int>((i + 1) / hits_at_once) + 1);
  }
}

TEST_CASE("two queries in the middle of their candidates do not disturb each other, nor does a copy") {
  const ScriptedLevel first({triangle(1, 1, false), box(2, 2), triangle(3, 3, false)});
  const ScriptedLevel second({box(1, 11), triangle(2, 12, false), box(3, 13)});
  rayQueryEXT a, b;
  initialize(a, first);
  initialize(b, second);
  CHECK(proceed(a) == 1);
  CHECK(proceed(b) == 11);
  rayQueryGenerateIntersectionEXT(b, 2.5f);
  rayQueryEXT copy = b;
  CHECK(proceed(a) == 2);
  CHECK(proceed(b) == 12);
  rayQueryConfirmIntersectionEXT(b);
  CHECK(proceed(a) == 3);
  CHECK(proceed(b) == -1);
  CHECK(proceed(a) == -1);
  CHECK(committed(a) == nothing());
  CHECK(committed(b) == confirmed(2, 12));
  CHECK(proceed(copy) == 12);
  CHECK(proceed(copy) == -1);
  CHECK(committed(copy) == generated(2.5f, 11));
}
