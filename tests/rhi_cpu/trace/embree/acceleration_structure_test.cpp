#include "rhi_cpu/trace/embree/acceleration_structure.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <string>

#include "rhi/error.hpp"
#include "rhi_cpu/kernel/ray_query.hpp"
#include "tests/rhi_cpu/trace/embree/brute_force.hpp"
#include "tests/support/few_ulp.hpp"

using namespace tandem;
using namespace tandem::kernel;
using namespace tandem::test;

namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr float not_a_number = std::numeric_limits<float>::quiet_NaN();

/// Counter-clockwise seen from +z: its normal is +z.
const Triangle unit_triangle = {0, 0, 0, 1, 0, 0, 0, 1, 0};

Soup one_triangle(bool opaque = true) { return {{{SoupGeometry{{unit_triangle}, opaque}}}, {instance_of(0)}}; }

/// Traces, and confirms every candidate.
rayQueryEXT trace(const cpu::TopLevel& top_level, vec3 origin, vec3 direction, uint flags = 0, float t_min = 0,
                  float t_max = infinity) {
  rayQueryEXT query;
  rayQueryInitializeEXT(query, {&top_level.view()}, flags, 0xFF, origin, t_min, direction, t_max);
  while (rayQueryProceedEXT(query)) rayQueryConfirmIntersectionEXT(query);
  return query;
}

bool is_hit(rayQueryEXT query) {
  return rayQueryGetIntersectionTypeEXT(query, true) == committed_intersection_triangle;
}

/// From z = `height` along z onto the middle of the unit triangle.
rayQueryEXT look_down(const cpu::TopLevel& top_level, uint flags = 0) {
  return trace(top_level, vec3(0.25f, 0.25f, 2), vec3(0, 0, -1), flags);
}
rayQueryEXT look_up(const cpu::TopLevel& top_level, uint flags = 0) {
  return trace(top_level, vec3(0.25f, 0.25f, -2), vec3(0, 0, 1), flags);
}

bool has_barycentrics(rayQueryEXT query, float u, float v) {
  const vec2 found = rayQueryGetIntersectionBarycentricsEXT(query, true);
  return within_few_ulp(found.x, u) && within_few_ulp(found.y, v);
}

std::string error_of(const auto& action) {
  try {
    action();
  } catch (const rhi::Error& error) {
    return error.what();
  }
  return "";
}

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace

TEST_CASE("the face whose normal points against the ray is the front, in object space") {
  const cpu::EmbreeDevice device;
  Soup soup = one_triangle();
  rhi::InstanceDesc& instance = soup.instances[0];
  const auto fronts = [&] {
    const BuiltSoup built = build(device, soup);
    rayQueryEXT down = look_down(built.top_level), up = look_up(built.top_level);
    REQUIRE(is_hit(down));
    REQUIRE(is_hit(up));
    return std::pair(rayQueryGetIntersectionFrontFaceEXT(down, true), rayQueryGetIntersectionFrontFaceEXT(up, true));
  };
  CHECK(fronts() == std::pair(true, false));
  SUBCASE("flipped by the instance's flag") {
    instance.flags = 2;
    CHECK(fronts() == std::pair(false, true));
  }
  SUBCASE("not by an instance transform that mirrors within the plane") {
    instance.object_to_world[0][0] = 0;
    instance.object_to_world[0][1] = 1;
    instance.object_to_world[1][0] = 1;
    instance.object_to_world[1][1] = 0;
    CHECK(fronts() == std::pair(true, false));
  }
  SUBCASE("nor along the ray, where object space sees the ray from the other side") {
    instance.object_to_world[2][2] = -1;
    CHECK(fronts() == std::pair(false, true));
  }
}

TEST_CASE("a geometry transform moves the vertices and with them the winding") {
  const cpu::EmbreeDevice device;
  const std::array<float, 12> swap_xy = {0, 1, 0, 0, 1, 0, 0, 0, 0, 0, 1, 0.5f};
  const cpu::TriangleInput input{.vertices = std::as_bytes(std::span(unit_triangle)),
                                 .vertex_count = 3,
                                 .triangle_count = 1,
                                 .transform = swap_xy};
  const cpu::BottomLevel bottom_level =
      cpu::BottomLevel::build(device, std::vector<cpu::GeometryInput>{input}, rhi::BuildFlags::none, "swapped");
  const rhi::InstanceDesc instance = instance_of(0);
  const cpu::TopLevel top_level = cpu::TopLevel::build(
      device, {&instance, 1}, [&](std::uint64_t) { return &bottom_level; }, rhi::BuildFlags::none, "swapped");
  rayQueryEXT down = trace(top_level, vec3(0.5f, 0.125f, 2), vec3(0, 0, -1));
  REQUIRE(is_hit(down));
  CHECK_FALSE(rayQueryGetIntersectionFrontFaceEXT(down, true));
  CHECK(within_few_ulp(rayQueryGetIntersectionTEXT(down, true), 1.5f));
  // The second vertex, (1, 0), went to (0, 1): its weight is the y of the hit point.
  CHECK(has_barycentrics(down, 0.125f, 0.5f));
}

TEST_CASE("both ends of the ray are excluded, to the last bit of the t that is reported") {
  const cpu::EmbreeDevice device;
  for (const bool opaque : {true, false}) {
    const BuiltSoup built = build(device, one_triangle(opaque));
    for (const uint flags : {0u, 4u, 0x10u, 0x14u}) {
      CAPTURE(flags);
      const auto hits = [&](float t_min, float t_max) {
        return is_hit(trace(built.top_level, vec3(0.25f, 0.25f, 2), vec3(0, 0, -2), flags, t_min, t_max));
      };
      rayQueryEXT whole = trace(built.top_level, vec3(0.25f, 0.25f, 2), vec3(0, 0, -2), flags);
      REQUIRE(is_hit(whole));
      const float t = rayQueryGetIntersectionTEXT(whole, true);
      CHECK(within_few_ulp(t, 1));
      const float before = std::nextafter(t, 0.0f), after = std::nextafter(t, 2.0f);
      CHECK(hits(0, infinity));
      CHECK(hits(0, after));
      CHECK_FALSE(hits(0, t));
      CHECK_FALSE(hits(0, before));
      CHECK(hits(before, 2));
      CHECK_FALSE(hits(t, 2));
      CHECK_FALSE(hits(after, 2));
      CHECK(hits(before, after));
      CHECK_FALSE(hits(2, 0.5f));
      // From the surface itself, t is 0, which is not above a t_min of 0.
      CHECK_FALSE(is_hit(trace(built.top_level, vec3(0.25f, 0.25f, 0), vec3(0, 0, -1), flags)));
    }
  }
}

TEST_CASE("t counts in lengths of the direction, whatever the instance scales") {
  const cpu::EmbreeDevice device;
  Soup soup = one_triangle();
  for (int axis = 0; axis < 3; ++axis) soup.instances[0].object_to_world[axis][axis] = 8;
  soup.instances[0].object_to_world[2][3] = -3;
  const BuiltSoup built = build(device, soup);
  rayQueryEXT query = trace(built.top_level, vec3(2, 4, 5), vec3(0, 0, -0.5f));
  REQUIRE(is_hit(query));
  CHECK(within_few_ulp(rayQueryGetIntersectionTEXT(query, true), 16));
  CHECK(has_barycentrics(query, 0.25f, 0.5f));
  CHECK(rayQueryGetIntersectionObjectRayOriginEXT(query, true) == vec3(0.25f, 0.5f, 1));
  CHECK(rayQueryGetIntersectionObjectRayDirectionEXT(query, true) == vec3(0, 0, -0.0625f));
  CHECK(rayQueryGetIntersectionWorldToObjectEXT(query, true)[3] == vec3(0, 0, 0.375f));
}

TEST_CASE("positions of 16 bits, in strides, are decoded exactly") {
  // The same triangle (0, 0), (1, 0), (0, 1) at the height z, in records of five values of which three are a position.
  const auto hit_at = [](rhi::VertexFormat format, const std::array<std::uint16_t, 3>& zero_one_z) {
    const auto [zero, one, z] = zero_one_z;
    const std::uint16_t vertices[3][5] = {{zero, zero, z}, {one, zero, z}, {zero, one, z}};
    const cpu::EmbreeDevice device;
    const cpu::TriangleInput input{.vertices = std::as_bytes(std::span(vertices)),
                                   .vertex_count = 3,
                                   .vertex_stride = 10,
                                   .vertex_format = format,
                                   .triangle_count = 1};
    const cpu::BottomLevel bottom_level =
        cpu::BottomLevel::build(device, std::vector<cpu::GeometryInput>{input}, rhi::BuildFlags::none, "short");
    const rhi::InstanceDesc instance = instance_of(0);
    const cpu::TopLevel top_level = cpu::TopLevel::build(
        device, {&instance, 1}, [&](std::uint64_t) { return &bottom_level; }, rhi::BuildFlags::none, "short");
    rayQueryEXT query = trace(top_level, vec3(0.25f, 0.5f, 0), vec3(0, 0, 1));
    if (!is_hit(query)) query = trace(top_level, vec3(0.25f, 0.5f, 0), vec3(0, 0, -1));
    REQUIRE(is_hit(query));
    // A component other than 0 or 1 would move these.
    CHECK(has_barycentrics(query, 0.25f, 0.5f));
    const float t = rayQueryGetIntersectionTEXT(query, true);
    return rayQueryGetIntersectionFrontFaceEXT(query, true) ? -t : t;
  };
  using enum rhi::VertexFormat;
  CHECK(within_few_ulp(hit_at(half3, {0, 0x3C00, 0x4248}), 3.140625f));
  CHECK(within_few_ulp(hit_at(half3, {0x8000, 0x3C00, 0xC000}), -2));
  CHECK(within_few_ulp(hit_at(half3, {0, 0x3C00, 0x0001}), 0x1p-24f));  // subnormal
  CHECK(within_few_ulp(hit_at(half3, {0, 0x3C00, 0x7BFF}), 65504));
  CHECK(within_few_ulp(hit_at(snorm3, {0, 32767, 0x8000}), -1));
  CHECK(within_few_ulp(hit_at(snorm3, {0, 32767, 0x8001}), -1));
  CHECK(within_few_ulp(hit_at(snorm3, {0, 32767, 16384}), 16384.0f / 32767.0f));
}

TEST_CASE("index formats, strides and index gaps") {
  const cpu::EmbreeDevice device;
  // Two triangles over (0, 0) to (1, 1), in vertices of 20 bytes behind one that nothing uses.
  const float vertices[5][5] = {{9, 9, 9}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}};
  const std::uint16_t short_indices[] = {1, 2, 3, 2, 4, 3};
  const std::uint32_t long_indices[] = {1, 2, 3, 2, 4, 3};
  cpu::TriangleInput input{.vertices = std::as_bytes(std::span(vertices)).first(4 * 20 + 12),
                           .vertex_count = 5,
                           .vertex_stride = 20,
                           .triangle_count = 2};
  SUBCASE("16 bits") {
    input.indices = std::as_bytes(std::span(short_indices));
    input.index_format = rhi::IndexFormat::uint16;
  }
  SUBCASE("32 bits") {
    input.indices = std::as_bytes(std::span(long_indices));
    input.index_format = rhi::IndexFormat::uint32;
  }
  // Geometry 0 is empty: it keeps its place.
  const cpu::GeometryInput inputs[] = {cpu::TriangleInput{}, input};
  const cpu::BottomLevel bottom_level = cpu::BottomLevel::build(device, inputs, rhi::BuildFlags::none, "indexed");
  const rhi::InstanceDesc instance = instance_of(0);
  const cpu::TopLevel top_level = cpu::TopLevel::build(
      device, {&instance, 1}, [&](std::uint64_t) { return &bottom_level; }, rhi::BuildFlags::none, "indexed");
  rayQueryEXT query = trace(top_level, vec3(0.25f, 0.25f, 1), vec3(0, 0, -1));
  CHECK(is_hit(query));
  CHECK(rayQueryGetIntersectionGeometryIndexEXT(query, true) == 1);
  CHECK(rayQueryGetIntersectionPrimitiveIndexEXT(query, true) == 0);
  query = trace(top_level, vec3(0.75f, 0.75f, 1), vec3(0, 0, -1));
  CHECK(is_hit(query));
  CHECK(rayQueryGetIntersectionPrimitiveIndexEXT(query, true) == 1);
}

TEST_CASE(
    "triangles without area or with vertices that are not finite are never hit, and the others keep their index") {
  const cpu::EmbreeDevice device;
  SoupGeometry geometry;
  geometry.triangles = {
      {0.25f, 0.25f, 1, 0.25f, 0.25f, 1, 0.25f, 0.25f, 1},           // a point under the ray
      {0, 0, 1, 0.25f, 0.25f, 1, 0.75f, 0.75f, 1},                   // a line through it
      {not_a_number, 0, 1, 1, 0, 1, 0, 1, 1},                        //
      {0, 0, 1, 1, not_a_number, 1, 0, 1, 1},                        //
      {0, 0, not_a_number, 1, 0, not_a_number, 0, 1, not_a_number},  //
      {0, 0, 1, infinity, 0, 1, 0, 1, 1},                            //
      {0, 0, 1, 1, 0, 1, 0, -infinity, 1},                           //
      {-3e38f, -3e38f, 1, 3e38f, -3e38f, 1, 0, 3e38f, 1},            // beyond Embree's range
      unit_triangle,
  };
  for (const bool opaque : {true, false}) {
    geometry.opaque = opaque;
    Soup soup{{{geometry}}, {instance_of(0)}};
    for (int level = 0; level < 2; ++level) {
      const BuiltSoup built = build(device, soup);
      rayQueryEXT query = look_down(built.top_level);
      REQUIRE(is_hit(query));
      CHECK(rayQueryGetIntersectionPrimitiveIndexEXT(query, true) == 8);
      CHECK(within_few_ulp(rayQueryGetIntersectionTEXT(query, true), 2));
      soup.instances.push_back(instance_of(0));  // the second time with an instance level
    }
  }
}

TEST_CASE("instances with an address of 0, or a transform that has no inverse, are inactive") {
  const cpu::EmbreeDevice device;
  Soup soup = one_triangle();
  soup.instances.assign(5, instance_of(0));
  soup.instances[0].blas_address = 0;
  soup.instances[1].object_to_world[2][2] = 0;
  soup.instances[2].object_to_world[0][3] = not_a_number;
  soup.instances[3].object_to_world[1][1] = infinity;
  soup.instances[4].object_to_world[2][3] = 1;
  BuiltSoup built = build(device, soup);
  rayQueryEXT query = look_down(built.top_level);
  REQUIRE(is_hit(query));
  CHECK(rayQueryGetIntersectionInstanceIdEXT(query, true) == 4);
  CHECK(within_few_ulp(rayQueryGetIntersectionTEXT(query, true), 1));
  soup.instances.pop_back();
  CHECK_FALSE(is_hit(look_down(build(device, soup).top_level)));
}

TEST_CASE("transforms at the limits of single precision are inactive or right, and stop nothing") {
  const cpu::EmbreeDevice device;
  const auto trace_scaled = [&](float scale, float flatness, float coordinate) {
    Soup soup = one_triangle();
    soup.instances.push_back(instance_of(0));
    soup.instances[1].object_to_world[0][3] = 1e6f;
    for (int axis = 0; axis < 3; ++axis) soup.instances[0].object_to_world[axis][axis] = scale;
    // Skewed along a diagonal, so that the determinant is a difference of nearly equal numbers.
    soup.instances[0].object_to_world[0][1] = scale * (1 - flatness);
    soup.instances[0].object_to_world[1][0] = scale;
    soup.instances[0].object_to_world[0][2] = soup.instances[0].object_to_world[1][2] = 0;
    const BuiltSoup built = build(device, soup);
    const vec3 middle = vec3(0.25f * (2 - flatness), 0.5f, 0) * scale;
    return is_hit(trace(built.top_level, middle + vec3(0, 0, coordinate), vec3(0, 0, -coordinate)));
  };
  CHECK(trace_scaled(1, 1, 1));
  CHECK(trace_scaled(1e-7f, 1, 1));
  CHECK(trace_scaled(1e7f, 1, 1));
  CHECK_FALSE(trace_scaled(1e-12f, 1, 1));
  CHECK_FALSE(trace_scaled(1e-30f, 1, 1));
  CHECK_FALSE(trace_scaled(1e12f, 1, 1));
  CHECK_FALSE(trace_scaled(1e30f, 1, 1));
  CHECK(trace_scaled(1, 1e-3f, 1));
  for (const float flatness : {1e-5f, 1e-6f, 3e-7f, 1e-7f, 0.0f}) trace_scaled(1, flatness, 1);
  for (const float scale : {1e-8f, 1e-4f, 1.0f, 1e4f, 1e8f}) {
    for (const float coordinate : {1e-30f, 1e10f, 1e17f, 1e19f, 1e30f, 3e38f}) trace_scaled(scale, 1, coordinate);
  }
}

TEST_CASE("empty structures are hit by nothing") {
  const cpu::EmbreeDevice device;
  for (const bool opaque : {true, false}) {
    for (const Soup& soup : {Soup{}, Soup{{{}}, {instance_of(0)}}, Soup{{{SoupGeometry{{}, opaque}}}, {instance_of(0)}},
                             Soup{{{}}, {instance_of(0), instance_of(0)}}}) {
      const BuiltSoup built = build(device, soup);
      for (const uint flags : {0u, 2u, 4u, 0x10u}) CHECK_FALSE(is_hit(look_down(built.top_level, flags)));
    }
  }
}

TEST_CASE("rays that are no rays hit nothing and harm nothing") {
  const cpu::EmbreeDevice device;
  for (const bool opaque : {true, false}) {
    Soup soup = one_triangle(opaque);
    for (int level = 0; level < 2; ++level) {
      const BuiltSoup built = build(device, soup);
      for (const uint flags : {0u, 4u, 0x10u}) {
        CHECK_FALSE(is_hit(trace(built.top_level, vec3(0.25f, 0.25f, 2), vec3(0), flags)));
        CHECK_FALSE(is_hit(trace(built.top_level, vec3(not_a_number), vec3(0, 0, -1), flags)));
        CHECK_FALSE(is_hit(trace(built.top_level, vec3(0.25f, 0.25f, 2), vec3(not_a_number), flags)));
        CHECK_FALSE(is_hit(trace(built.top_level, vec3(infinity), vec3(0, 0, -1), flags)));
        CHECK_FALSE(is_hit(trace(built.top_level, vec3(0.25f, 0.25f, 2), vec3(0, 0, -1), flags, -2, -1)));
      }
      soup.instances.push_back(instance_of(0));
    }
  }
}

TEST_CASE("a structure outlives the bottom level it was built from, and may be moved") {
  const cpu::EmbreeDevice device;
  BuiltSoup built = build(device, one_triangle());
  const kernel::TopLevel* view = &built.top_level.view();
  built.bottom_levels.clear();
  const cpu::TopLevel moved = std::move(built.top_level);
  CHECK(&moved.view() == view);
  CHECK(is_hit(look_down(moved)));
}

TEST_CASE("bad input is one sentence that names the structure and what is wrong") {
  const cpu::EmbreeDevice device;
  const std::uint16_t indices[] = {0, 1, 3};
  const cpu::TriangleInput good{.vertices = std::as_bytes(std::span(unit_triangle)),
                                .vertex_count = 3,
                                .indices = std::as_bytes(std::span(indices)),
                                .index_format = rhi::IndexFormat::uint16,
                                .triangle_count = 1};
  const auto error = [&](const auto& change) {
    cpu::TriangleInput input = good;
    change(input);
    const std::string text = error_of([&] {
      cpu::BottomLevel::build(device, std::vector<cpu::GeometryInput>{input}, rhi::BuildFlags::none, "bunny");
    });
    CHECK(contains(text, "bunny"));
    return text;
  };
  CHECK(contains(error([](cpu::TriangleInput&) {}), "index 3 of triangle 0 is not below the 3 vertices"));
  CHECK(contains(error([](cpu::TriangleInput& input) { input.vertex_count = 4; }), "4 vertices need 48 bytes"));
  CHECK(contains(error([](cpu::TriangleInput& input) { input.vertex_stride = 8; }), "stride of 8 bytes"));
  CHECK(contains(error([](cpu::TriangleInput& input) { input.triangle_count = 2; }), "2 triangles need 12 bytes"));
  CHECK(contains(error([](cpu::TriangleInput& input) {
                   input.index_format = rhi::IndexFormat::none;
                   input.triangle_count = 2;
                 }),
                 "need 6 vertices"));
  const rhi::InstanceDesc instance = instance_of(0xFF);
  const std::string text = error_of([&] {
    cpu::TopLevel::build(
        device, {&instance, 1}, [](std::uint64_t) { return nullptr; }, rhi::BuildFlags::none, "world");
  });
  CHECK(contains(text, "world: instance 0 refers to the address 0x100"));
}
