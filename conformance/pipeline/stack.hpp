#pragma once

#include <cstdint>
#include <vector>

#include "conformance/pipeline/probe.hpp"

/// The scene of most pipeline cases: primitives one behind the other on a ray.
namespace tandem::conformance::pipeline {

/// Triangle i in the plane z = -i: the ray `through_stack()` meets it at t = 5 + i.
rhi::TriangleGeometry stacked_triangles(rhi::Device& device, std::uint32_t count, rhi::GeometryFlags flags,
                                        float first_z = 0);
/// Box i over -i - 0.5 <= z <= -i: the same ray enters it at t = 5 + i.
rhi::AabbGeometry stacked_boxes(rhi::Device& device, std::uint32_t count, rhi::GeometryFlags flags, float first_z = 0);

/// From z = 5 down through the stack. It meets the front faces of the triangles.
TracedRay through_stack(std::uint32_t flags = 0);

/// The probe's triangle shaders over these geometries, one ray through the stack.
struct StackProbe : Probe {
  Scene built = {};
};
StackProbe triangle_stack(rhi::Device& device, std::uint32_t count, rhi::GeometryFlags flags = rhi::GeometryFlags::none,
                          rhi::InstanceFlags instance_flags = rhi::InstanceFlags::none);
/// The probe's box shaders over `plans.size()` boxes; box i reports as plan i says.
StackProbe box_stack(rhi::Device& device, std::vector<Plan> plans, rhi::GeometryFlags flags = rhi::GeometryFlags::none,
                     rhi::InstanceFlags instance_flags = rhi::InstanceFlags::none);

/// Throws Failure unless the report is that of a closest-hit shader for this primitive at this t.
void check_closest_hit(const Report& report, std::uint32_t primitive, double t);
/// Throws Failure unless the report is that of a miss shader.
void check_missed(const Report& report);

}  // namespace tandem::conformance::pipeline
