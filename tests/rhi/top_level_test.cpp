#include <doctest/doctest.h>

#include "tests/rhi/dispatch.hpp"
#include "tests/rhi/ray_probe.hpp"

using namespace tandem;
using namespace tandem::test;

namespace {

constexpr float tolerance = 1e-6f;  // of t, one division away from integers

// GLSL's gl_RayFlags*EXT.
constexpr std::uint32_t cull_back_facing = 0x10;
constexpr std::uint32_t cull_front_facing = 0x20;
constexpr std::uint32_t ray_opaque = 0x01;

ProbeRay down(float x, float y, std::uint32_t flags = 0, std::uint32_t mask = 0xff) {
  return {.origin = {x, y, 5}, .flags = flags, .mask = mask};
}

constexpr std::array<float, 12> moved(float x, float y, float z) { return {1, 0, 0, x, 0, 1, 0, y, 0, 0, 1, z}; }

rhi::AccelerationStructureHandle one_triangle(rhi::Device& device,
                                              rhi::GeometryFlags flags = rhi::GeometryFlags::opaque) {
  return build_bottom_level(device, {triangles_of(device, triangle_at(0, 0, 0), flags)});
}

}  // namespace

TANDEM_DEVICE_TEST("instances have transforms, indices and offsets") {
  REQUIRE(device.info().capabilities.ray_query);
  const auto bottom_level = one_triangle(device);
  rhi::InstanceDesc turned = rhi::make_instance(*bottom_level, {0, -2, 0, 10, 2, 0, 0, 0, 0, 0, 1, 1});
  turned.custom_index = 0xabcdef;
  turned.sbt_offset = 0x123456;
  const auto top_level = build_top_level(device, {rhi::make_instance(*bottom_level, moved(4, 0, 0)), turned});
  // (u, v) of the triangle goes to (10 - 2 v, 2 u).
  const std::vector<ProbeHit> hits = trace(device, top_level, {down(4.25f, 0.25f), down(9, 0.5f), down(0.25f, 0.25f)});
  CHECK(hits[0].type == 1);
  CHECK(hits[0].instance == 0);
  CHECK(hits[0].custom_index == 0);
  CHECK(hits[0].sbt_offset == 0);
  CHECK(hits[0].t == doctest::Approx(5).epsilon(tolerance));
  CHECK(hits[1].type == 1);
  CHECK(hits[1].instance == 1);
  CHECK(hits[1].custom_index == 0xabcdef);
  CHECK(hits[1].sbt_offset == 0x123456);
  CHECK(hits[1].t == doctest::Approx(4).epsilon(tolerance));
  CHECK(hits[1].barycentrics[0] == doctest::Approx(0.25).epsilon(tolerance));
  CHECK(hits[1].barycentrics[1] == doctest::Approx(0.5).epsilon(tolerance));
  CHECK(hits[2].type == 0);
}

TANDEM_DEVICE_TEST("an instance is met when its mask and the ray's share a bit") {
  REQUIRE(device.info().capabilities.ray_query);
  const auto bottom_level = one_triangle(device);
  rhi::InstanceDesc masked = rhi::make_instance(*bottom_level);
  masked.mask = 0x0a;
  const auto top_level = build_top_level(device, {masked});
  const std::vector<ProbeHit> hits = trace(device, top_level,
                                           {down(0.25f, 0.25f, 0, 0x08), down(0.25f, 0.25f, 0, 0xf5),
                                            down(0.25f, 0.25f, 0, 0x02), down(0.25f, 0.25f, 0, 0)});
  CHECK(hits[0].type == 1);
  CHECK(hits[1].type == 0);
  CHECK(hits[2].type == 1);
  CHECK(hits[3].type == 0);
}

TANDEM_DEVICE_TEST("facing is decided in object space, and instances may flip it or forbid culling") {
  REQUIRE(device.info().capabilities.ray_query);
  // The front is the side that (v1 - v0) x (v2 - v0) points to, here up: clockwise as seen in the left-handed system in
  // which the ray tracing interfaces think. A mirroring transform does not change that: facing is decided in object
  // space.
  const auto bottom_level = one_triangle(device);
  rhi::InstanceDesc flipped = rhi::make_instance(*bottom_level, moved(4, 0, 0));
  flipped.flags = static_cast<std::uint32_t>(rhi::InstanceFlags::triangle_flip_facing) & 0xff;
  rhi::InstanceDesc mirrored = rhi::make_instance(*bottom_level, {-1, 0, 0, 9, 0, 1, 0, 0, 0, 0, 1, 0});
  rhi::InstanceDesc unculled = rhi::make_instance(*bottom_level, moved(12, 0, 0));
  unculled.flags = static_cast<std::uint32_t>(rhi::InstanceFlags::triangle_facing_cull_disable) & 0xff;
  const auto top_level = build_top_level(device, {rhi::make_instance(*bottom_level), flipped, mirrored, unculled});
  const std::array<float, 4> x = {0.25f, 4.25f, 8.75f, 12.25f};
  const std::array<std::uint32_t, 4> front_face = {1, 0, 1, 1};
  const std::array<std::uint32_t, 4> survives_back_culling = {1, 0, 1, 1};
  const std::array<std::uint32_t, 4> survives_front_culling = {0, 1, 0, 1};
  for (std::size_t i = 0; i < x.size(); ++i) {
    CAPTURE(i);
    const std::vector<ProbeHit> hits =
        trace(device, top_level,
              {down(x[i], 0.25f), down(x[i], 0.25f, cull_back_facing), down(x[i], 0.25f, cull_front_facing)});
    CHECK(hits[0].type == 1);
    CHECK(hits[0].front_face == front_face[i]);
    CHECK(hits[1].type == survives_back_culling[i]);
    CHECK(hits[2].type == survives_front_culling[i]);
  }
}

TANDEM_DEVICE_TEST("opacity is the geometry's, then the instance's, then the ray's") {
  REQUIRE(device.info().capabilities.ray_query);
  const auto opaque = one_triangle(device);
  const auto transparent = one_triangle(device, rhi::GeometryFlags::none);
  rhi::InstanceDesc forced_opaque = rhi::make_instance(*transparent, moved(8, 0, 0));
  forced_opaque.flags = static_cast<std::uint32_t>(rhi::InstanceFlags::force_opaque) & 0xff;
  rhi::InstanceDesc forced_transparent = rhi::make_instance(*opaque, moved(12, 0, 0));
  forced_transparent.flags = static_cast<std::uint32_t>(rhi::InstanceFlags::force_no_opaque) & 0xff;
  const auto top_level =
      build_top_level(device, {rhi::make_instance(*opaque), rhi::make_instance(*transparent, moved(4, 0, 0)),
                               forced_opaque, forced_transparent});
  const std::array<float, 4> x = {0.25f, 4.25f, 8.25f, 12.25f};
  const std::array<bool, 4> is_opaque = {true, false, true, false};
  for (std::size_t i = 0; i < x.size(); ++i) {
    CAPTURE(i);
    ProbeRay refusing = down(x[i], 0.25f);
    refusing.confirm = 0;
    ProbeRay forcing = down(x[i], 0.25f, ray_opaque);
    forcing.confirm = 0;
    const std::vector<ProbeHit> hits = trace(device, top_level, {refusing, forcing});
    CHECK((hits[0].candidates == 0) == is_opaque[i]);
    CHECK((hits[0].type == 1) == is_opaque[i]);
    CHECK(hits[1].type == 1);
    CHECK(hits[1].candidates == 0);
  }
}

TANDEM_DEVICE_TEST("of several triangles the closest is committed") {
  REQUIRE(device.info().capabilities.ray_query);
  const auto opaque = one_triangle(device);
  const auto transparent = one_triangle(device, rhi::GeometryFlags::none);
  const auto top_level = build_top_level(
      device, {rhi::make_instance(*opaque, moved(0, 0, 1)), rhi::make_instance(*transparent, moved(0, 0, 3)),
               rhi::make_instance(*opaque, moved(0, 0, 2))});
  ProbeRay refusing = down(0.25f, 0.25f);
  refusing.confirm = 0;
  const std::vector<ProbeHit> hits = trace(device, top_level, {down(0.25f, 0.25f), refusing});
  CHECK(hits[0].instance == 1);
  CHECK(hits[0].t == doctest::Approx(2).epsilon(tolerance));
  CHECK(hits[1].instance == 2);
  CHECK(hits[1].t == doctest::Approx(3).epsilon(tolerance));
}

TANDEM_DEVICE_TEST("no instances, inactive instances, and builds with fewer than at creation") {
  REQUIRE(device.info().capabilities.ray_query);
  const auto bottom_level = one_triangle(device);
  const rhi::InstanceDesc active = rhi::make_instance(*bottom_level);
  rhi::InstanceDesc inactive = active;
  inactive.blas_address = 0;

  const rhi::AccelerationStructureHandle none = device.create_top_level({});
  const rhi::CommandListHandle list = device.create_command_list("build none");
  list->build_top_level(none, {});
  device.submit(list);
  CHECK(trace(device, none, {down(0.25f, 0.25f)})[0].type == 0);

  const std::vector<ProbeHit> hits =
      trace(device, build_top_level(device, {inactive, rhi::make_instance(*bottom_level, moved(4, 0, 0))}),
            {down(0.25f, 0.25f), down(4.25f, 0.25f)});
  CHECK(hits[0].type == 0);
  CHECK(hits[1].instance == 1);

  rhi::TopLevelDesc desc;
  desc.instances = {buffer_of(
      device, std::vector<rhi::InstanceDesc>{active, rhi::make_instance(*bottom_level, moved(4, 0, 0))}, "instances")};
  desc.instance_count = 2;
  const rhi::AccelerationStructureHandle shrunk = device.create_top_level(desc);
  desc.instance_count = 1;
  const rhi::CommandListHandle fewer = device.create_command_list("build fewer");
  fewer->build_top_level(shrunk, desc);
  device.submit(fewer);
  const std::vector<ProbeHit> one = trace(device, shrunk, {down(0.25f, 0.25f), down(4.25f, 0.25f)});
  CHECK(one[0].type == 1);
  CHECK(one[1].type == 0);
}

TANDEM_DEVICE_TEST("a shader may write the instances, and one list builds and traces") {
  REQUIRE(device.info().capabilities.ray_query);
  const auto bottom_level = one_triangle(device);
  const std::string write_source = R"(#version 460
layout(local_size_x = 1) in;
struct Instance { vec4 rows[3]; uint custom_index_and_mask; uint offset_and_flags; uvec2 address; };
layout(set = 0, binding = 0, std430) writeonly buffer Instances { Instance instances[]; };
layout(push_constant) uniform Constants { uvec2 address; };
void main() {
  uint i = gl_GlobalInvocationID.x;
  instances[i].rows = vec4[3](vec4(1, 0, 0, 4 * i), vec4(0, 1, 0, 0), vec4(0, 0, 1, 0));
  instances[i].custom_index_and_mask = (100 + i) | 0xff000000u;
  instances[i].offset_and_flags = 0;
  instances[i].address = address;
}
)";
  constexpr std::uint32_t count = 5;
  const rhi::ComputePipelineHandle writer = compute_pipeline(device, write_source, "write instances");
  const rhi::BufferHandle instances = buffer_of(device, std::vector<rhi::InstanceDesc>(count), "instances");
  const rhi::BindGroupHandle group = device.create_bind_group(
      {.pipeline = writer, .entries = {{.binding = 0, .resource = rhi::BufferRange{instances}}}, .label = "instances"});
  rhi::TopLevelDesc desc;
  desc.instances.buffer = instances;
  desc.instance_count = count;
  const rhi::AccelerationStructureHandle top_level = device.create_top_level(desc);
  const std::uint64_t address = bottom_level->device_address();
  const rhi::CommandListHandle list = device.create_command_list("write and build");
  list->dispatch({.pipeline = writer,
                  .bind_groups = {group},
                  .push_constants = std::as_bytes(std::span(&address, 1)),
                  .workgroup_count = {count, 1, 1}});
  list->build_top_level(top_level, desc);
  device.submit(list);
  std::vector<ProbeRay> rays;
  for (std::uint32_t i = 0; i < count; ++i) rays.push_back(down(4 * static_cast<float>(i) + 0.25f, 0.25f));
  const std::vector<ProbeHit> hits = trace(device, top_level, rays);
  for (std::uint32_t i = 0; i < count; ++i) {
    CHECK(hits[i].type == 1);
    CHECK(hits[i].custom_index == 100 + i);
  }
}

TANDEM_DEVICE_TEST("broken rules of top levels are errors that name the structure") {
  rhi::TopLevelDesc desc;
  desc.label = "scene";
  desc.instance_count = 1;
  CHECK_ERROR(invalid_argument, "scene: ", device.create_top_level(desc));
  desc.instances.buffer = buffer_of(device, std::vector<rhi::InstanceDesc>(2), "instances");
  desc.instances.offset = 8;
  CHECK_ERROR(invalid_argument, "scene: ", device.create_top_level(desc));
  desc.instances.offset = 64;
  const rhi::AccelerationStructureHandle structure = device.create_top_level(desc);
  desc.instances.offset = 0;
  desc.instance_count = 2;
  const rhi::CommandListHandle list = device.create_command_list("builds");
  CHECK_ERROR(invalid_argument, "scene: ", list->build_top_level(structure, desc));
  CHECK_ERROR(invalid_argument, "scene: ", list->build_bottom_level(structure, {}));
}

TANDEM_DEVICE_TEST("a structure is built before it is traced, in an earlier list or the same") {
  REQUIRE(device.info().capabilities.ray_query);
  rhi::TopLevelDesc desc;
  desc.label = "scene";
  desc.flags = rhi::BuildFlags::allow_update | rhi::BuildFlags::allow_compaction;
  const rhi::AccelerationStructureHandle structure = device.create_top_level(desc);
  CHECK_ERROR(invalid_argument, "scene: the pipeline 'ray probe' traces it before it is built",
              trace(device, structure, {down(0, 0)}));
  CHECK_ERROR(invalid_argument, "copy: the structure 'scene', to be compacted, was never built",
              device.create_compacted(structure, "copy"));
  // Vulkan's own validation looks when the command is recorded, and says so too.
  if (device_name == "cpu" || device_name == "cpu-exact") {
    const rhi::CommandListHandle update = device.create_command_list("update");
    update->update_top_level(structure, desc);
    CHECK_ERROR(invalid_argument, "scene: it is updated, but was never built", device.submit(update));
    CHECK_ERROR(invalid_argument, "update: ", update->update_top_level(structure, desc));  // it was submitted
  }

  const rhi::CommandListHandle list = device.create_command_list("both");
  list->build_top_level(structure, desc);
  list->update_top_level(structure, desc);
  device.submit(list);
  CHECK(trace(device, structure, {down(0, 0)})[0].type == 0);
  const rhi::AccelerationStructureHandle copy = device.create_compacted(structure, "copy");
  const rhi::CommandListHandle rebuild = device.create_command_list("rebuild");
  CHECK_ERROR(invalid_argument, "copy: a compacted copy has no room for a build, only for an update",
              rebuild->build_top_level(copy, desc));
}
