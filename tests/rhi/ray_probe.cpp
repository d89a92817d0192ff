#include "tests/rhi/ray_probe.hpp"

#include <utility>

#include "rhi/build.hpp"
#include "tests/support/device_test.hpp"

namespace tandem::test {
namespace {

const std::string probe_source = R"(#version 460
#extension GL_EXT_ray_query : require
layout(local_size_x = 32) in;
struct Ray { vec3 origin; float t_min; vec3 direction; float t_max; uint flags; uint mask; uint confirm; uint padding; };
struct Hit {
  uint type; float t; vec2 barycentrics; uint instance; uint custom_index; uint geometry; uint primitive;
  uint front_face; uint sbt_offset; uint candidates; uint padding;
};
layout(set = 0, binding = 0) uniform accelerationStructureEXT scene;
layout(set = 0, binding = 1, std430) readonly buffer Rays { Ray rays[]; };
layout(set = 0, binding = 2, std430) writeonly buffer Hits { Hit hits[]; };
layout(push_constant) uniform Constants { uint ray_count; };
void main() {
  uint index = gl_GlobalInvocationID.x;
  if (index >= ray_count) return;
  Ray ray = rays[index];
  Hit hit = Hit(0u, 0.0, vec2(0.0), 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u);
  rayQueryEXT query;
  rayQueryInitializeEXT(query, scene, ray.flags, ray.mask, ray.origin, ray.t_min, ray.direction, ray.t_max);
  while (rayQueryProceedEXT(query)) {
    ++hit.candidates;
    if (ray.confirm != 0u) rayQueryConfirmIntersectionEXT(query);
  }
  hit.type = rayQueryGetIntersectionTypeEXT(query, true);
  if (hit.type == gl_RayQueryCommittedIntersectionTriangleEXT) {
    hit.t = rayQueryGetIntersectionTEXT(query, true);
    hit.barycentrics = rayQueryGetIntersectionBarycentricsEXT(query, true);
    hit.instance = uint(rayQueryGetIntersectionInstanceIdEXT(query, true));
    hit.custom_index = uint(rayQueryGetIntersectionInstanceCustomIndexEXT(query, true));
    hit.geometry = uint(rayQueryGetIntersectionGeometryIndexEXT(query, true));
    hit.primitive = uint(rayQueryGetIntersectionPrimitiveIndexEXT(query, true));
    hit.front_face = rayQueryGetIntersectionFrontFaceEXT(query, true) ? 1u : 0u;
    hit.sbt_offset = rayQueryGetIntersectionInstanceShaderBindingTableRecordOffsetEXT(query, true);
  }
  hits[index] = hit;
}
)";

}  // namespace

std::vector<ProbeHit> trace(rhi::Device& device, const rhi::AccelerationStructureHandle& top_level,
                            const std::vector<ProbeRay>& rays) {
  const rhi::ComputePipelineHandle pipeline = compute_pipeline(device, probe_source, "ray probe");
  const rhi::BufferHandle ray_buffer = buffer_of(device, rays, "rays");
  const rhi::BufferHandle hit_buffer = buffer_of(device, std::vector<ProbeHit>(rays.size()), "hits");
  const rhi::BindGroupHandle group =
      device.create_bind_group({.pipeline = pipeline,
                                .entries = {{.binding = 0, .resource = top_level},
                                            {.binding = 1, .resource = rhi::BufferRange{ray_buffer}},
                                            {.binding = 2, .resource = rhi::BufferRange{hit_buffer}}},
                                .label = "ray probe"});
  const auto ray_count = static_cast<std::uint32_t>(rays.size());
  const rhi::CommandListHandle list = device.create_command_list("trace");
  list->dispatch({.pipeline = pipeline,
                  .bind_groups = {group},
                  .push_constants = std::as_bytes(std::span(&ray_count, 1)),
                  .workgroup_count = {(ray_count + 31) / 32, 1, 1}});
  device.submit(list);
  return contents<ProbeHit>(device, hit_buffer, rays.size());
}

std::vector<float> triangle_at(float x, float y, float z) { return {x, y, z, x + 1, y, z, x, y + 1, z}; }

rhi::TriangleGeometry triangles_of(rhi::Device& device, const std::vector<float>& positions, rhi::GeometryFlags flags) {
  const auto vertex_count = static_cast<std::uint32_t>(positions.size() / 3);
  rhi::TriangleGeometry geometry;
  geometry.vertices = {buffer_of(device, positions, "vertices")};
  geometry.vertex_count = vertex_count;
  geometry.triangle_count = vertex_count / 3;
  geometry.flags = flags;
  return geometry;
}

rhi::AccelerationStructureHandle build_bottom_level(rhi::Device& device, std::vector<rhi::Geometry> geometries,
                                                    const std::string& label) {
  return rhi::build_bottom_level(device, {.geometries = std::move(geometries), .label = label});
}

rhi::AccelerationStructureHandle build_top_level(rhi::Device& device, const std::vector<rhi::InstanceDesc>& instances,
                                                 const std::string& label) {
  rhi::TopLevelDesc desc;
  desc.instances.buffer = buffer_of(device, instances, "instances");
  desc.instance_count = static_cast<std::uint32_t>(instances.size());
  desc.label = label;
  return rhi::build_top_level(device, desc);
}

}  // namespace tandem::test
