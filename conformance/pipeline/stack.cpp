#include "conformance/pipeline/stack.hpp"

#include <utility>

#include "conformance/kit/check.hpp"

namespace tandem::conformance::pipeline {

rhi::TriangleGeometry stacked_triangles(rhi::Device& device, std::uint32_t count, rhi::GeometryFlags flags,
                                        float first_z) {
  std::vector<glm::vec3> vertices;
  for (std::uint32_t i = 0; i < count; ++i)
    for (const glm::vec3& vertex : triangle_at({0, 0, first_z - static_cast<float>(i)})) vertices.push_back(vertex);
  return triangles(device, vertices, flags);
}

rhi::AabbGeometry stacked_boxes(rhi::Device& device, std::uint32_t count, rhi::GeometryFlags flags, float first_z) {
  std::vector<Box> list;
  for (std::uint32_t i = 0; i < count; ++i) {
    const float top = first_z - static_cast<float>(i);
    list.push_back({.minimum = {0, 0, top - 0.5F}, .maximum = {1, 1, top}});
  }
  return boxes(device, list, flags);
}

TracedRay through_stack(std::uint32_t flags) {
  return {.origin = {0.25F, 0.25F, 5}, .direction = {0, 0, -1}, .flags = flags};
}

StackProbe triangle_stack(rhi::Device& device, std::uint32_t count, rhi::GeometryFlags flags,
                          rhi::InstanceFlags instance_flags) {
  StackProbe probe;
  probe.built = build_scene(device, {stacked_triangles(device, count, flags)}, identity, instance_flags);
  probe.scene = probe.built.top_level;
  probe.rays = {through_stack()};
  return probe;
}

StackProbe box_stack(rhi::Device& device, std::vector<Plan> plans, rhi::GeometryFlags flags,
                     rhi::InstanceFlags instance_flags) {
  StackProbe probe;
  const auto count = static_cast<std::uint32_t>(plans.size());
  probe.built = build_scene(device, {stacked_boxes(device, count, flags)}, identity, instance_flags);
  probe.scene = probe.built.top_level;
  probe.rays = {through_stack()};
  probe.hit_groups = {
      {.closest_hit = probe::box_closest_hit, .any_hit = probe::box_any_hit, .intersection = probe::intersection}};
  probe.plans = std::move(plans);
  return probe;
}

void check_closest_hit(const Report& report, std::uint32_t primitive, double t) {
  check_equal("the shader that ran last", report.shader, reporter::closest_hit);
  check_equal("the primitive", report.primitive, primitive);
  check_close("t", static_cast<double>(report.hit_t), t);
}

void check_missed(const Report& report) { check_equal("the shader that ran last", report.shader, reporter::miss); }

}  // namespace tandem::conformance::pipeline
