#include <algorithm>
#include <span>

#include "conformance/kit/cases.hpp"
#include "conformance/kit/check.hpp"
#include "conformance/ray_query/probe.hpp"

/// acceleration_structures.update and acceleration_structures.compaction.
namespace tandem::conformance {
namespace {

using rhi::BuildFlags;

Ray down(float x) { return {.origin = {x + 0.25f, 0.25f, 5}}; }

rhi::BottomLevelDesc updatable(std::vector<rhi::Geometry> geometries) {
  return {.geometries = std::move(geometries), .flags = BuildFlags::allow_update, .label = "moving"};
}

rhi::AccelerationStructureHandle with_instance(rhi::Device& device,
                                               const rhi::AccelerationStructureHandle& bottom_level) {
  return build_top_level(device, {rhi::make_instance(*bottom_level)});
}

void update(rhi::Device& device, const rhi::AccelerationStructureHandle& structure, const rhi::BottomLevelDesc& desc) {
  const rhi::CommandListHandle list = device.create_command_list("update");
  list->update_bottom_level(structure, desc);
  device.submit(list);
}

void update(rhi::Device& device, const rhi::AccelerationStructureHandle& structure, const rhi::TopLevelDesc& desc) {
  const rhi::CommandListHandle list = device.create_command_list("update");
  list->update_top_level(structure, desc);
  device.submit(list);
}

std::vector<glm::vec3> row(std::uint32_t count, float y) {
  std::vector<glm::vec3> vertices;
  for (std::uint32_t i = 0; i < count; ++i)
    for (const glm::vec3& corner : triangle_at({2 * static_cast<float>(i), y, 0})) vertices.push_back(corner);
  return vertices;
}

void add_bottom_level_cases(const Group& group) {
  group.add("vertices", "moved vertices are met where they are now, and no more where they were", [](Context& context) {
    rhi::Device& device = context.device();
    const auto structure = build_bottom_level(device, updatable({triangles(device, triangle_at({0, 0, 0}))}));
    const std::uint64_t address = structure->device_address();
    update(device, structure, updatable({triangles(device, triangle_at({40, 0, 2}))}));
    check_equal("the address after the update", structure->device_address(), address);
    const auto scene = with_instance(device, structure);
    check_miss("the ray at the old place", trace(context, scene, down(0)));
    check_triangle("the ray at the new place", trace(context, scene, down(40)), {}, 3);
  });
  group.add("same_buffer", "an update may read the buffer of the build, written anew", [](Context& context) {
    rhi::Device& device = context.device();
    const rhi::TriangleGeometry geometry = triangles(device, triangle_at({0, 0, 0}));
    const rhi::BottomLevelDesc desc = updatable({geometry});
    const auto structure = build_bottom_level(device, desc);
    const std::vector<glm::vec3> moved = triangle_at({8, 0, 1});
    const rhi::CommandListHandle list = device.create_command_list("write and update");
    list->upload(geometry.vertices.buffer, 0, std::as_bytes(std::span(moved)));
    list->update_bottom_level(structure, desc);
    device.submit(list);
    const auto scene = with_instance(device, structure);
    check_miss("the ray at the old place", trace(context, scene, down(0)));
    check_triangle("the ray at the new place", trace(context, scene, down(8)), {}, 4);
  });
  group.add("many_vertices", "a thousand triangles that change places keep their numbers", [](Context& context) {
    rhi::Device& device = context.device();
    constexpr std::uint32_t count = 1000;
    std::vector<glm::vec3> reversed;
    for (std::uint32_t i = 0; i < count; ++i)
      for (const glm::vec3& corner : triangle_at({2 * static_cast<float>(count - 1 - i), 0, 0}))
        reversed.push_back(corner);
    const auto structure = build_bottom_level(device, updatable({triangles(device, row(count, 0))}));
    update(device, structure, updatable({triangles(device, reversed)}));
    std::vector<Ray> rays;
    for (std::uint32_t i = 0; i < count; ++i) rays.push_back(down(2 * static_cast<float>(i)));
    const std::vector<Traversal> seen = trace(context, with_instance(device, structure), rays);
    for (std::uint32_t i = 0; i < count; ++i)
      check_triangle(fmt::format("ray {}", i), seen[i], {.primitive = count - 1 - i}, 5);
  });
  group.add("indexed", "moved vertices that indices share are met where they are now", [](Context& context) {
    rhi::Device& device = context.device();
    rhi::TriangleGeometry geometry = triangles(device, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}});
    geometry.indices = {buffer_of(device, std::vector<std::uint16_t>{0, 1, 2, 1, 3, 2}, "indices")};
    geometry.index_format = rhi::IndexFormat::uint16;
    geometry.triangle_count = 2;
    const auto structure = build_bottom_level(device, updatable({geometry}));
    geometry.vertices = {
        buffer_of(device, std::vector<glm::vec3>{{4, 0, 1}, {5, 0, 1}, {4, 1, 1}, {5, 1, 1}}, "moved")};
    update(device, structure, updatable({geometry}));
    const auto scene = with_instance(device, structure);
    check_miss("the ray at the old place", trace(context, scene, down(0)));
    check_triangle("the first ray", trace(context, scene, down(4)), {.primitive = 0}, 4);
    check_triangle("the second ray", trace(context, scene, Ray{.origin = {4.75f, 0.75f, 5}}), {.primitive = 1}, 4);
  });
  group.add("boxes", "moved boxes are offered where they are now", [](Context& context) {
    rhi::Device& device = context.device();
    const auto structure = build_bottom_level(device, updatable({boxes(device, {Box{}})}));
    update(device, structure, updatable({boxes(device, {{{40, 0, 2}, {41, 1, 3}}})}));
    const auto scene = with_instance(device, structure);
    Ray ray = down(40);
    ray.decisions = {{.actions = action::generate, .t = 2.5f}};
    check_generated("the ray", trace(context, scene, ray), {}, 2.5f);
  });
  group.add("second_geometry", "an update of several geometries moves each by its own vertices", [](Context& context) {
    rhi::Device& device = context.device();
    const auto structure = build_bottom_level(
        device, updatable({triangles(device, triangle_at({0, 0, 0})), triangles(device, triangle_at({4, 0, 0}))}));
    update(device, structure,
           updatable({triangles(device, triangle_at({0, 0, 1})), triangles(device, triangle_at({8, 0, 2}))}));
    const auto scene = with_instance(device, structure);
    check_triangle("the first ray", trace(context, scene, down(0)), {.geometry = 0}, 4);
    check_miss("the ray at the old place", trace(context, scene, down(4)));
    check_triangle("the second ray", trace(context, scene, down(8)), {.geometry = 1}, 3);
  });
  group.add("transform", "an update may change a geometry's transform", [](Context& context) {
    rhi::Device& device = context.device();
    rhi::TriangleGeometry geometry = triangles(device, triangle_at({0, 0, 0}));
    geometry.transform = {buffer_of(device, std::vector<Transform>{translation(4, 0, 0)}, "transform")};
    const auto structure = build_bottom_level(device, updatable({geometry}));
    geometry.transform = {buffer_of(device, std::vector<Transform>{translation(8, 0, 1)}, "moved transform")};
    update(device, structure, updatable({geometry}));
    const auto scene = with_instance(device, structure);
    check_miss("the ray at the old place", trace(context, scene, down(4)));
    check_triangle("the ray at the new place", trace(context, scene, down(8)), {}, 4);
  });
  group.add("repeated", "after ten updates in one list the last counts", [](Context& context) {
    rhi::Device& device = context.device();
    const auto structure = build_bottom_level(device, updatable({triangles(device, triangle_at({0, 0, 0}))}));
    const rhi::CommandListHandle list = device.create_command_list("updates");
    for (int i = 1; i <= 10; ++i)
      list->update_bottom_level(structure,
                                updatable({triangles(device, triangle_at({2 * static_cast<float>(i), 0, 0}))}));
    device.submit(list);
    const auto scene = with_instance(device, structure);
    check_miss("the ray at the place before the last", trace(context, scene, down(18)));
    check_triangle("the ray at the last place", trace(context, scene, down(20)), {}, 5);
  });
  group.add("rebuild_after", "an updated structure may be built again", [](Context& context) {
    rhi::Device& device = context.device();
    const auto structure = build_bottom_level(device, updatable({triangles(device, triangle_at({0, 0, 0}))}));
    update(device, structure, updatable({triangles(device, triangle_at({4, 0, 0}))}));
    const rhi::BottomLevelDesc again = updatable({triangles(device, triangle_at({8, 0, 0}))});
    const rhi::CommandListHandle list = device.create_command_list("rebuild");
    list->build_bottom_level(structure, again);
    device.submit(list);
    const auto scene = with_instance(device, structure);
    check_miss("the ray at the updated place", trace(context, scene, down(4)));
    check_triangle("the ray at the rebuilt place", trace(context, scene, down(8)), {}, 5);
  });
}

void add_top_level_cases(const Group& group) {
  const auto add = [&](const char* name, const char* behaviour, void (*run)(Context&, rhi::InstanceDesc before)) {
    group.add(name, behaviour, [run](Context& context) {
      const auto bottom_level =
          build_bottom_level(context.device(), {triangles(context.device(), triangle_at({0, 0, 0}))});
      run(context, rhi::make_instance(*bottom_level));
    });
  };
  static constexpr auto updated = [](Context& context, const rhi::InstanceDesc& before,
                                     const rhi::InstanceDesc& after) {
    rhi::Device& device = context.device();
    const auto structure = build_top_level(device, top_level_of(device, {before}, BuildFlags::allow_update));
    update(device, structure, top_level_of(device, {after}, BuildFlags::allow_update));
    return structure;
  };
  add("instance_moved", "a moved instance is met where it is now", [](Context& context, rhi::InstanceDesc before) {
    rhi::InstanceDesc after = before;
    after.object_to_world[0][3] = 40;
    after.object_to_world[2][3] = 1;
    const auto scene = updated(context, before, after);
    check_miss("the ray at the old place", trace(context, scene, down(0)));
    check_triangle("the ray at the new place", trace(context, scene, down(40)), {}, 4);
  });
  add("instance_mask", "an update may change an instance's mask", [](Context& context, rhi::InstanceDesc before) {
    rhi::InstanceDesc after = before;
    before.mask = 1;
    after.mask = 2;
    const auto scene = updated(context, before, after);
    check_miss("the ray of the old mask", trace(context, scene, Ray{.mask = 1}));
    check_triangle("the ray of the new mask", trace(context, scene, Ray{.mask = 2}), {}, 5);
  });
  add("instance_flags", "an update may change an instance's flags", [](Context& context, rhi::InstanceDesc before) {
    rhi::InstanceDesc after = before;
    after.flags = static_cast<std::uint32_t>(rhi::InstanceFlags::force_no_opaque) & 0xff;
    const Traversal seen = trace(context, updated(context, before, after), Ray{});
    check_miss("the ray", seen);
    check(seen.candidate_count > 0, "there is no candidate");
  });
  add("instance_ids", "an update may change an instance's custom index and SBT offset",
      [](Context& context, rhi::InstanceDesc before) {
        rhi::InstanceDesc after = before;
        after.custom_index = 11;
        after.sbt_offset = 12;
        const Traversal seen = trace(context, updated(context, before, after), Ray{});
        check_equal("the custom index", seen.committed.custom_index, 11u);
        check_equal("the SBT offset", seen.committed.sbt_offset, 12u);
      });
  add("instance_bottom_level", "an update may change an instance's bottom level",
      [](Context& context, rhi::InstanceDesc before) {
        const auto other = build_bottom_level(context.device(), {triangles(context.device(), triangle_at({0, 0, 2}))});
        rhi::InstanceDesc after = before;
        after.blas_address = other->device_address();
        check_triangle("the ray", trace(context, updated(context, before, after), Ray{}), {}, 3);
      });
  group.add("top_level_follows", "a top level updated after its bottom level meets the moved triangles",
            [](Context& context) {
              rhi::Device& device = context.device();
              const auto structure = build_bottom_level(device, updatable({triangles(device, triangle_at({0, 0, 0}))}));
              const rhi::TopLevelDesc desc =
                  top_level_of(device, {rhi::make_instance(*structure)}, BuildFlags::allow_update);
              const auto scene = build_top_level(device, desc);
              const rhi::CommandListHandle list = device.create_command_list("update both");
              list->update_bottom_level(structure, updatable({triangles(device, triangle_at({60, 0, 0}))}));
              list->update_top_level(scene, desc);
              device.submit(list);
              check_miss("the ray at the old place", trace(context, scene, down(0)));
              check_triangle("the ray at the new place", trace(context, scene, down(60)), {}, 5);
            });
}

/// A compacted copy of `count` triangles in a row.
struct Compacted {
  rhi::AccelerationStructureHandle source;
  rhi::AccelerationStructureHandle copy;
};

Compacted compact_row(rhi::Device& device, std::uint32_t count, BuildFlags more = BuildFlags::none) {
  Compacted result;
  result.source = build_bottom_level(
      device,
      {.geometries = {triangles(device, row(count, 0))}, .flags = BuildFlags::allow_compaction | more, .label = "row"});
  result.copy = device.create_compacted(result.source, "compacted row");
  return result;
}

void check_row(Context& context, const rhi::AccelerationStructureHandle& scene, std::uint32_t count) {
  std::vector<Ray> rays;
  for (std::uint32_t i = 0; i < count; ++i) rays.push_back(down(2 * static_cast<float>(i)));
  const std::vector<Traversal> seen = trace(context, scene, rays);
  for (std::uint32_t i = 0; i < count; ++i) check_triangle(fmt::format("ray {}", i), seen[i], {.primitive = i}, 5);
}

void add_compaction_cases(const Group& group) {
  group.add("same_answers", "a compacted copy answers like its source", [](Context& context) {
    const Compacted structures = compact_row(context.device(), 500);
    check_row(context, with_instance(context.device(), structures.copy), 500);
    check_row(context, with_instance(context.device(), structures.source), 500);
  });
  group.add("not_larger", "a compacted copy takes no more memory than its source", [](Context& context) {
    const Compacted structures = compact_row(context.device(), 5000);
    const std::uint64_t before = structures.source->sizes().structure;
    const std::uint64_t after = structures.copy->sizes().structure;
    check(after > 0 && after <= before, fmt::format("{} bytes became {}", before, after));
  });
  group.add("own_address", "a compacted copy has an address of its own", [](Context& context) {
    const Compacted structures = compact_row(context.device(), 5);
    check(structures.copy->device_address() != structures.source->device_address(), "both have the same address");
  });
  group.add("outlives_source", "a compacted copy needs its source no more", [](Context& context) {
    rhi::Device& device = context.device();
    Compacted structures = compact_row(device, 100);
    structures.source = nullptr;
    const Compacted other = compact_row(device, 100);  // may take the memory that is free now
    check_row(context, with_instance(device, structures.copy), 100);
  });
  group.add("boxes", "boxes may be compacted", [](Context& context) {
    rhi::Device& device = context.device();
    const auto source = build_bottom_level(device, {.geometries = {boxes(device, {{{8, 8, 8}, {9, 9, 9}}, Box{}})},
                                                    .flags = BuildFlags::allow_compaction,
                                                    .label = "boxes"});
    const auto copy = device.create_compacted(source, "compacted boxes");
    const auto scene = with_instance(device, copy);
    Ray ray;
    ray.decisions = {{.actions = action::generate, .t = 4.5f}};
    check_generated("the ray", trace(context, scene, ray), {.primitive = 1}, 4.5f);
  });
  group.add("top_level", "a top level may be compacted", [](Context& context) {
    rhi::Device& device = context.device();
    const auto bottom_level = build_bottom_level(device, {triangles(device, row(3, 0))});
    const auto source = build_top_level(
        device, top_level_of(device, {rhi::make_instance(*bottom_level)}, BuildFlags::allow_compaction));
    check_row(context, device.create_compacted(source, "compacted top level"), 3);
  });
  group.add("then_update", "a compacted copy may be updated when its source may", [](Context& context) {
    rhi::Device& device = context.device();
    const BuildFlags flags = BuildFlags::allow_compaction | BuildFlags::allow_update;
    const Compacted structures = compact_row(device, 1, BuildFlags::allow_update);
    update(device, structures.copy,
           {.geometries = {triangles(device, triangle_at({40, 0, 1}))}, .flags = flags, .label = "row"});
    const auto scene = with_instance(device, structures.copy);
    check_miss("the ray at the old place", trace(context, scene, down(0)));
    check_triangle("the ray at the new place", trace(context, scene, down(40)), {}, 4);
    check_row(context, with_instance(device, structures.source), 1);
  });
}

}  // namespace

void add_acceleration_structure_update_cases(Cases& cases) {
  const Group group = {cases, "acceleration_structures.update"};
  add_bottom_level_cases(group);
  add_top_level_cases(group);
  add_compaction_cases({cases, "acceleration_structures.compaction"});
}

}  // namespace tandem::conformance
