#include <doctest/doctest.h>

#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "rhi/error.hpp"
#include "rhi/glsl/compile.hpp"
#include "rhi_cpu/device.hpp"
#include "rhi_cpu/kernel/trace.hpp"
#include "tests/support/device_test.hpp"
#include "tests/support/few_ulp.hpp"

// Builds, updates and compaction on the devices of rhi_cpu, seen by a kernel that is a C++ function: it asks for the
// closest triangle or box along the z axis.
namespace tandem::cpu {
namespace {

using rhi::BuildFlags;

const std::vector<std::uint32_t>& probe_spirv() {
  static const std::vector<std::uint32_t> words = glsl::compile(R"(#version 460
#extension GL_EXT_ray_query : require
layout(local_size_x = 1) in;
layout(set = 0, binding = 0) uniform accelerationStructureEXT scene;
layout(set = 0, binding = 1) buffer Distance { float t; };
void main() {
  rayQueryEXT query;
  rayQueryInitializeEXT(query, scene, 0u, 0xFFu, vec3(0), 0.0, vec3(0, 0, 1), 1.0);
  t = rayQueryGetIntersectionTEXT(query, true);
})",
                                                                rhi::ShaderStage::compute, "probe.comp");
  return words;
}

constexpr float nothing = -1;

/// The t of the nearest hit, boxes among them, or `nothing`.
float probe(const kernel::TopLevel* scene) {
  const kernel::Ray ray{
      .origin = {0.25f, 0.25f, 0}, .t_min = 0, .direction = {0, 0, 1}, .t_max = 1000, .flags = 0, .mask = 0xFF};
  kernel::Hit hit;
  return scene != nullptr && scene->functions->next_hits(*scene, ray, nullptr, &hit, 1) == 1 ? hit.t : nothing;
}

const kernel::KernelInfo* probe_entry() {
  static constexpr kernel::BindingSlot slots[] = {
      {.set = 0, .binding = 0, .count = 1, .first_resource = 0, .kind = kernel::ResourceKind::acceleration_structure},
      {.set = 0, .binding = 1, .count = 1, .first_resource = 1, .kind = kernel::ResourceKind::storage_buffer}};
  static constexpr kernel::KernelInfo info = {
      .abi_version = kernel::abi_version,
      .workgroup_size = {1, 1, 1},
      .push_constant_size = 0,
      .resource_count = 2,
      .binding_count = 2,
      .bindings = slots,
      .run = [](const kernel::Dispatch& dispatch, std::uint64_t, std::uint64_t) {
        const auto* scene = reinterpret_cast<const kernel::TopLevel*>(dispatch.resources[0].data);
        *reinterpret_cast<float*>(dispatch.resources[1].data) = probe(scene);
      }};
  return &info;
}

class Probe {
 public:
  explicit Probe(std::string_view name)
      : device_(create_device({.name = std::string(name)}, {{.spirv = probe_spirv(), .entry = probe_entry}})),
        pipeline_(device_->create_compute_pipeline(
            {.shader = device_->create_shader_module({.spirv = probe_spirv(), .label = "probe.comp"}),
             .specialization = {},
             .label = "probe"})) {}

  rhi::Device& device() const { return *device_; }

  /// Where the ray meets the scene, or `nothing`.
  float distance(const rhi::AccelerationStructureHandle& scene) const {
    const rhi::BufferHandle result = test::buffer_of(*device_, std::vector<float>{0}, "distance");
    const rhi::BindGroupHandle group = device_->create_bind_group(
        {.pipeline = pipeline_,
         .set = 0,
         .entries = {{.binding = 0, .resource = scene}, {.binding = 1, .resource = rhi::BufferRange{result}}},
         .label = "group"});
    submit([&](rhi::CommandList& list) {
      list.dispatch({.pipeline = pipeline_, .bind_groups = {group}, .workgroup_count = {1, 1, 1}});
    });
    return test::whole_if_close(test::contents<float>(*device_, result, 1)[0]);
  }

  template <typename Record>
  void submit(const Record& record) const {
    const rhi::CommandListHandle list = device_->create_command_list("list");
    record(*list);
    device_->submit(list);
  }

  /// A triangle that the ray meets at t = z.
  rhi::BottomLevelDesc triangle(float z, BuildFlags flags, std::string label = "triangle") const {
    const std::vector<float> vertices = {0, 0, z, 1, 0, z, 0, 1, z};
    rhi::TriangleGeometry geometry;
    geometry.vertices = {test::buffer_of(*device_, vertices, "vertices")};
    geometry.vertex_count = 3;
    geometry.triangle_count = 1;
    return {.geometries = {geometry}, .flags = flags, .label = std::move(label)};
  }

  rhi::AccelerationStructureHandle build(const rhi::BottomLevelDesc& desc) const {
    rhi::AccelerationStructureHandle structure = device_->create_bottom_level(desc);
    submit([&](rhi::CommandList& list) { list.build_bottom_level(structure, desc); });
    return structure;
  }

  rhi::TopLevelDesc instance(const rhi::AccelerationStructure& bottom, BuildFlags flags) const {
    return {.instances = {test::buffer_of(*device_, std::vector{rhi::make_instance(bottom)}, "instances")},
            .instance_count = 1,
            .flags = flags,
            .label = "scene"};
  }

  rhi::AccelerationStructureHandle build(const rhi::TopLevelDesc& desc) const {
    rhi::AccelerationStructureHandle structure = device_->create_top_level(desc);
    submit([&](rhi::CommandList& list) { list.build_top_level(structure, desc); });
    return structure;
  }

  /// The distance in a new scene of that bottom level alone.
  float distance_of(const rhi::AccelerationStructure& bottom) const {
    return distance(build(instance(bottom, BuildFlags::none)));
  }

 private:
  rhi::DeviceHandle device_;
  rhi::ComputePipelineHandle pipeline_;
};

std::string message_of(const std::function<void()>& call) {
  try {
    call();
  } catch (const rhi::Error& error) {
    return error.what();
  }
  return "nothing was thrown";
}

}  // namespace

TEST_CASE("Both devices trace triangles and boxes, and no ray meets a null structure") {
  for (const std::string_view name : device_names()) {
    CAPTURE(name);
    const Probe probe(name);
    CHECK(probe.distance_of(*probe.build(probe.triangle(7, BuildFlags::none))) == 7);
    rhi::AabbGeometry boxes;
    boxes.boxes = {test::buffer_of(probe.device(), std::vector<float>{0, 0, 3, 1, 1, 4}, "boxes")};
    boxes.box_count = 1;
    const auto box =
        probe.build(rhi::BottomLevelDesc{.geometries = {boxes}, .flags = BuildFlags::none, .label = "box"});
    // Embree is asked where a box begins with a margin for rounding: 1e-5 relative.
    CHECK(probe.distance_of(*box) == doctest::Approx(3).epsilon(1e-5));
    CHECK(probe.distance(nullptr) == nothing);
  }
}

TEST_CASE("A structure says how large it is once it is built") {
  for (const std::string_view name : device_names()) {
    CAPTURE(name);
    const Probe probe(name);
    const rhi::BottomLevelDesc desc = probe.triangle(7, BuildFlags::none);
    const auto unbuilt = probe.device().create_bottom_level(desc);
    CHECK(unbuilt->sizes().structure == 0);
    const auto bottom = probe.build(desc);
    CHECK(bottom->sizes().structure > 0);
    CHECK(probe.build(probe.instance(*bottom, BuildFlags::none))->sizes().structure > 0);
  }
}

TEST_CASE("An update moves what was built, at the same address, for the scenes that are built after it") {
  constexpr BuildFlags flags = BuildFlags::allow_update;
  for (const std::string_view name : device_names()) {
    CAPTURE(name);
    const Probe probe(name);
    const auto bottom = probe.build(probe.triangle(7, flags));
    const auto top = probe.build(probe.instance(*bottom, flags));
    const std::uint64_t address = bottom->device_address();
    CHECK(probe.distance(top) == 7);
    probe.submit([&](rhi::CommandList& list) {
      list.update_bottom_level(bottom, probe.triangle(9, flags));
      list.update_top_level(top, probe.instance(*bottom, flags));
    });
    CHECK(bottom->device_address() == address);
    CHECK(probe.distance(top) == 9);

    rhi::TopLevelDesc moved = probe.instance(*bottom, flags);
    moved.instances = {test::buffer_of(
        probe.device(), std::vector{rhi::make_instance(*bottom, {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 2})}, "moved")};
    probe.submit([&](rhi::CommandList& list) { list.update_top_level(top, moved); });
    CHECK(probe.distance(top) == 11);
  }
}

TEST_CASE("What is not built cannot be updated or compacted") {
  constexpr BuildFlags flags = BuildFlags::allow_update | BuildFlags::allow_compaction;
  const Probe probe("cpu");
  const rhi::BottomLevelDesc desc = probe.triangle(7, flags);
  const auto bottom = probe.device().create_bottom_level(desc);
  CHECK(message_of([&] { probe.submit([&](rhi::CommandList& list) { list.update_bottom_level(bottom, desc); }); }) ==
        "triangle: it is updated, but was never built");
  CHECK(message_of([&] { probe.device().create_compacted(bottom, "copy"); }) ==
        "copy: the structure 'triangle', to be compacted, was never built");
  const rhi::TopLevelDesc top_desc{.instances = {}, .instance_count = 0, .flags = flags, .label = "scene"};
  const auto top = probe.device().create_top_level(top_desc);
  CHECK(message_of([&] { probe.submit([&](rhi::CommandList& list) { list.update_top_level(top, top_desc); }); }) ==
        "scene: it is updated, but was never built");
  CHECK(message_of([&] { probe.device().create_compacted(top, "copy"); }) ==
        "copy: the structure 'scene', to be compacted, was never built");
}

TEST_CASE("A compacted copy outlives its source, and neither changes when the other is updated") {
  constexpr BuildFlags flags = BuildFlags::allow_update | BuildFlags::allow_compaction;
  for (const std::string_view name : device_names()) {
    CAPTURE(name);
    const Probe probe(name);
    auto source = probe.build(probe.triangle(7, flags));
    const auto copy = probe.device().create_compacted(source, "copy");
    CHECK(copy->label() == "copy");
    CHECK(copy->device_address() != source->device_address());
    CHECK(copy->sizes().structure <= source->sizes().structure);
    CHECK(probe.distance_of(*copy) == 7);

    probe.submit([&](rhi::CommandList& list) { list.update_bottom_level(source, probe.triangle(8, flags)); });
    CHECK(probe.distance_of(*source) == 8);
    CHECK(probe.distance_of(*copy) == 7);
    probe.submit([&](rhi::CommandList& list) { list.update_bottom_level(copy, probe.triangle(9, flags)); });
    CHECK(probe.distance_of(*source) == 8);
    CHECK(probe.distance_of(*copy) == 9);

    const auto second = probe.device().create_compacted(source, "second");
    source = nullptr;
    CHECK(probe.distance_of(*second) == 8);

    auto top = probe.build(probe.instance(*second, flags));
    const auto top_copy = probe.device().create_compacted(top, "top copy");
    probe.submit([&](rhi::CommandList& list) { list.update_top_level(top, probe.instance(*copy, flags)); });
    CHECK(probe.distance(top) == 9);
    CHECK(probe.distance(top_copy) == 8);
    top = nullptr;
    CHECK(probe.distance(top_copy) == 8);
  }
}

TEST_CASE("A compacted copy is not built again, and a top level is updated with the instances it was built with") {
  constexpr BuildFlags flags = BuildFlags::allow_update | BuildFlags::allow_compaction;
  const Probe probe("cpu");
  const rhi::BottomLevelDesc desc = probe.triangle(7, flags);
  const auto bottom = probe.build(desc);
  const auto copy = probe.device().create_compacted(bottom, "copy");
  CHECK(message_of([&] { probe.submit([&](rhi::CommandList& list) { list.build_bottom_level(copy, desc); }); }) ==
        "copy: a compacted copy has no room for a build, only for an update");
  rhi::TopLevelDesc top_desc = probe.instance(*bottom, flags);
  const auto top = probe.build(top_desc);
  const auto top_copy = probe.device().create_compacted(top, "copy");
  CHECK(message_of([&] { probe.submit([&](rhi::CommandList& list) { list.build_top_level(top_copy, top_desc); }); }) ==
        "copy: a compacted copy has no room for a build, only for an update");
  top_desc.instance_count = 0;
  CHECK(message_of([&] { probe.submit([&](rhi::CommandList& list) { list.update_top_level(top, top_desc); }); }) ==
        "scene: an update with 0 instances of a structure built with 1");
}

TEST_CASE("Compaction wants its flag, and a structure of this device") {
  const Probe probe("cpu");
  const Probe other("cpu");
  const auto plain = probe.build(probe.triangle(7, BuildFlags::none));
  CHECK(message_of([&] { probe.device().create_compacted(plain, "copy"); }).find("allow_compaction") !=
        std::string::npos);
  CHECK_THROWS_AS(probe.device().create_compacted(nullptr, "copy"), rhi::Error);
  const auto foreign = other.build(other.triangle(7, BuildFlags::allow_compaction));
  CHECK(message_of([&] { probe.device().create_compacted(foreign, "copy"); }).find("another device") !=
        std::string::npos);
}

TEST_CASE("The exact device rounds t once") {
  // The triangle's plane is x + y + z = s: the ray through (1/4, 1/4) meets it at s - 1/2 = 2.5 + 3 * 2^-22, which is
  // a float.
  constexpr float s = 3 * (1 + 0x1p-22f);
  const std::vector<float> vertices = {s, 0, 0, 0, s, 0, 0, 0, s};
  const Probe probe("cpu-exact");
  rhi::BottomLevelDesc desc = probe.triangle(0, BuildFlags::none);
  std::get<rhi::TriangleGeometry>(desc.geometries[0]).vertices = {
      test::buffer_of(probe.device(), vertices, "vertices")};
  CHECK(probe.distance_of(*probe.build(desc)) == s - 0.5f);
}

}  // namespace tandem::cpu
