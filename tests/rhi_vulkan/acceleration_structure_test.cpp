#include <doctest/doctest.h>

#include <cmath>
#include <cstdint>

#include "devices/devices.hpp"
#include "tests/rhi/dispatch.hpp"
#include "tests/rhi/ray_probe.hpp"
#include "tests/rhi_vulkan/silent_device.hpp"

using namespace tandem;
using rhi::BuildFlags;
using test::ProbeRay;

namespace {

constexpr BuildFlags changeable = BuildFlags::allow_update | BuildFlags::allow_compaction;

/// A bottom level of one triangle in the plane z = 0, in a buffer that may be written again.
struct Triangle {
  Triangle(rhi::Device& device, BuildFlags flags)
      : geometry(test::triangles_of(device, test::triangle_at(0, 0, 0))),
        desc{.geometries = {geometry}, .flags = flags, .label = "triangle"},
        structure(device.create_bottom_level(desc)) {}

  rhi::TriangleGeometry geometry;
  rhi::BottomLevelDesc desc;
  rhi::AccelerationStructureHandle structure;
};

void move_to(rhi::CommandList& list, const Triangle& triangle, float x) {
  const std::vector<float> positions = test::triangle_at(x, 0, 0);
  list.upload(triangle.geometry.vertices.buffer, 0, std::as_bytes(std::span(positions)));
}

rhi::TopLevelDesc top_level_desc(rhi::Device& device, const std::vector<rhi::InstanceDesc>& instances,
                                 BuildFlags flags) {
  rhi::TopLevelDesc desc;
  desc.instances.buffer = test::buffer_of(device, instances, "instances");
  desc.instance_count = static_cast<std::uint32_t>(instances.size());
  desc.flags = flags;
  desc.label = "top level";
  return desc;
}

/// Whether a ray along -z at x = `x` + 1/4, y = 1/4 meets the structure.
bool is_hit(rhi::Device& device, const rhi::AccelerationStructureHandle& bottom_level, float x) {
  const rhi::AccelerationStructureHandle top_level = test::build_top_level(device, {rhi::make_instance(*bottom_level)});
  return test::trace(device, top_level, {{.origin = {x + 0.25f, 0.25f, 5}}})[0].type == 1;
}

std::uint16_t half(float value) {  // exact for small integers and halves
  if (value == 0) return 0;
  int exponent = 0;
  const float mantissa = std::frexp(std::abs(value), &exponent);
  const auto bits = static_cast<std::uint16_t>(((exponent + 14) << 10) | (static_cast<int>(mantissa * 2048) & 0x3ff));
  return value < 0 ? static_cast<std::uint16_t>(bits | 0x8000) : bits;
}

/// A device without the validation layer, which refuses while a list is recorded what the interface refuses when it is
/// submitted: only then is it known what was built before.
rhi::DeviceHandle plain_device() {
  rhi::DeviceDesc desc;
  desc.name = "vulkan";
  return create_device(desc);
}

}  // namespace

TEST_CASE("vulkan: an updated bottom level is where its vertices are, at the same address") {
  const test::SilentDevice device;
  const Triangle triangle(*device, changeable);
  const std::uint64_t address = triangle.structure->device_address();
  const rhi::CommandListHandle list = device->create_command_list("build and update");
  list->build_bottom_level(triangle.structure, triangle.desc);
  move_to(*list, triangle, 7);
  list->update_bottom_level(triangle.structure, triangle.desc);
  device->submit(list);
  CHECK_FALSE(is_hit(*device, triangle.structure, 0));
  CHECK(is_hit(*device, triangle.structure, 7));
  CHECK(triangle.structure->device_address() == address);
}

TEST_CASE("vulkan: an updated top level is where its instances are") {
  const test::SilentDevice device;
  const Triangle triangle(*device, BuildFlags::prefer_fast_build);
  std::vector<rhi::InstanceDesc> instances = {rhi::make_instance(*triangle.structure)};
  const rhi::TopLevelDesc desc =
      top_level_desc(*device, instances, BuildFlags::allow_update | BuildFlags::prefer_fast_build);
  const rhi::AccelerationStructureHandle top_level = device->create_top_level(desc);
  const rhi::CommandListHandle list = device->create_command_list("build and update");
  list->build_bottom_level(triangle.structure, triangle.desc);
  list->build_top_level(top_level, desc);
  instances[0].object_to_world[0][3] = 3;
  list->upload(desc.instances.buffer, 0, std::as_bytes(std::span(instances)));
  list->update_top_level(top_level, desc);
  device->submit(list);
  const auto hits = test::trace(*device, top_level, {{.origin = {0.25f, 0.25f, 5}}, {.origin = {3.25f, 0.25f, 5}}});
  CHECK(hits[0].type == 0);
  CHECK(hits[1].type == 1);
}

TEST_CASE("vulkan: what was never built is neither updated nor compacted") {
  const rhi::DeviceHandle device = plain_device();
  const Triangle triangle(*device, changeable);
  const rhi::CommandListHandle list = device->create_command_list("update");
  list->update_bottom_level(triangle.structure, triangle.desc);
  CHECK_ERROR(invalid_argument, "triangle: it is updated, but was never built", device->submit(list));
  CHECK_ERROR(invalid_argument, "never built", device->create_compacted(triangle.structure, "compacted"));
}

TEST_CASE("vulkan: an update of a top level with another count than it was built with is refused") {
  const rhi::DeviceHandle device = plain_device();
  rhi::TopLevelDesc desc = top_level_desc(*device, std::vector<rhi::InstanceDesc>(2), BuildFlags::allow_update);
  const rhi::AccelerationStructureHandle top_level = device->create_top_level(desc);
  const rhi::CommandListHandle list = device->create_command_list("update");
  desc.instance_count = 1;
  list->build_top_level(top_level, desc);
  list->update_top_level(top_level, desc);
  desc.instance_count = 2;
  list->update_top_level(top_level, desc);
  CHECK_ERROR(invalid_argument, "an update with 2 instances of a structure built with 1", device->submit(list));
}

TEST_CASE("vulkan: a compacted copy is hit like its source, takes no more memory, and can be updated") {
  const test::SilentDevice device;
  const Triangle triangle(*device, changeable);
  const rhi::CommandListHandle list = device->create_command_list("build");
  list->build_bottom_level(triangle.structure, triangle.desc);
  device->submit(list);
  const rhi::AccelerationStructureHandle copy = device->create_compacted(triangle.structure, "copy");
  CHECK(copy->label() == "copy");
  CHECK(copy->level() == rhi::AccelerationStructure::Level::bottom);
  CHECK(copy->sizes().structure > 0);
  CHECK(copy->sizes().structure <= triangle.structure->sizes().structure);
  CHECK(copy->device_address() != triangle.structure->device_address());
  CHECK(is_hit(*device, copy, 0));

  const rhi::CommandListHandle update = device->create_command_list("update");
  move_to(*update, triangle, 7);
  update->update_bottom_level(copy, triangle.desc);
  device->submit(update);
  CHECK(is_hit(*device, copy, 7));
  CHECK(is_hit(*device, triangle.structure, 0));
  CHECK_ERROR(invalid_argument, "copy: a compacted copy has no room for a build",
              device->create_command_list("build")->build_bottom_level(copy, triangle.desc));
}

TEST_CASE("vulkan: a compacted top level is hit like its source") {
  const test::SilentDevice device;
  const Triangle triangle(*device, BuildFlags::prefer_fast_trace);
  const std::vector<rhi::InstanceDesc> instances = {rhi::make_instance(*triangle.structure)};
  const rhi::TopLevelDesc desc = top_level_desc(*device, instances, BuildFlags::allow_compaction);
  const rhi::AccelerationStructureHandle top_level = device->create_top_level(desc);
  const rhi::CommandListHandle list = device->create_command_list("build");
  list->build_bottom_level(triangle.structure, triangle.desc);
  list->build_top_level(top_level, desc);
  device->submit(list);
  CHECK(test::trace(*device, device->create_compacted(top_level, "copy"), {{.origin = {0.25f, 0.25f, 5}}})[0].type ==
        1);
}

TEST_CASE("vulkan: the sizes of a structure are known from its creation on") {
  const test::SilentDevice device;
  const Triangle fixed(*device, BuildFlags::prefer_fast_trace);
  CHECK(fixed.structure->sizes().structure > 0);
  CHECK(fixed.structure->sizes().build_scratch > 0);
  CHECK(fixed.structure->sizes().update_scratch == 0);
}

TEST_CASE("vulkan: positions of three 16-bit components, up to the end of their buffer") {
  const test::SilentDevice device;
  rhi::TriangleGeometry triangle;
  triangle.vertex_count = 3;
  triangle.vertex_stride = 6;
  triangle.triangle_count = 1;
  float size = 0;
  SUBCASE("halves") {
    triangle.vertex_format = rhi::VertexFormat::half3;
    triangle.vertices = {test::buffer_of(
        *device, std::vector<std::uint16_t>{0, 0, half(-2), half(4), 0, half(-2), 0, half(4), half(-2)}, "halves")};
    size = 4;
  }
  SUBCASE("halves with NaNs between them, as a fourth component that nobody reads") {
    triangle.vertex_format = rhi::VertexFormat::half3;
    triangle.vertex_stride = 8;
    triangle.vertices = {test::buffer_of(
        *device,
        std::vector<std::uint16_t>{0, 0, half(-2), 0xffff, half(4), 0, half(-2), 0xffff, 0, half(4), half(-2), 0xffff},
        "halves")};
    size = 4;
  }
  SUBCASE("normalised integers") {
    triangle.vertex_format = rhi::VertexFormat::snorm3;
    triangle.vertices = {test::buffer_of(
        *device, std::vector<std::int16_t>{0, 0, -32768, 32767, 0, -32768, 0, 32767, -32768}, "snorms")};
    size = 1;
  }
  const float z = size == 4 ? -2.0f : -1.0f;
  const rhi::AccelerationStructureHandle bottom_level = test::build_bottom_level(*device, {triangle});
  const rhi::AccelerationStructureHandle top_level =
      test::build_top_level(*device, {rhi::make_instance(*bottom_level)});
  const auto hits = test::trace(
      *device, top_level, {{.origin = {0.45f * size, 0.45f * size, 5}}, {.origin = {0.6f * size, 0.6f * size, 5}}});
  REQUIRE(hits[0].type == 1);
  CHECK(hits[0].t == doctest::Approx(5 - z).epsilon(1e-5));  // a division or two of rounding
  CHECK(hits[1].type == 0);
}

TEST_CASE("vulkan: boxes that a ray runs through are candidates of its query") {
  const test::SilentDevice device;
  REQUIRE(device->info().capabilities.ray_query);
  // 32 bytes apart; the ray along -z at the origin runs through the first and the third.
  const std::vector<float> boxes = {-1, -1, -1, 1, 1, 1,  0, 0, 20, 20, 20, 21, 21, 21, 0, 0,  //
                                    -1, -1, -5, 1, 1, -4, 0, 0, 8,  8,  8,  9,  9,  9};
  const rhi::AabbGeometry geometry = {
      .boxes = {test::buffer_of(*device, boxes, "boxes")}, .box_count = 4, .stride = 32, .flags = {}};
  const rhi::AccelerationStructureHandle bottom_level = test::build_bottom_level(*device, {geometry});
  const rhi::AccelerationStructureHandle top_level =
      test::build_top_level(*device, {rhi::make_instance(*bottom_level)});
  const rhi::ComputePipelineHandle pipeline = test::compute_pipeline(*device, R"(#version 460
#extension GL_EXT_ray_query : require
layout(local_size_x = 1) in;
layout(set = 0, binding = 0) uniform accelerationStructureEXT scene;
layout(set = 0, binding = 1) buffer Result { uint seen; uint committed; float t; };
void main() {
  rayQueryEXT query;
  rayQueryInitializeEXT(query, scene, 0, 255, vec3(0, 0, 5), 0, vec3(0, 0, -1), 100);
  seen = 0u;
  while (rayQueryProceedEXT(query)) {
    int primitive = rayQueryGetIntersectionPrimitiveIndexEXT(query, false);
    seen |= 1u << primitive;
    if (primitive == 2) rayQueryGenerateIntersectionEXT(query, 9.5);
  }
  committed = rayQueryGetIntersectionTypeEXT(query, true);
  t = rayQueryGetIntersectionTEXT(query, true);
})",
                                                                     "boxes");
  const rhi::BufferHandle result = test::buffer_of(*device, std::vector<std::uint32_t>(3), "result");
  const rhi::BindGroupHandle group = device->create_bind_group(
      {.pipeline = pipeline,
       .entries = {{.binding = 0, .resource = top_level}, {.binding = 1, .resource = rhi::BufferRange{result}}},
       .label = "boxes"});
  const rhi::CommandListHandle list = device->create_command_list("boxes");
  list->dispatch({.pipeline = pipeline, .bind_groups = {group}});
  device->submit(list);
  const std::vector<std::uint32_t> seen = test::contents<std::uint32_t>(*device, result, 2);
  CHECK(seen[0] == 0b101);
  CHECK(seen[1] == 2);  // gl_RayQueryCommittedIntersectionGeneratedEXT
  CHECK(test::contents<float>(*device, result, 3)[2] == 9.5f);
}

TEST_CASE("vulkan: no ray meets a null structure") {
  const test::SilentDevice device;
  REQUIRE(device->info().capabilities.null_acceleration_structure);
  CHECK(test::trace(*device, nullptr, {ProbeRay()})[0].type == 0);
}
