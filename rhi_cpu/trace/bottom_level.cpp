#include <algorithm>
#include <utility>

#include "rhi_cpu/trace/acceleration_structure.hpp"
#include "rhi_cpu/trace/scene.hpp"

namespace tandem::cpu {
namespace {

GeometryPointer make_geometry(const EmbreeDevice& device, const TriangleMesh& mesh, std::string_view label) {
  GeometryPointer geometry(rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_TRIANGLE));
  device.check(label);
  auto* positions = static_cast<Position*>(rtcSetNewGeometryBuffer(
      geometry.get(), RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(Position), mesh.positions.size()));
  // Embree leaves out triangles whose indices are out of range, and numbers the others as if they were there.
  auto* triangles = static_cast<TriangleIndices*>(rtcSetNewGeometryBuffer(
      geometry.get(), RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, sizeof(TriangleIndices), mesh.triangles.size()));
  device.check(label);
  std::copy(mesh.positions.begin(), mesh.positions.end(), positions);
  std::copy(mesh.triangles.begin(), mesh.triangles.end(), triangles);
  // A bottom level that is traced without its instance level has had its mask tested already.
  rtcSetGeometryMask(geometry.get(), 0xFFFFFFFFu);
  rtcCommitGeometry(geometry.get());
  device.check(label);
  return geometry;
}

}  // namespace

BottomLevel::BottomLevel(std::shared_ptr<const BottomLevelScene> scene) : scene_(std::move(scene)) {}

BottomLevel BottomLevel::build(const EmbreeDevice& device, std::span<const GeometryInput> geometries,
                               std::string_view label) {
  auto result = std::make_shared<BottomLevelScene>();
  result->scene.reset(rtcNewScene(device.get()));
  device.check(label);
  RTCScene scene = result->scene.get();
  rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST | filter_per_ray);
  for (std::size_t i = 0; i < geometries.size(); ++i) {
    const auto mesh = std::get<TriangleMesh>(read_geometry(geometries[i], label, i));
    result->flags.push_back(mesh.flags);
    result->all_opaque = result->all_opaque && rhi::has(mesh.flags, rhi::GeometryFlags::opaque);
    if (mesh.triangles.empty()) continue;
    const GeometryPointer geometry = make_geometry(device, mesh, label);
    rtcAttachGeometryByID(scene, geometry.get(), static_cast<unsigned>(i));
  }
  rtcCommitScene(scene);
  device.check(label);
  return BottomLevel(std::move(result));
}

}  // namespace tandem::cpu
