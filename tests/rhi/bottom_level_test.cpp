#include <doctest/doctest.h>

#include <array>

#include "tests/rhi/dispatch.hpp"
#include "tests/rhi/ray_probe.hpp"

using namespace tandem;
using namespace tandem::test;

namespace {

// A ray down through (x, y) from z = 5. Positions and distances below are small integers and their quarters, so t and
// the barycentrics have exact values; the tolerance is for the division in the triangle test.
constexpr float tolerance = 1e-6f;

ProbeRay down(float x, float y) { return {.origin = {x, y, 5}}; }

std::vector<ProbeHit> trace_alone(rhi::Device& device, const rhi::AccelerationStructureHandle& bottom_level,
                                  const std::vector<ProbeRay>& rays) {
  return trace(device, build_top_level(device, {rhi::make_instance(*bottom_level)}), rays);
}

}  // namespace

TANDEM_DEVICE_TEST("a ray meets a triangle where geometry says, and misses beside it") {
  REQUIRE(device.info().capabilities.ray_query);
  const auto bottom_level = build_bottom_level(device, {triangles_of(device, triangle_at(0, 0, 2))});
  CHECK(bottom_level->device_address() != 0);
  const std::vector<ProbeHit> hits = trace_alone(device, bottom_level,
                                                 {down(0.25f, 0.5f),
                                                  down(0.75f, 0.75f),
                                                  {.origin = {0.25f, 0.25f, 5}, .t_max = 2.5f},
                                                  {.origin = {0.25f, 0.25f, 5}, .t_min = 3.5f},
                                                  {.origin = {0.25f, 0.25f, 5}, .direction = {0, 0, -2}}});
  CHECK(hits[0].type == 1);
  CHECK(hits[0].t == doctest::Approx(3).epsilon(tolerance));
  CHECK(hits[0].barycentrics[0] == doctest::Approx(0.25).epsilon(tolerance));
  CHECK(hits[0].barycentrics[1] == doctest::Approx(0.5).epsilon(tolerance));
  CHECK(hits[0].instance == 0);
  CHECK(hits[0].geometry == 0);
  CHECK(hits[0].primitive == 0);
  CHECK(hits[1].type == 0);
  CHECK(hits[2].type == 0);
  CHECK(hits[3].type == 0);
  CHECK(hits[4].t == doctest::Approx(1.5).epsilon(tolerance));  // t counts in lengths of the direction
}

TANDEM_DEVICE_TEST("indices of 16 and 32 bits, with offsets and strides") {
  REQUIRE(device.info().capabilities.ray_query);
  // Vertices 20 bytes apart, from byte 8 on; triangle i, at (2 i, 0), is written with its vertices in reverse.
  std::vector<float> interleaved(2, -1);
  for (float x : {0.0f, 2.0f})
    for (const std::array<float, 2>& corner : {std::array{0.0f, 0.0f}, {1.0f, 0.0f}, {0.0f, 1.0f}})
      interleaved.insert(interleaved.end(), {x + corner[0], corner[1], 0, -1, -1});
  const std::vector<std::uint32_t> wide = {99, 2, 1, 0, 5, 4, 3};
  const std::vector<std::uint16_t> narrow = {99, 99, 2, 1, 0, 5, 4, 3};
  rhi::TriangleGeometry geometry;
  geometry.vertices = {buffer_of(device, interleaved, "interleaved"), 8};
  geometry.vertex_stride = 20;
  geometry.vertex_count = 6;
  geometry.triangle_count = 2;
  geometry.indices = {buffer_of(device, wide, "wide"), 4};
  geometry.index_format = rhi::IndexFormat::uint32;
  rhi::TriangleGeometry with_narrow = geometry;
  with_narrow.indices = {buffer_of(device, narrow, "narrow"), 4};
  with_narrow.index_format = rhi::IndexFormat::uint16;
  for (const rhi::TriangleGeometry& indexed : {geometry, with_narrow}) {
    const std::vector<ProbeHit> hits = trace_alone(device, build_bottom_level(device, {indexed}),
                                                   {down(0.25f, 0.5f), down(2.25f, 0.5f), down(1.5f, 0.25f)});
    for (std::uint32_t i = 0; i < 2; ++i) {
      CHECK(hits[i].type == 1);
      CHECK(hits[i].primitive == i);
      // Corners 2, 1, 0: the second vertex weighs what x was, the third what is left.
      CHECK(hits[i].barycentrics[0] == doctest::Approx(0.25).epsilon(tolerance));
      CHECK(hits[i].barycentrics[1] == doctest::Approx(0.25).epsilon(tolerance));
    }
    CHECK(hits[2].type == 0);
  }
}

TANDEM_DEVICE_TEST("geometries are numbered and have transforms and flags of their own") {
  REQUIRE(device.info().capabilities.ray_query);
  // The second is scaled by 2 and moved to (10, 0, 1); its matrix lies 16 bytes into a buffer.
  const std::vector<float> matrix = {-1, -1, -1, -1, 2, 0, 0, 10, 0, 2, 0, 0, 0, 0, 2, 1};
  rhi::TriangleGeometry second = triangles_of(device, triangle_at(0, 0, 0), rhi::GeometryFlags::none);
  second.transform = {buffer_of(device, matrix, "matrix"), 16};
  const auto bottom_level = build_bottom_level(device, {triangles_of(device, triangle_at(0, 0, 0)), second});
  ProbeRay refused = down(10.5f, 0.5f);
  refused.confirm = 0;
  const std::vector<ProbeHit> hits =
      trace_alone(device, bottom_level, {down(0.25f, 0.25f), down(10.5f, 1.0f), refused});
  CHECK(hits[0].geometry == 0);
  CHECK(hits[0].candidates == 0);
  CHECK(hits[1].type == 1);
  CHECK(hits[1].geometry == 1);
  CHECK(hits[1].primitive == 0);
  CHECK(hits[1].t == doctest::Approx(4).epsilon(tolerance));
  CHECK(hits[1].barycentrics[0] == doctest::Approx(0.25).epsilon(tolerance));
  CHECK(hits[1].barycentrics[1] == doctest::Approx(0.5).epsilon(tolerance));
  CHECK(hits[1].candidates >= 1);  // not opaque: offered first
  CHECK(hits[2].type == 0);
  CHECK(hits[2].candidates >= 1);
}

TANDEM_DEVICE_TEST("a structure without triangles is never hit") {
  REQUIRE(device.info().capabilities.ray_query);
  const auto no_geometry = build_bottom_level(device, {}, "no geometry");
  const auto no_triangles = build_bottom_level(device, {rhi::TriangleGeometry()}, "no triangles");
  const auto top_level = build_top_level(device, {rhi::make_instance(*no_geometry), rhi::make_instance(*no_triangles)});
  CHECK(trace(device, top_level, {down(0.25f, 0.25f)})[0].type == 0);
}

TANDEM_DEVICE_TEST("a structure may be built again, over other buffers") {
  REQUIRE(device.info().capabilities.ray_query);
  const rhi::BottomLevelDesc first = {.geometries = {triangles_of(device, triangle_at(0, 0, 0))}, .label = "rebuilt"};
  const rhi::BottomLevelDesc second = {.geometries = {triangles_of(device, triangle_at(4, 0, 0))}, .label = "rebuilt"};
  const rhi::AccelerationStructureHandle structure = device.create_bottom_level(first);
  const rhi::CommandListHandle list = device.create_command_list("build twice");
  list->build_bottom_level(structure, first);
  list->build_bottom_level(structure, second);
  device.submit(list);
  const std::vector<ProbeHit> hits = trace_alone(device, structure, {down(0.25f, 0.25f), down(4.25f, 0.25f)});
  CHECK(hits[0].type == 0);
  CHECK(hits[1].type == 1);
}

TANDEM_DEVICE_TEST("many structures are built in one list, each from its own vertices") {
  REQUIRE(device.info().capabilities.ray_query);
  constexpr std::uint32_t count = 200;
  const rhi::CommandListHandle list = device.create_command_list("many builds");
  std::vector<rhi::AccelerationStructureHandle> structures;
  std::vector<rhi::InstanceDesc> instances;
  std::vector<ProbeRay> rays;
  for (std::uint32_t i = 0; i < count; ++i) {
    const auto x = static_cast<float>(2 * i);
    const rhi::BottomLevelDesc desc = {.geometries = {triangles_of(device, triangle_at(x, 0, 0))}, .label = "one"};
    structures.push_back(device.create_bottom_level(desc));
    list->build_bottom_level(structures.back(), desc);
    instances.push_back(rhi::make_instance(*structures.back()));
    rays.push_back(down(x + 0.25f, 0.25f));
  }
  device.submit(list);
  const std::vector<ProbeHit> hits = trace(device, build_top_level(device, instances), rays);
  for (std::uint32_t i = 0; i < count; ++i) CHECK(hits[i].instance == i);
  for (std::uint32_t i = 0; i < count; ++i) CHECK(hits[i].type == 1);
}

TANDEM_DEVICE_TEST("a large structure is built whole") {
  REQUIRE(device.info().capabilities.ray_query);
  constexpr std::uint32_t side = 300;  // 90,000 triangles: more than one chunk of scratch memory
  std::vector<float> positions;
  for (std::uint32_t i = 0; i < side * side; ++i) {
    const std::vector<float> corners = triangle_at(static_cast<float>(i % side), static_cast<float>(i / side), 0);
    positions.insert(positions.end(), corners.begin(), corners.end());
  }
  std::vector<ProbeRay> rays;
  for (std::uint32_t i = 0; i < side * side; i += 97)
    rays.push_back(down(static_cast<float>(i % side) + 0.25f, static_cast<float>(i / side) + 0.25f));
  const std::vector<ProbeHit> hits =
      trace_alone(device, build_bottom_level(device, {triangles_of(device, positions)}), rays);
  bool all_right = true;
  for (std::uint32_t i = 0; i < hits.size(); ++i) all_right &= hits[i].type == 1 && hits[i].primitive == i * 97;
  CHECK(all_right);
}

TANDEM_DEVICE_TEST("broken rules of bottom levels are errors that name the structure") {
  const rhi::TriangleGeometry good = triangles_of(device, triangle_at(0, 0, 0));
  const auto create = [&](const rhi::TriangleGeometry& geometry) {
    device.create_bottom_level({.geometries = {geometry}, .label = "bad"});
  };
  rhi::TriangleGeometry bad = good;
  bad.vertex_count = 4;
  CHECK_ERROR(invalid_argument, "bad: ", create(bad));
  bad = good;
  bad.triangle_count = 2;
  CHECK_ERROR(invalid_argument, "bad: ", create(bad));
  bad = good;
  bad.vertex_stride = 8;
  CHECK_ERROR(invalid_argument, "bad: ", create(bad));
  bad = good;
  bad.indices = good.vertices;
  CHECK_ERROR(invalid_argument, "bad: ", create(bad));
  bad = good;
  bad.index_format = rhi::IndexFormat::uint32;
  CHECK_ERROR(invalid_argument, "bad: ", create(bad));
  bad = good;
  bad.vertices = {device.create_buffer({.size = 36, .label = "no input"})};
  CHECK_ERROR(invalid_argument, "'no input'", create(bad));

  const rhi::BottomLevelDesc desc = {.geometries = {good}, .label = "good"};
  const rhi::AccelerationStructureHandle structure = device.create_bottom_level(desc);
  const rhi::CommandListHandle list = device.create_command_list("builds");
  CHECK_ERROR(invalid_argument,
              "good: ", list->build_bottom_level(structure, {.geometries = {good, good}, .label = "two"}));
  CHECK_ERROR(invalid_argument, "good: ", list->build_top_level(structure, {}));
  CHECK_ERROR(invalid_argument, "builds: ", list->build_bottom_level(nullptr, desc));
  CHECK_ERROR(invalid_argument, "builds: ", list->build_top_level(nullptr, {}));
}
