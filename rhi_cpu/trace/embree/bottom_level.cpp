#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "rhi/error.hpp"
#include "rhi_cpu/trace/embree/acceleration_structure.hpp"
#include "rhi_cpu/trace/embree/scene.hpp"

namespace tandem::cpu {
namespace {

GeometryCounts counts_of(const GeometryMesh& mesh) {
  if (const auto* triangles = std::get_if<TriangleMesh>(&mesh))
    return {.primitives = triangles->triangles.size(), .positions = triangles->positions.size()};
  return {.primitives = std::get<BoxSet>(mesh).boxes.size(), .positions = 0};
}

rhi::GeometryFlags flags_of(const GeometryMesh& mesh) {
  return std::visit([](const auto& each) { return each.flags; }, mesh);
}

/// Embree is told boxes that are a little larger: its arithmetic then never loses a ray that touches one, runs along a
/// face or in the plane of a flat box. meet_box decides for itself. What is beyond Embree's range is cut off.
void bounds_of_box(const RTCBoundsFunctionArguments* arguments) {
  const Box& box = static_cast<const BoxSet*>(arguments->geometryUserPtr)->boxes[arguments->primID];
  constexpr float limit = 1e17f;
  float* const lower = &arguments->bounds_o->lower_x;
  float* const upper = &arguments->bounds_o->upper_x;
  if (std::isnan(box.minimum[0])) {  // inactive: Embree leaves out what is empty
    for (int axis = 0; axis < 3; ++axis) {
      lower[axis] = std::numeric_limits<float>::infinity();
      upper[axis] = -std::numeric_limits<float>::infinity();
    }
    return;
  }
  float largest = 0;
  for (std::size_t axis = 0; axis < 3; ++axis)
    largest = std::max({largest, std::abs(box.minimum[axis]), std::abs(box.maximum[axis])});
  // 256 units in the last place of the box, which covers the transforms of instances up to some hundred of its sizes
  // away, and something for a box that is the origin itself.
  const float margin = 0x1p-16f * std::min(largest, limit) + 1e-9f;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    lower[axis] = std::clamp(box.minimum[axis] - margin, -limit, limit);
    upper[axis] = std::clamp(box.maximum[axis] + margin, -limit, limit);
  }
}

GeometryPointer new_geometry(const EmbreeDevice& device, RTCGeometryType type, RTCBuildQuality quality,
                             std::string_view label) {
  GeometryPointer geometry(rtcNewGeometry(device.get(), type));
  device.check(label);
  rtcSetGeometryBuildQuality(geometry.get(), quality);
  // A bottom level that is traced without its instance level has had its mask tested already.
  rtcSetGeometryMask(geometry.get(), 0xFFFFFFFFu);
  return geometry;
}

GeometryPointer make_triangles(const EmbreeDevice& device, const TriangleMesh& mesh, RTCBuildQuality quality,
                               std::string_view label) {
  GeometryPointer geometry = new_geometry(device, RTC_GEOMETRY_TYPE_TRIANGLE, quality, label);
  auto* positions = static_cast<Position*>(rtcSetNewGeometryBuffer(
      geometry.get(), RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(Position), mesh.positions.size()));
  // Embree leaves out triangles whose indices are out of range, and numbers the others as if they were there.
  auto* triangles = static_cast<TriangleIndices*>(rtcSetNewGeometryBuffer(
      geometry.get(), RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, sizeof(TriangleIndices), mesh.triangles.size()));
  device.check(label);
  std::copy(mesh.positions.begin(), mesh.positions.end(), positions);
  std::copy(mesh.triangles.begin(), mesh.triangles.end(), triangles);
  return geometry;
}

GeometryPointer make_boxes(const EmbreeDevice& device, BoxSet& set, RTCBuildQuality quality, std::string_view label) {
  GeometryPointer geometry = new_geometry(device, RTC_GEOMETRY_TYPE_USER, quality, label);
  rtcSetGeometryUserPrimitiveCount(geometry.get(), static_cast<unsigned>(set.boxes.size()));
  rtcSetGeometryUserData(geometry.get(), &set);
  rtcSetGeometryBoundsFunction(geometry.get(), &bounds_of_box, nullptr);
  rtcSetGeometryIntersectFunction(geometry.get(), &meet_box);
  return geometry;
}

/// Takes the place of the geometry with this number, if there is one.
void attach(const EmbreeDevice& device, BottomLevelScene& level, std::size_t number, GeometryMesh& mesh,
            std::string_view label) {
  GeometryPointer geometry;
  if (auto* boxes = std::get_if<BoxSet>(&mesh)) {
    level.box_sets[number] = std::make_unique<BoxSet>(std::move(*boxes));
    geometry = make_boxes(device, *level.box_sets[number], level.quality, label);
  } else {
    geometry = make_triangles(device, std::get<TriangleMesh>(mesh), level.quality, label);
  }
  rtcCommitGeometry(geometry.get());
  rtcAttachGeometryByID(level.scene.get(), geometry.get(), static_cast<unsigned>(number));
  device.check(label);
}

bool have_same_active_boxes(const BoxSet& a, const BoxSet& b) {
  return std::equal(a.boxes.begin(), a.boxes.end(), b.boxes.begin(),
                    [](const Box& x, const Box& y) { return std::isnan(x.minimum[0]) == std::isnan(y.minimum[0]); });
}

/// Moves the primitives of a geometry. False when that takes more: Embree's refit keeps the primitives that it knows,
/// so it cannot take one in that was inactive, nor let one go.
bool move_primitives(BottomLevelScene& level, std::size_t number, GeometryMesh& mesh) {
  RTCGeometry geometry = rtcGetGeometry(level.scene.get(), static_cast<unsigned>(number));
  if (auto* boxes = std::get_if<BoxSet>(&mesh)) {
    if (!have_same_active_boxes(*boxes, *level.box_sets[number])) return false;
    level.box_sets[number]->boxes = std::move(boxes->boxes);
  } else {
    const auto& triangles = std::get<TriangleMesh>(mesh);
    const auto* indices =
        static_cast<const TriangleIndices*>(rtcGetGeometryBufferData(geometry, RTC_BUFFER_TYPE_INDEX, 0));
    if (!std::equal(triangles.triangles.begin(), triangles.triangles.end(), indices)) return false;
    auto* positions = static_cast<Position*>(rtcGetGeometryBufferData(geometry, RTC_BUFFER_TYPE_VERTEX, 0));
    std::copy(triangles.positions.begin(), triangles.positions.end(), positions);
    rtcUpdateGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0);
  }
  rtcCommitGeometry(geometry);
  return true;
}

/// Embree's part is what it has taken since `allocated_before`.
std::uint64_t bytes_of(const BottomLevelScene& level, const EmbreeDevice& device, std::int64_t allocated_before) {
  std::uint64_t bytes = sizeof(level) + level.flags.size() * (sizeof(rhi::GeometryFlags) + sizeof(GeometryCounts));
  for (const auto& set : level.box_sets) bytes += sizeof(set) + (set ? set->boxes.size() * sizeof(Box) : 0);
  return bytes + static_cast<std::uint64_t>(std::max<std::int64_t>(device.allocated_bytes() - allocated_before, 0));
}

}  // namespace

BottomLevel::BottomLevel(std::shared_ptr<BottomLevelScene> scene) : scene_(std::move(scene)) {}

std::shared_ptr<const BottomLevelScene> BottomLevel::scene() const noexcept { return scene_; }

std::uint64_t BottomLevel::bytes() const noexcept { return scene_->bytes; }

BottomLevel BottomLevel::build(const EmbreeDevice& device, std::span<const GeometryInput> geometries,
                               rhi::BuildFlags flags, std::string_view label) {
  const std::int64_t allocated_before = device.allocated_bytes();
  auto result = std::make_shared<BottomLevelScene>();
  result->quality = quality_of(flags);
  result->scene = new_scene(device, result->quality, label);
  result->holds_boxes = !geometries.empty() && std::holds_alternative<BoxInput>(geometries.front());
  result->box_sets.resize(geometries.size());
  for (std::size_t i = 0; i < geometries.size(); ++i) {
    if (std::holds_alternative<BoxInput>(geometries[i]) != result->holds_boxes) {
      throw rhi::Error(rhi::ErrorCode::invalid_argument, label,
                       fmt::format("geometry {} is not of the kind of geometry 0: a bottom level holds triangles or "
                                   "boxes, not both",
                                   i));
    }
    GeometryMesh mesh = read_geometry(geometries[i], label, i);
    result->flags.push_back(flags_of(mesh));
    result->counts.push_back(counts_of(mesh));
    result->all_opaque = result->all_opaque && rhi::has(result->flags.back(), rhi::GeometryFlags::opaque);
    if (result->counts.back().primitives > 0) attach(device, *result, i, mesh, label);
  }
  rtcCommitScene(result->scene.get());
  device.check(label);
  result->bytes = bytes_of(*result, device, allocated_before);
  return BottomLevel(std::move(result));
}

void BottomLevel::update(const EmbreeDevice& device, std::span<const GeometryInput> geometries,
                         std::string_view label) {
  BottomLevelScene& level = *scene_;
  const auto reject = [&](const std::string& why) { throw rhi::Error(rhi::ErrorCode::invalid_argument, label, why); };
  if (level.quality != RTC_BUILD_QUALITY_REFIT) reject("it was built without BuildFlags::allow_update");
  if (geometries.size() != level.flags.size())
    reject(fmt::format("it was built from {} geometries, the update has {}", level.flags.size(), geometries.size()));
  // All are read before the first is changed, so that an error leaves everything as it was.
  std::vector<GeometryMesh> meshes;
  for (std::size_t i = 0; i < geometries.size(); ++i) {
    if (std::holds_alternative<BoxInput>(geometries[i]) != level.holds_boxes)
      reject(fmt::format("geometry {} is not of the kind that it was built from", i));
    meshes.push_back(read_geometry(geometries[i], label, i));
    const GeometryCounts counts = counts_of(meshes.back());
    if (counts.primitives != level.counts[i].primitives)
      reject(fmt::format("geometry {} was built from {} primitives, the update has {}", i, level.counts[i].primitives,
                         counts.primitives));
    if (counts.positions != level.counts[i].positions)
      reject(fmt::format("geometry {} was built from {} vertices, the update has {}", i, level.counts[i].positions,
                         counts.positions));
  }
  level.all_opaque = true;
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    level.flags[i] = flags_of(meshes[i]);
    level.all_opaque = level.all_opaque && rhi::has(level.flags[i], rhi::GeometryFlags::opaque);
    if (level.counts[i].primitives == 0 || move_primitives(level, i, meshes[i])) continue;
    rtcDetachGeometry(level.scene.get(), static_cast<unsigned>(i));
    attach(device, level, i, meshes[i], label);
  }
  rtcCommitScene(level.scene.get());
  device.check(label);
}

}  // namespace tandem::cpu
