#include <algorithm>
#include <glm/geometric.hpp>
#include <span>

#include "conformance/kit/cases.hpp"
#include "conformance/kit/check.hpp"
#include "conformance/kit/reference.hpp"
#include "conformance/ray_query/probe.hpp"

/// acceleration_structures.instances and acceleration_structures.instance_transforms.
namespace tandem::conformance {
namespace {

Ray down(float x) { return {.origin = {x + 0.25f, 0.25f, 5}}; }

rhi::AccelerationStructureHandle one_triangle(rhi::Device& device) {
  return build_bottom_level(device, {triangles(device, triangle_at({0, 0, 0}))});
}

/// A ray at the inside of a triangle in an instance, checked with all its getters that the transform changes.
void check_transform(Context& context, const Transform& transform) {
  const std::vector<glm::vec3> corners = {{0.5f, -1, 0.25f}, {2, 0.5f, 0}, {-0.5f, 1.5f, -0.75f}};
  const Scene scene = build_scene(context.device(), {triangles(context.device(), corners)}, transform);
  const glm::dmat4x3 object_to_world = matrix_of(transform);
  const glm::dmat4x3 world_to_object = inverse(object_to_world);
  std::vector<Ray> rays;
  for (const glm::dvec3& direction : {glm::dvec3(0.2, -0.3, -1), glm::dvec3(-0.5, 0.1, 1)}) {
    for (const auto& [u, v] : {std::pair(0.25, 0.25), {0.7, 0.2}, {0.1, 0.85}}) {
      const glm::dvec3 target =
          glm::dvec3(corners[0]) * (1 - u - v) + glm::dvec3(corners[1]) * u + glm::dvec3(corners[2]) * v;
      Ray ray;
      ray.origin = transform_point(object_to_world, target - 3.0 * direction);
      ray.direction = transform_direction(object_to_world, direction);
      rays.push_back(ray);
    }
  }
  const std::vector<Traversal> seen = trace(context, scene.top_level, rays);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const std::string what = fmt::format("ray {}", i);
    const glm::dvec3 origin = transform_point(world_to_object, rays[i].origin);
    const glm::dvec3 direction = transform_direction(world_to_object, rays[i].direction);
    // The ray's own rounding moves it by this much of the triangle's size at most; it is part of both answers.
    const TriangleHit expected = intersect({corners[0], corners[1], corners[2]}, origin, direction).value();
    check_triangle(what, seen[i], {}, expected.t);
    check_close(what + ": the first barycentric", seen[i].committed.barycentrics.x, expected.u, 1);
    check_close(what + ": the second barycentric", seen[i].committed.barycentrics.y, expected.v, 1);
    check_equal(what + ": the front face", seen[i].committed.front_face, expected.front_face ? 1u : 0u);
    for (int axis = 0; axis < 3; ++axis) {
      check_close(what + ": the object ray origin", seen[i].committed.object_origin[axis], origin[axis],
                  glm::length(origin));
      check_close(what + ": the object ray direction", seen[i].committed.object_direction[axis], direction[axis],
                  glm::length(direction));
    }
  }
}

void add_transform_cases(const Group& group) {
  const auto add = [&](const char* name, const char* behaviour, const Transform& transform) {
    group.add(name, behaviour, [transform](Context& context) { check_transform(context, transform); });
  };
  add("identity", "the identity leaves an instance where its bottom level is", identity);
  add("translation", "an instance may be moved", translation(3, -2, 1));
  add("rotation", "an instance may be rotated", {0.36f, 0.48f, -0.8f, 0, -0.8f, 0.6f, 0, 0, 0.48f, 0.64f, 0.6f, 0});
  add("uniform_scale", "an instance may be scaled", {4, 0, 0, 0, 0, 4, 0, 0, 0, 0, 4, 0});
  add("non_uniform_scale", "an instance may be scaled by different amounts",
      {4, 0, 0, 1, 0, 0.25f, 0, 2, 0, 0, 1.5f, 3});
  add("small_scale", "an instance may be scaled down by a thousand", {1e-3f, 0, 0, 0, 0, 1e-3f, 0, 0, 0, 0, 1e-3f, 0});
  add("large_scale", "an instance may be scaled up by a thousand", {1e3f, 0, 0, 0, 0, 1e3f, 0, 0, 0, 0, 1e3f, 0});
  add("shear", "an instance may be sheared", {1, 0.75f, 0, 0, 0, 1, -0.5f, 0, 0.25f, 0, 1, 0});
  add("mirror_x", "an instance that mirrors keeps the facing of its triangles", {-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0});
  add("mirror_all", "an instance that mirrors in all axes keeps the facing of its triangles",
      {-1, 0, 0, 0, 0, -1, 0, 0, 0, 0, -1, 0});
  add("exchanged_axes", "an instance may exchange axes", {0, 1, 0, 0, 0, 0, 1, 0, 1, 0, 0, 0});
  add("general", "an instance may be rotated, scaled, sheared, mirrored and moved at once",
      {-1.5f, 0.5f, 0.25f, 10, 0.75f, 1.25f, -0.5f, -7, 0.5f, -0.25f, 2, 3});
  group.add("mirror_culling", "culling by facing in an instance that mirrors goes by object space",
            [](Context& context) {
              const Scene scene = build_scene(context.device(), {triangles(context.device(), triangle_at({0, 0, 0}))},
                                              {-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0});
              const Ray front = {.origin = {-0.25f, 0.25f, 5}, .flags = ray_flags::cull_back_facing};
              const Ray culled = {.origin = {-0.25f, 0.25f, 5}, .flags = ray_flags::cull_front_facing};
              check_triangle("the ray that culls back faces", trace(context, scene.top_level, front), {}, 5);
              check_miss("the ray that culls front faces", trace(context, scene.top_level, culled));
            });
}

void add_identity_cases(const Group& group) {
  const auto add_value = [&](const char* name, const char* behaviour, std::uint32_t value, bool custom_index) {
    group.add(name, behaviour, [=](Context& context) {
      rhi::Device& device = context.device();
      const auto bottom_level = one_triangle(device);
      rhi::InstanceDesc instance = rhi::make_instance(*bottom_level);
      // What lies beside the value in its 32 bits must not leak into it.
      instance.mask = 0xa5;
      instance.flags = static_cast<std::uint32_t>(rhi::InstanceFlags::force_opaque) & 0xff;
      instance.custom_index = (custom_index ? value : ~value) & 0xffffff;
      instance.sbt_offset = (custom_index ? ~value : value) & 0xffffff;
      const Traversal seen = trace(context, build_top_level(device, {instance}), down(0));
      check_triangle("the ray", seen, {}, 5);
      check_equal("the custom index", seen.committed.custom_index, instance.custom_index);
      check_equal("the SBT offset", seen.committed.sbt_offset, instance.sbt_offset);
    });
  };
  add_value("custom_index_zero", "a custom index of 0 is 0", 0, true);
  add_value("custom_index_largest", "a custom index has 24 bits, without sign", 0xffffff, true);
  add_value("custom_index_sign_bit", "a custom index with its highest bit set stays positive", 0x800000, true);
  add_value("sbt_offset_largest", "an SBT offset has 24 bits", 0xffffff, false);
  add_value("sbt_offset_sign_bit", "an SBT offset with its highest bit set stays positive", 0x800000, false);
}

/// Instance i of the triangle lies at x = 2 i.
std::vector<rhi::InstanceDesc> row_of_instances(const rhi::AccelerationStructureHandle& bottom_level,
                                                std::uint32_t count) {
  std::vector<rhi::InstanceDesc> instances;
  for (std::uint32_t i = 0; i < count; ++i) {
    instances.push_back(rhi::make_instance(*bottom_level, translation(2 * static_cast<float>(i), 0, 0)));
    instances.back().custom_index = (i * 7) & 0xffffff;
  }
  return instances;
}

void check_row(Context& context, const rhi::AccelerationStructureHandle& top_level, std::uint32_t count) {
  std::vector<Ray> rays;
  for (std::uint32_t i = 0; i < count; ++i) rays.push_back(down(2 * static_cast<float>(i)));
  const std::vector<Traversal> seen = trace(context, top_level, rays);
  for (std::uint32_t i = 0; i < count; ++i) {
    check_triangle(fmt::format("ray {}", i), seen[i], {.instance = i}, 5);
    check_equal(fmt::format("ray {}: the custom index", i), seen[i].committed.custom_index, i * 7);
  }
}

/// Writes instances of a bottom level at its address, as a program that places instances on the device does.
const std::string writer_source = R"(#version 460
layout(local_size_x = 1) in;
struct Instance { vec4 rows[3]; uint custom_index_and_mask; uint sbt_offset_and_flags; uvec2 bottom_level; };
layout(set = 0, binding = 0, std430) writeonly buffer Instances { Instance instances[]; };
layout(push_constant) uniform Constants { uvec2 bottom_level; };
void main() {
  uint i = gl_GlobalInvocationID.x;
  Instance instance;
  instance.rows[0] = vec4(1.0, 0.0, 0.0, 2.0 * float(i));
  instance.rows[1] = vec4(0.0, 1.0, 0.0, 0.0);
  instance.rows[2] = vec4(0.0, 0.0, 1.0, 0.0);
  instance.custom_index_and_mask = (7u * i) | (0xffu << 24);
  instance.sbt_offset_and_flags = 0u;
  instance.bottom_level = bottom_level;
  instances[i] = instance;
}
)";

void add_buffer_cases(const Group& group) {
  group.add("written_by_shader", "instances may be written by a shader in the list that builds from them",
            [](Context& context) {
              rhi::Device& device = context.device();
              constexpr std::uint32_t count = 40;
              const auto bottom_level = one_triangle(device);
              const rhi::TopLevelDesc desc = top_level_of(device, std::vector<rhi::InstanceDesc>(count));
              const rhi::AccelerationStructureHandle top_level = device.create_top_level(desc);
              const rhi::ComputePipelineHandle writer = context.compute_pipeline(writer_source, "instance writer");
              const rhi::BindGroupHandle bindings = device.create_bind_group(
                  {.pipeline = writer, .entries = {{.binding = 0, .resource = desc.instances}}, .label = "instances"});
              const std::uint64_t address = bottom_level->device_address();
              const rhi::CommandListHandle list = device.create_command_list("write and build");
              list->dispatch({.pipeline = writer,
                              .bind_groups = {bindings},
                              .push_constants = std::as_bytes(std::span(&address, 1)),
                              .workgroup_count = {count, 1, 1}});
              list->build_top_level(top_level, desc);
              device.submit(list);
              check_row(context, top_level, count);
            });
  group.add("offset", "instances may begin inside their buffer", [](Context& context) {
    rhi::Device& device = context.device();
    const auto bottom_level = one_triangle(device);
    std::vector<rhi::InstanceDesc> instances = row_of_instances(bottom_level, 3);
    instances.insert(instances.begin(), 2, rhi::make_instance(*bottom_level, translation(2, 0, 1)));
    rhi::TopLevelDesc desc = top_level_of(device, instances);
    desc.instances.offset = 2 * sizeof(rhi::InstanceDesc);
    desc.instance_count = 3;
    check_row(context, build_top_level(device, desc), 3);
  });
  group.add("many", "five thousand instances are numbered in the order of their buffer", [](Context& context) {
    rhi::Device& device = context.device();
    const auto bottom_level = one_triangle(device);
    check_row(context, build_top_level(device, row_of_instances(bottom_level, 5000)), 5000);
  });
  group.add(
      "different_bottom_levels", "instances of different bottom levels meet what is theirs", [](Context& context) {
        rhi::Device& device = context.device();
        std::vector<rhi::AccelerationStructureHandle> bottom_levels;
        std::vector<rhi::InstanceDesc> instances;
        std::vector<Ray> rays;
        for (std::uint32_t i = 0; i < 10; ++i) {
          const float z = 0.25f * static_cast<float>(i);
          bottom_levels.push_back(build_bottom_level(device, {triangles(device, triangle_at({0, 0, z}))}));
          instances.push_back(rhi::make_instance(*bottom_levels.back(), translation(2 * static_cast<float>(i), 0, 0)));
          rays.push_back(down(2 * static_cast<float>(i)));
        }
        const std::vector<Traversal> seen = trace(context, build_top_level(device, instances), rays);
        for (std::uint32_t i = 0; i < 10; ++i)
          check_triangle(fmt::format("ray {}", i), seen[i], {.instance = i}, 5 - 0.25 * i);
      });
  group.add("overlapping", "where instances overlap, the nearest triangle is met", [](Context& context) {
    rhi::Device& device = context.device();
    const auto bottom_level = one_triangle(device);
    std::vector<rhi::InstanceDesc> instances;
    for (const float z : {0.0f, 3.0f, 1.0f, 2.0f})
      instances.push_back(rhi::make_instance(*bottom_level, translation(0, 0, z)));
    check_triangle("the ray", trace(context, build_top_level(device, instances), down(0)), {.instance = 1}, 2);
  });
  group.add("triangles_and_boxes", "instances of triangles and of boxes live in one top level", [](Context& context) {
    rhi::Device& device = context.device();
    const auto triangle = one_triangle(device);
    const auto box = build_bottom_level(device, {boxes(device, {Box{}})});
    const auto scene =
        build_top_level(device, {rhi::make_instance(*triangle), rhi::make_instance(*box, translation(4, 0, 0))});
    check_triangle("the ray at the triangle", trace(context, scene, down(0)), {.instance = 0}, 5);
    Ray at_box = down(4);
    at_box.decisions = {{.actions = action::generate, .t = 4.5f}};
    check_generated("the ray at the box", trace(context, scene, at_box), {.instance = 1}, 4.5f);
  });
}

void add_inactive_cases(const Group& group) {
  group.add("null", "an instance with address 0 is never met, and the others keep their numbers", [](Context& context) {
    rhi::Device& device = context.device();
    const auto bottom_level = one_triangle(device);
    std::vector<rhi::InstanceDesc> instances = row_of_instances(bottom_level, 5);
    instances[1].blas_address = instances[3].blas_address = 0;
    std::vector<Ray> rays;
    for (std::uint32_t i = 0; i < 5; ++i) rays.push_back(down(2 * static_cast<float>(i)));
    const std::vector<Traversal> seen = trace(context, build_top_level(device, instances), rays);
    for (std::uint32_t i = 0; i < 5; ++i) {
      const std::string what = fmt::format("ray {}", i);
      if (i == 1 || i == 3) {
        check_miss(what, seen[i]);
      } else {
        check_triangle(what, seen[i], {.instance = i}, 5);
      }
    }
  });
  group.add("only_null", "a top level of instances with address 0 alone is never met", [](Context& context) {
    const auto scene = build_top_level(context.device(), std::vector<rhi::InstanceDesc>(3));
    check_miss("the ray", trace(context, scene, down(0)));
  });
}

}  // namespace

void add_acceleration_structure_instance_cases(Cases& cases) {
  const Group group = {cases, "acceleration_structures.instances"};
  add_identity_cases(group);
  add_buffer_cases(group);
  add_inactive_cases(group);
  add_transform_cases({cases, "acceleration_structures.instance_transforms"});
}

}  // namespace tandem::conformance
