#include "rhi_cpu/kernel/ray_query.hpp"

#include <doctest/doctest.h>

#include <limits>

#include "tests/rhi_cpu/trace/embree/scripted_level.hpp"

using namespace tandem::kernel;
using namespace tandem::test;

TEST_CASE("an opaque scene is one closest-hit call and never a candidate") {
  const ScriptedLevel level({triangle(7, 42, true)});
  rayQueryEXT query;
  initialize(query, level);
  CHECK(level.closest_calls == 0);
  CHECK_FALSE(rayQueryProceedEXT(query));
  CHECK(level.closest_calls == 1);
  CHECK(level.occluded_calls == 0);
  CHECK(level.next_calls == 0);
  CHECK(rayQueryGetIntersectionTypeEXT(query, true) == committed_intersection_triangle);
  CHECK(rayQueryGetIntersectionTEXT(query, true) == 7);
  CHECK(rayQueryGetIntersectionPrimitiveIndexEXT(query, true) == 42);
  CHECK(rayQueryGetIntersectionGeometryIndexEXT(query, true) == 3);
  CHECK(rayQueryGetIntersectionInstanceIdEXT(query, true) == 1);
  CHECK(rayQueryGetIntersectionBarycentricsEXT(query, true) == vec2(0.25f, 0.5f));
  CHECK(rayQueryGetIntersectionFrontFaceEXT(query, true));
  CHECK(level.closest_calls == 1);
}

TEST_CASE("the ray reaches the scene as the shader gave it, with 8 bits of mask") {
  const ScriptedLevel level({});
  rayQueryEXT query;
  rayQueryInitializeEXT(query, level.handle(), ray_flag_opaque, 0xABCDEF12, vec3(1, 2, 3), 0.5f, vec3(4, 5, 6), 100.0f);
  CHECK_FALSE(rayQueryProceedEXT(query));
  CHECK(level.last_ray.origin[0] == 1);
  CHECK(level.last_ray.origin[1] == 2);
  CHECK(level.last_ray.origin[2] == 3);
  CHECK(level.last_ray.t_min == 0.5f);
  CHECK(level.last_ray.direction[0] == 4);
  CHECK(level.last_ray.direction[1] == 5);
  CHECK(level.last_ray.direction[2] == 6);
  CHECK(level.last_ray.t_max == 100);
  CHECK(level.last_ray.flags == ray_flag_opaque);
  CHECK(level.last_ray.mask == 0x12);
  CHECK(rayQueryGetRayTMinEXT(query) == 0.5f);
  CHECK(rayQueryGetRayFlagsEXT(query) == ray_flag_opaque);
  CHECK(rayQueryGetWorldRayOriginEXT(query) == vec3(1, 2, 3));
  CHECK(rayQueryGetWorldRayDirectionEXT(query) == vec3(4, 5, 6));
}

TEST_CASE("a miss leaves no committed hit and t at t_max") {
  const ScriptedLevel level({});
  rayQueryEXT query;
  initialize(query, level);
  CHECK_FALSE(rayQueryProceedEXT(query));
  CHECK(rayQueryGetIntersectionTypeEXT(query, true) == committed_intersection_none);
  CHECK(rayQueryGetIntersectionTEXT(query, true) == 100);
  CHECK(rayQueryGetIntersectionInstanceCustomIndexEXT(query, true) == 0);
  CHECK(rayQueryGetIntersectionInstanceIdEXT(query, true) == 0);
  CHECK(rayQueryGetIntersectionObjectToWorldEXT(query, true) == mat4x3(0.0f));
}

TEST_CASE("a ray that stops at the first hit asks for occlusion, and for the hit only when a getter wants it") {
  const ScriptedLevel level({triangle(7, 42, true)});
  rayQueryEXT query;
  initialize(query, level, ray_flag_terminate_on_first_hit | ray_flag_skip_closest_hit_shader);
  CHECK_FALSE(rayQueryProceedEXT(query));
  CHECK(rayQueryGetIntersectionTypeEXT(query, true) == committed_intersection_triangle);
  CHECK(level.occluded_calls == 1);
  CHECK(level.closest_calls == 0);
  CHECK(rayQueryGetIntersectionTEXT(query, true) == 7);
  CHECK(rayQueryGetIntersectionPrimitiveIndexEXT(query, true) == 42);
  CHECK(rayQueryGetIntersectionInstanceCustomIndexEXT(query, true) == 0xABCDEF);
  CHECK(level.closest_calls == 1);

  const ScriptedLevel empty({});
  initialize(query, empty, ray_flag_terminate_on_first_hit);
  CHECK_FALSE(rayQueryProceedEXT(query));
  CHECK(rayQueryGetIntersectionTypeEXT(query, true) == committed_intersection_none);
  CHECK(rayQueryGetIntersectionTEXT(query, true) == 100);
  CHECK(empty.closest_calls == 0);
}

TEST_CASE("candidates are offered one by one, and an opaque hit ends the search") {
  const ScriptedLevel level(
      {triangle(1, 10, false), triangle(2, 20, false), triangle(3, 30, true), triangle(4, 40, false)});
  rayQueryEXT query;
  initialize(query, level);
  REQUIRE(rayQueryProceedEXT(query));
  CHECK(rayQueryGetIntersectionTypeEXT(query, false) == 0);
  CHECK(rayQueryGetIntersectionTypeEXT(query, true) == committed_intersection_none);
  CHECK(rayQueryGetIntersectionPrimitiveIndexEXT(query, false) == 10);
  CHECK(rayQueryGetIntersectionTEXT(query, false) == 1);
  REQUIRE(rayQueryProceedEXT(query));
  CHECK(rayQueryGetIntersectionPrimitiveIndexEXT(query, false) == 20);
  CHECK_FALSE(rayQueryProceedEXT(query));
  CHECK(rayQueryGetIntersectionTypeEXT(query, true) == committed_intersection_triangle);
  CHECK(rayQueryGetIntersectionPrimitiveIndexEXT(query, true) == 30);
  CHECK(rayQueryGetIntersectionTEXT(query, true) == 3);
  CHECK_FALSE(rayQueryProceedEXT(query));
  CHECK(level.next_calls == 1);
  CHECK(level.closest_calls == 0);
  CHECK(level.occluded_calls == 0);
}

TEST_CASE("a confirmed candidate is committed at once, and nothing farther is offered") {
  const ScriptedLevel level({triangle(1, 10, false), triangle(2, 20, false), triangle(3, 30, false)});
  rayQueryEXT query;
  initialize(query, level);
  REQUIRE(rayQueryProceedEXT(query));
  REQUIRE(rayQueryProceedEXT(query));
  rayQueryConfirmIntersectionEXT(query);
  CHECK(rayQueryGetIntersectionTypeEXT(query, true) == committed_intersection_triangle);
  CHECK(rayQueryGetIntersectionPrimitiveIndexEXT(query, true) == 20);
  rayQueryConfirmIntersectionEXT(query);
  CHECK_FALSE(rayQueryProceedEXT(query));
  CHECK_FALSE(rayQueryProceedEXT(query));
  CHECK(rayQueryGetIntersectionPrimitiveIndexEXT(query, true) == 20);
  CHECK(rayQueryGetIntersectionTEXT(query, true) == 2);
}

TEST_CASE("candidates that are never confirmed leave no committed hit") {
  const ScriptedLevel level({triangle(1, 10, false), triangle(2, 20, false)});
  rayQueryEXT query;
  initialize(query, level);
  int candidates = 0;
  while (rayQueryProceedEXT(query)) ++candidates;
  CHECK(candidates == 2);
  CHECK(rayQueryGetIntersectionTypeEXT(query, true) == committed_intersection_none);
  CHECK(rayQueryGetIntersectionTEXT(query, true) == 100);
}

TEST_CASE("terminate keeps what is committed and ends the search") {
  const ScriptedLevel level({triangle(1, 10, false), triangle(2, 20, true)});
  rayQueryEXT query;
  SUBCASE("without a confirmation") {
    initialize(query, level);
    REQUIRE(rayQueryProceedEXT(query));
    rayQueryTerminateEXT(query);
    CHECK_FALSE(rayQueryProceedEXT(query));
    CHECK(rayQueryGetIntersectionTypeEXT(query, true) == committed_intersection_none);
  }
  SUBCASE("after one") {
    initialize(query, level);
    REQUIRE(rayQueryProceedEXT(query));
    rayQueryConfirmIntersectionEXT(query);
    rayQueryTerminateEXT(query);
    CHECK_FALSE(rayQueryProceedEXT(query));
    CHECK(rayQueryGetIntersectionPrimitiveIndexEXT(query, true) == 10);
  }
  SUBCASE("before the first Proceed") {
    initialize(query, level);
    rayQueryTerminateEXT(query);
    CHECK_FALSE(rayQueryProceedEXT(query));
    CHECK(level.next_calls == 0);
  }
}

TEST_CASE("ray flags decide whether there can be candidates") {
  const ScriptedLevel opaque({triangle(1, 10, true)});
  const ScriptedLevel mixed({triangle(1, 10, false)});
  rayQueryEXT query;
  const auto uses_candidates = [&query](const ScriptedLevel& level, uint flags) {
    initialize(query, level, flags);
    rayQueryProceedEXT(query);
    CHECK(level.next_calls + level.closest_calls == 1);
    const bool result = level.next_calls == 1;
    level.next_calls = level.closest_calls = 0;
    return result;
  };
  CHECK_FALSE(uses_candidates(opaque, 0));
  CHECK_FALSE(uses_candidates(opaque, ray_flag_opaque));
  CHECK(uses_candidates(opaque, ray_flag_no_opaque));
  CHECK_FALSE(uses_candidates(opaque, ray_flag_cull_no_opaque));
  CHECK(uses_candidates(mixed, 0));
  CHECK(uses_candidates(mixed, ray_flag_cull_opaque));
  CHECK_FALSE(uses_candidates(mixed, ray_flag_opaque));
  CHECK_FALSE(uses_candidates(mixed, ray_flag_cull_no_opaque));
}

TEST_CASE("rays that can meet nothing do not reach the scene") {
  const ScriptedLevel level({triangle(1, 10, true)});
  const float nan = std::numeric_limits<float>::quiet_NaN();
  rayQueryEXT query;
  const auto traces = [&](accelerationStructureEXT structure, uint flags, uint mask, float t_min, float t_max) {
    rayQueryInitializeEXT(query, structure, flags, mask, vec3(0), t_min, vec3(0, 0, 1), t_max);
    CHECK_FALSE(rayQueryProceedEXT(query));
    return level.closest_calls > 0;
  };
  CHECK_FALSE(traces({}, 0, 0xFF, 0, 1));
  CHECK_FALSE(traces(level.handle(), ray_flag_skip_triangles, 0xFF, 0, 1));
  CHECK_FALSE(traces(level.handle(), 0, 0, 0, 1));
  CHECK_FALSE(traces(level.handle(), 0, 0x100, 0, 1));
  CHECK_FALSE(traces(level.handle(), 0, 0xFF, 2, 1));
  CHECK_FALSE(traces(level.handle(), 0, 0xFF, 1, 1));
  CHECK_FALSE(traces(level.handle(), 0, 0xFF, nan, 1));
  CHECK_FALSE(traces(level.handle(), 0, 0xFF, 0, nan));
  CHECK(rayQueryGetIntersectionTypeEXT(query, true) == committed_intersection_none);
  CHECK(traces(level.handle(), 0, 0xFF, 0, 1));
}

TEST_CASE("misuse is harmless") {
  rayQueryEXT query;
  CHECK_FALSE(rayQueryProceedEXT(query));
  rayQueryConfirmIntersectionEXT(query);
  rayQueryTerminateEXT(query);
  for (const bool committed : {false, true}) {
    CHECK(rayQueryGetIntersectionTypeEXT(query, committed) == 0);
    CHECK(rayQueryGetIntersectionTEXT(query, committed) == 0);
    CHECK(rayQueryGetIntersectionInstanceCustomIndexEXT(query, committed) == 0);
    CHECK(rayQueryGetIntersectionInstanceIdEXT(query, committed) == 0);
    CHECK(rayQueryGetIntersectionInstanceShaderBindingTableRecordOffsetEXT(query, committed) == 0);
    CHECK(rayQueryGetIntersectionGeometryIndexEXT(query, committed) == 0);
    CHECK(rayQueryGetIntersectionPrimitiveIndexEXT(query, committed) == 0);
    CHECK(rayQueryGetIntersectionBarycentricsEXT(query, committed) == vec2(0));
    CHECK_FALSE(rayQueryGetIntersectionFrontFaceEXT(query, committed));
    CHECK(rayQueryGetIntersectionObjectRayDirectionEXT(query, committed) == vec3(0));
    CHECK(rayQueryGetIntersectionObjectRayOriginEXT(query, committed) == vec3(0));
    CHECK(rayQueryGetIntersectionObjectToWorldEXT(query, committed) == mat4x3(0.0f));
    CHECK(rayQueryGetIntersectionWorldToObjectEXT(query, committed) == mat4x3(0.0f));
  }

  const ScriptedLevel level({triangle(1, 10, false)});
  initialize(query, level);
  rayQueryConfirmIntersectionEXT(query);
  CHECK(rayQueryGetIntersectionTypeEXT(query, true) == committed_intersection_none);
  REQUIRE(rayQueryProceedEXT(query));
  CHECK_FALSE(rayQueryProceedEXT(query));
  rayQueryConfirmIntersectionEXT(query);
  CHECK(rayQueryGetIntersectionTypeEXT(query, true) == committed_intersection_none);
}

TEST_CASE("a query can be initialised again, and forgets") {
  const ScriptedLevel first({triangle(1, 10, false)});
  const ScriptedLevel second({});
  rayQueryEXT query;
  initialize(query, first);
  REQUIRE(rayQueryProceedEXT(query));
  rayQueryConfirmIntersectionEXT(query);
  initialize(query, second);
  CHECK(rayQueryGetIntersectionTypeEXT(query, true) == committed_intersection_none);
  CHECK_FALSE(rayQueryProceedEXT(query));
  CHECK(rayQueryGetIntersectionTEXT(query, true) == 100);
}

TEST_CASE("the getters of the instance") {
  const ScriptedLevel level({triangle(1, 10, false)});
  rayQueryEXT query;
  initialize(query, level);
  REQUIRE(rayQueryProceedEXT(query));
  rayQueryConfirmIntersectionEXT(query);
  for (const bool committed : {false, true}) {
    CHECK(rayQueryGetIntersectionInstanceCustomIndexEXT(query, committed) == 0xABCDEF);
    CHECK(rayQueryGetIntersectionInstanceShaderBindingTableRecordOffsetEXT(query, committed) == 22);
    // Column by column: x goes to 2x + 10, y to -4z + 20, z to 8y + 30.
    const mat4x3 to_world(vec3(2, 0, 0), vec3(0, 0, 8), vec3(0, -4, 0), vec3(10, 20, 30));
    CHECK(rayQueryGetIntersectionObjectToWorldEXT(query, committed) == to_world);
    const mat4x3 to_object(vec3(0.5f, 0, 0), vec3(0, 0, -0.25f), vec3(0, 0.125f, 0), vec3(-5, -3.75f, 5));
    CHECK(rayQueryGetIntersectionWorldToObjectEXT(query, committed) == to_object);
    // The origin (1, 2, 3) and the direction (4, 5, 6) under it; every value is exact in binary.
    CHECK(rayQueryGetIntersectionObjectRayOriginEXT(query, committed) == vec3(-4.5f, -3.375f, 4.5f));
    CHECK(rayQueryGetIntersectionObjectRayDirectionEXT(query, committed) == vec3(2, 0.75f, -1.25f));
  }
}
