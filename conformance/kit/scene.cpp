#include "conformance/kit/scene.hpp"

#include <utility>

namespace tandem::conformance {

std::vector<glm::vec3> triangle_at(glm::vec3 place) {
  return {place, place + glm::vec3(1, 0, 0), place + glm::vec3(0, 1, 0)};
}

rhi::TriangleGeometry triangles(rhi::Device& device, const std::vector<glm::vec3>& vertices, rhi::GeometryFlags flags) {
  rhi::TriangleGeometry geometry;
  geometry.vertices = {buffer_of(device, vertices, "vertices")};
  geometry.vertex_count = static_cast<std::uint32_t>(vertices.size());
  geometry.triangle_count = geometry.vertex_count / 3;
  geometry.flags = flags;
  return geometry;
}

rhi::AabbGeometry boxes(rhi::Device& device, const std::vector<Box>& boxes, rhi::GeometryFlags flags) {
  rhi::AabbGeometry geometry;
  geometry.boxes = {buffer_of(device, boxes, "boxes")};
  geometry.box_count = static_cast<std::uint32_t>(boxes.size());
  geometry.flags = flags;
  return geometry;
}

rhi::AccelerationStructureHandle build_bottom_level(rhi::Device& device, std::vector<rhi::Geometry> geometries) {
  rhi::BottomLevelDesc desc;
  desc.geometries = std::move(geometries);
  desc.label = "bottom level";
  return build_bottom_level(device, desc);
}

rhi::TopLevelDesc top_level_of(rhi::Device& device, const std::vector<rhi::InstanceDesc>& instances,
                               rhi::BuildFlags flags) {
  rhi::TopLevelDesc desc;
  if (!instances.empty()) desc.instances.buffer = buffer_of(device, instances, "instances");
  desc.instance_count = static_cast<std::uint32_t>(instances.size());
  desc.flags = flags;
  desc.label = "top level";
  return desc;
}

rhi::AccelerationStructureHandle build_top_level(rhi::Device& device, const std::vector<rhi::InstanceDesc>& instances) {
  return build_top_level(device, top_level_of(device, instances));
}

Scene build_scene(rhi::Device& device, std::vector<rhi::Geometry> geometries, const Transform& transform,
                  rhi::InstanceFlags flags) {
  Scene scene;
  scene.bottom_level = build_bottom_level(device, std::move(geometries));
  rhi::InstanceDesc instance = rhi::make_instance(*scene.bottom_level, transform);
  instance.flags = static_cast<std::uint32_t>(flags) & 0xff;
  scene.top_level = build_top_level(device, {instance});
  return scene;
}

}  // namespace tandem::conformance
