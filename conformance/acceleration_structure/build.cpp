#include <algorithm>
#include <random>
#include <span>

#include "conformance/kit/cases.hpp"
#include "conformance/kit/check.hpp"
#include "conformance/kit/reference.hpp"
#include "conformance/ray_query/probe.hpp"

/// acceleration_structures.build, .geometries and .empty: what structures are built from and how.
namespace tandem::conformance {
namespace {

using rhi::BuildFlags;
using rhi::GeometryFlags;

Ray down(float x, float y) { return {.origin = {x + 0.25f, y + 0.25f, 5}}; }

/// `count` triangles in the plane z = 0, in rows of 100.
std::vector<glm::vec3> field(std::uint32_t count) {
  std::vector<glm::vec3> vertices;
  for (std::uint32_t i = 0; i < count; ++i)
    for (const glm::vec3& corner :
         triangle_at({2.0f * static_cast<float>(i % 100), 2.0f * static_cast<float>(i / 100), 0}))
      vertices.push_back(corner);
  return vertices;
}

/// Every ray above the field meets its own triangle.
void check_field(Context& context, const rhi::AccelerationStructureHandle& top_level, std::uint32_t count,
                 std::uint32_t step = 1) {
  std::vector<Ray> rays;
  for (std::uint32_t i = 0; i < count; i += step)
    rays.push_back(down(2.0f * static_cast<float>(i % 100), 2.0f * static_cast<float>(i / 100)));
  const std::vector<Traversal> seen = trace(context, top_level, rays);
  for (std::uint32_t i = 0; i < seen.size(); ++i)
    check_triangle(fmt::format("ray {}", i), seen[i], {.primitive = i * step}, 5);
}

rhi::AccelerationStructureHandle with_instance(rhi::Device& device,
                                               const rhi::AccelerationStructureHandle& bottom_level) {
  return build_top_level(device, {rhi::make_instance(*bottom_level)});
}

void add_flag_cases(const Group& group) {
  const auto add = [&](const char* name, const char* behaviour, BuildFlags flags) {
    group.add(name, behaviour, [flags](Context& context) {
      rhi::Device& device = context.device();
      const auto bottom_level =
          build_bottom_level(device, {.geometries = {triangles(device, field(500))}, .flags = flags, .label = "field"});
      const auto top_level = build_top_level(device, top_level_of(device, {rhi::make_instance(*bottom_level)}, flags));
      check_field(context, top_level, 500);
    });
  };
  add("no_flags", "structures built without a preference answer right", BuildFlags::none);
  add("prefer_fast_trace", "structures built for fast tracing answer right", BuildFlags::prefer_fast_trace);
  add("prefer_fast_build", "structures built fast answer right", BuildFlags::prefer_fast_build);
  add("allow_update", "structures that may be updated answer right", BuildFlags::allow_update);
  add("allow_compaction", "structures that may be compacted answer right", BuildFlags::allow_compaction);
  add("all_flags", "structures built fast that may be updated and compacted answer right",
      BuildFlags::prefer_fast_build | BuildFlags::allow_update | BuildFlags::allow_compaction);
}

void add_build_cases(const Group& group) {
  group.add("many_triangles", "a hundred thousand triangles are all found", [](Context& context) {
    const Scene scene = build_scene(context.device(), {triangles(context.device(), field(100'000))});
    check_field(context, scene.top_level, 100'000, 101);
  });
  group.add("inputs_may_change", "the buffers of a build may be overwritten by the next command", [](Context& context) {
    rhi::Device& device = context.device();
    const rhi::TriangleGeometry geometry = triangles(device, field(10));
    const rhi::BottomLevelDesc desc = {.geometries = {geometry}, .label = "field"};
    const rhi::AccelerationStructureHandle structure = device.create_bottom_level(desc);
    const rhi::CommandListHandle list = device.create_command_list("build and overwrite");
    list->build_bottom_level(structure, desc);
    list->fill(geometry.vertices, 0);
    device.submit(list);
    check_field(context, with_instance(device, structure), 10);
  });
  group.add("inputs_written_before", "a build sees what commands before it in the same list wrote",
            [](Context& context) {
              rhi::Device& device = context.device();
              const std::vector<glm::vec3> vertices = field(10);
              const rhi::TriangleGeometry geometry =
                  triangles(device, std::vector<glm::vec3>(vertices.size(), glm::vec3(99)));
              const rhi::BottomLevelDesc desc = {.geometries = {geometry}, .label = "field"};
              const rhi::AccelerationStructureHandle structure = device.create_bottom_level(desc);
              const rhi::CommandListHandle list = device.create_command_list("write and build");
              list->upload(geometry.vertices.buffer, 0, std::as_bytes(std::span(vertices)));
              list->build_bottom_level(structure, desc);
              device.submit(list);
              check_field(context, with_instance(device, structure), 10);
            });
  group.add("rebuild", "a structure that is built again forgets what it was built from before", [](Context& context) {
    rhi::Device& device = context.device();
    const rhi::BottomLevelDesc first = {.geometries = {triangles(device, triangle_at({0, 0, 0}))}, .label = "rebuilt"};
    const rhi::BottomLevelDesc second = {.geometries = {triangles(device, triangle_at({4, 0, 0}))}, .label = "rebuilt"};
    const rhi::AccelerationStructureHandle structure = build_bottom_level(device, first);
    const rhi::CommandListHandle list = device.create_command_list("rebuild");
    list->build_bottom_level(structure, second);
    device.submit(list);
    const rhi::AccelerationStructureHandle scene = with_instance(device, structure);
    check_miss("the ray at the old place", trace(context, scene, down(0, 0)));
    check_triangle("the ray at the new place", trace(context, scene, down(4, 0)), {}, 5);
  });
  group.add("rebuild_top_level", "a top level that is built again forgets its instances", [](Context& context) {
    rhi::Device& device = context.device();
    const rhi::AccelerationStructureHandle bottom_level =
        build_bottom_level(device, {triangles(device, triangle_at({0, 0, 0}))});
    const rhi::TopLevelDesc first = top_level_of(
        device, {rhi::make_instance(*bottom_level), rhi::make_instance(*bottom_level, translation(4, 0, 0))});
    const rhi::TopLevelDesc second = top_level_of(device, {rhi::make_instance(*bottom_level, translation(8, 0, 0))});
    const rhi::AccelerationStructureHandle structure = build_top_level(device, first);
    const rhi::CommandListHandle list = device.create_command_list("rebuild");
    list->build_top_level(structure, second);  // fewer instances than it was created for
    device.submit(list);
    check_miss("the ray at the first old place", trace(context, structure, down(0, 0)));
    check_miss("the ray at the second old place", trace(context, structure, down(4, 0)));
    check_triangle("the ray at the new place", trace(context, structure, down(8, 0)), {}, 5);
  });
  group.add("many_builds_in_a_list", "a hundred structures are built in one list, each from its own vertices",
            [](Context& context) {
              rhi::Device& device = context.device();
              const rhi::CommandListHandle list = device.create_command_list("many builds");
              std::vector<rhi::AccelerationStructureHandle> structures;
              std::vector<rhi::InstanceDesc> instances;
              std::vector<Ray> rays;
              for (std::uint32_t i = 0; i < 100; ++i) {
                const float x = 2.0f * static_cast<float>(i);
                const rhi::BottomLevelDesc desc = {.geometries = {triangles(device, triangle_at({x, 0, 0}))},
                                                   .label = fmt::format("structure {}", i)};
                structures.push_back(device.create_bottom_level(desc));
                list->build_bottom_level(structures.back(), desc);
                instances.push_back(rhi::make_instance(*structures.back()));
                rays.push_back(down(x, 0));
              }
              const rhi::TopLevelDesc desc = top_level_of(device, instances);
              const rhi::AccelerationStructureHandle top_level = device.create_top_level(desc);
              list->build_top_level(top_level, desc);
              device.submit(list);
              const std::vector<Traversal> seen = trace(context, top_level, rays);
              for (std::uint32_t i = 0; i < 100; ++i)
                check_triangle(fmt::format("ray {}", i), seen[i], {.instance = i}, 5);
            });
  group.add("sizes", "a built structure says how much memory it takes, and more triangles take more",
            [](Context& context) {
              rhi::Device& device = context.device();
              const auto size_of_field = [&](std::uint32_t count) {
                return build_bottom_level(device, {triangles(device, field(count))})->sizes().structure;
              };
              const std::uint64_t small = size_of_field(10);
              const std::uint64_t large = size_of_field(10'000);
              check(small > 0, "the size is 0");
              check(large > small, fmt::format("10000 triangles take {} bytes and 10 take {}", large, small));
            });
  group.add("addresses", "structures have addresses of their own, none 0", [](Context& context) {
    rhi::Device& device = context.device();
    const auto first = build_bottom_level(device, {triangles(device, field(1))});
    const auto second = build_bottom_level(device, {triangles(device, field(1))});
    check(first->device_address() != 0, "the address is 0");
    check(first->device_address() != second->device_address(), "two structures have the same address");
  });
  const Group timed = {group.cases, group.name, {&rhi::Capabilities::ray_query, &rhi::Capabilities::timestamps}};
  timed.add("timestamps", "the time that a build takes can be measured, and is more than 0", [](Context& context) {
    rhi::Device& device = context.device();
    const rhi::QueryPoolHandle times = device.create_query_pool({.count = 2, .label = "times"});
    const rhi::BottomLevelDesc desc = {.geometries = {triangles(device, field(20'000))}, .label = "field"};
    const rhi::AccelerationStructureHandle structure = device.create_bottom_level(desc);
    const rhi::CommandListHandle list = device.create_command_list("timed build");
    list->write_timestamp(times, 0);
    list->build_bottom_level(structure, desc);
    list->write_timestamp(times, 1);
    device.submit(list)->wait();
    const std::vector<double> nanoseconds = times->timestamps_ns();
    check_equal("the number of times", nanoseconds.size(), 2u);
    check(nanoseconds[1] > nanoseconds[0], fmt::format("the build took {} ns", nanoseconds[1] - nanoseconds[0]));
  });
}

void add_geometry_cases(const Group& group) {
  group.add("several", "several geometries of triangles are numbered, each with its own triangles",
            [](Context& context) {
              rhi::Device& device = context.device();
              const Scene scene =
                  build_scene(device, {triangles(device, field(3)), triangles(device, triangle_at({0, 10, 0})),
                                       triangles(device, triangle_at({4, 10, 1}))});
              check_triangle("the first ray", trace(context, scene.top_level, down(4, 0)),
                             {.geometry = 0, .primitive = 2}, 5);
              check_triangle("the second ray", trace(context, scene.top_level, down(0, 10)), {.geometry = 1}, 5);
              check_triangle("the third ray", trace(context, scene.top_level, down(4, 10)), {.geometry = 2}, 4);
            });
  group.add("many", "two hundred geometries of triangles are numbered", [](Context& context) {
    rhi::Device& device = context.device();
    std::vector<rhi::Geometry> geometries;
    std::vector<Ray> rays;
    for (std::uint32_t i = 0; i < 200; ++i) {
      const float x = 2.0f * static_cast<float>(i);
      geometries.push_back(triangles(device, triangle_at({x, 0, 0})));
      rays.push_back(down(x, 0));
    }
    const Scene scene = build_scene(device, geometries);
    const std::vector<Traversal> seen = trace(context, scene.top_level, rays);
    for (std::uint32_t i = 0; i < rays.size(); ++i)
      check_triangle(fmt::format("ray {}", i), seen[i], {.geometry = i}, 5);
  });
  group.add("many_of_boxes", "a hundred geometries of boxes are numbered", [](Context& context) {
    rhi::Device& device = context.device();
    std::vector<rhi::Geometry> geometries;
    std::vector<Ray> rays;
    for (std::uint32_t i = 0; i < 100; ++i) {
      const glm::vec3 corner(2.0f * static_cast<float>(i), 0, 0);
      geometries.push_back(boxes(device, {{corner, corner + glm::vec3(1)}}));
      rays.push_back(down(corner.x, 0));
      rays.back().decisions = {{.actions = action::generate, .geometry = i, .t = 4.5f}};
    }
    const Scene scene = build_scene(device, geometries);
    const std::vector<Traversal> seen = trace(context, scene.top_level, rays);
    for (std::uint32_t i = 0; i < rays.size(); ++i)
      check_generated(fmt::format("ray {}", i), seen[i], {.geometry = i}, 4.5f);
  });
  group.add("mixed_opacity", "each geometry has its own opacity", [](Context& context) {
    rhi::Device& device = context.device();
    const Scene scene = build_scene(device, {triangles(device, triangle_at({0, 0, 0}), GeometryFlags::none),
                                             triangles(device, triangle_at({4, 0, 0}), GeometryFlags::opaque)});
    const Traversal clear = trace(context, scene.top_level, down(0, 0));
    check_miss("the ray at the geometry that is not opaque", clear);
    check(clear.candidate_count > 0, "there is no candidate");
    check_triangle("the ray at the opaque geometry", trace(context, scene.top_level, down(4, 0)), {.geometry = 1}, 5);
  });
}

rhi::TriangleGeometry transformed(rhi::Device& device, const Transform& transform) {
  rhi::TriangleGeometry geometry = triangles(device, triangle_at({0, 0, 0}));
  geometry.transform = {buffer_of(device, std::vector<Transform>{transform}, "transform")};
  return geometry;
}

void add_transform_cases(const Group& group) {
  const auto add = [&](const char* name, const char* behaviour, const Transform& transform) {
    group.add(name, behaviour, [transform](Context& context) {
      const Scene scene = build_scene(context.device(), {transformed(context.device(), transform)});
      const glm::dmat4x3 matrix = matrix_of(transform);
      std::array<glm::dvec3, 3> corners;
      for (std::size_t i = 0; i < 3; ++i) corners[i] = transform_point(matrix, triangle_at({0, 0, 0})[i]);
      const glm::dvec3 target = corners[0] * 0.5 + corners[1] * 0.3 + corners[2] * 0.2;
      const Ray ray = {.origin = glm::vec3(target) + glm::vec3(1, 2, 3), .direction = {-1, -2, -3}};
      const TriangleHit expected = intersect(corners, ray.origin, ray.direction).value();
      const Traversal seen = trace(context, scene.top_level, ray);
      check_triangle("the ray", seen, {}, expected.t);
      check_close("the first barycentric", seen.committed.barycentrics.x, expected.u, 1);
      check_close("the second barycentric", seen.committed.barycentrics.y, expected.v, 1);
      check_equal("the front face", seen.committed.front_face, expected.front_face ? 1u : 0u);
    });
  };
  add("translation", "a geometry's transform moves its triangles", translation(5, -3, 2));
  add("scale", "a geometry's transform scales its triangles", {2, 0, 0, 0, 0, 3, 0, 0, 0, 0, 4, 0});
  add("shear", "a geometry's transform rotates and shears its triangles",
      {0.5f, -1, 0.25f, 1, 1, 0.5f, 0, 2, 0.25f, 0.125f, 1, 3});
  add("mirror", "a geometry's transform that mirrors exchanges front and back", {-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0});
  group.add(
      "of_one_geometry", "a transform is of one geometry and leaves the others where they are", [](Context& context) {
        rhi::Device& device = context.device();
        const Scene scene =
            build_scene(device, {transformed(device, translation(4, 0, 0)), triangles(device, triangle_at({0, 0, 0})),
                                 transformed(device, translation(8, 0, 1))});
        check_triangle("the first ray", trace(context, scene.top_level, down(4, 0)), {.geometry = 0}, 5);
        check_triangle("the second ray", trace(context, scene.top_level, down(0, 0)), {.geometry = 1}, 5);
        check_triangle("the third ray", trace(context, scene.top_level, down(8, 0)), {.geometry = 2}, 4);
      });
  group.add("offset", "a transform may begin inside its buffer", [](Context& context) {
    rhi::Device& device = context.device();
    rhi::TriangleGeometry geometry = triangles(device, triangle_at({0, 0, 0}));
    geometry.transform = {
        buffer_of(device, std::vector<Transform>{translation(9, 9, 9), translation(4, 0, 0)}, "transforms"), 48};
    const Scene scene = build_scene(device, {geometry});
    check_triangle("the ray", trace(context, scene.top_level, down(4, 0)), {}, 5);
  });
  group.add("within_instance", "the instance's transform is applied after the geometry's", [](Context& context) {
    const Transform quarter_turn = {0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1, 0};
    const Scene scene =
        build_scene(context.device(), {transformed(context.device(), translation(4, 0, 0))}, quarter_turn);
    const Ray ray = {.origin = {-0.25f, 4.25f, 5}};
    check_triangle("the ray", trace(context, scene.top_level, ray), {}, 5);
  });
}

void add_empty_cases(const Group& group) {
  group.add("no_geometry", "a bottom level without geometries is never met", [](Context& context) {
    const Scene scene = build_scene(context.device(), {});
    check_miss("the ray", trace(context, scene.top_level, Ray{}));
  });
  group.add("no_triangles", "a geometry without triangles is never met", [](Context& context) {
    const Scene scene = build_scene(context.device(), {rhi::TriangleGeometry()});
    check_miss("the ray", trace(context, scene.top_level, Ray{}));
  });
  group.add("no_boxes", "a geometry without boxes is never met", [](Context& context) {
    const Scene scene = build_scene(context.device(), {rhi::AabbGeometry()});
    const Traversal seen = trace(context, scene.top_level, Ray{});
    check_miss("the ray", seen);
    check_equal("the number of candidates", seen.candidate_count, 0u);
  });
  group.add(
      "empty_geometry_keeps_numbers", "a geometry without triangles counts in the numbers of the others",
      [](Context& context) {
        rhi::Device& device = context.device();
        const Scene scene = build_scene(device, {rhi::TriangleGeometry(), triangles(device, triangle_at({0, 0, 0}))});
        check_triangle("the ray", trace(context, scene.top_level, Ray{}), {.geometry = 1}, 5);
      });
  group.add("no_instances", "a top level without instances is never met", [](Context& context) {
    const rhi::AccelerationStructureHandle top_level =
        build_top_level(context.device(), std::vector<rhi::InstanceDesc>());
    const Traversal seen = trace(context, top_level, Ray{});
    check_miss("the ray", seen);
    check_equal("the number of candidates", seen.candidate_count, 0u);
  });
  group.add("empty_instance_among_others", "instances of an empty bottom level leave the others' numbers as they are",
            [](Context& context) {
              rhi::Device& device = context.device();
              const auto empty = build_bottom_level(device, std::vector<rhi::Geometry>());
              const auto full = build_bottom_level(device, {triangles(device, triangle_at({0, 0, 0}))});
              const auto scene = build_top_level(
                  device, {rhi::make_instance(*empty), rhi::make_instance(*full), rhi::make_instance(*empty)});
              check_triangle("the ray", trace(context, scene, Ray{}), {.instance = 1}, 5);
            });
}

}  // namespace

void add_acceleration_structure_build_cases(Cases& cases) {
  const Group group = {cases, "acceleration_structures.build"};
  add_flag_cases(group);
  add_build_cases(group);
  add_geometry_cases({cases, "acceleration_structures.geometries"});
  add_transform_cases({cases, "acceleration_structures.geometry_transforms"});
  add_empty_cases({cases, "acceleration_structures.empty"});
}

}  // namespace tandem::conformance
