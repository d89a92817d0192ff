#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <variant>

#include "rhi_cpu/trace/exact/acceleration_structure.hpp"
#include "rhi_cpu/trace/exact/scene.hpp"

namespace tandem::cpu::exact {
namespace {

void make_finite(BoxSet& set) {
  constexpr float largest = std::numeric_limits<float>::max();
  for (Box& box : set.boxes) {
    if (std::isnan(box.minimum[0])) continue;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      box.minimum[axis] = std::clamp(box.minimum[axis], -largest, largest);
      box.maximum[axis] = std::clamp(box.maximum[axis], -largest, largest);
    }
  }
}

void add_primitives(const TriangleMesh& mesh, std::uint32_t geometry, std::vector<PrimitiveId>& primitives,
                    std::vector<Bounds>& bounds) {
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    if (mesh.triangles[i] == inactive_triangle) continue;
    primitives.push_back({geometry, i});
    Bounds& box = bounds.emplace_back();
    for (const std::uint32_t corner : mesh.triangles[i]) box.include(mesh.positions[corner]);
  }
}

void add_primitives(const BoxSet& set, std::uint32_t geometry, std::vector<PrimitiveId>& primitives,
                    std::vector<Bounds>& bounds) {
  for (std::uint32_t i = 0; i < set.boxes.size(); ++i) {
    if (std::isnan(set.boxes[i].minimum[0])) continue;
    primitives.push_back({geometry, i});
    Bounds& box = bounds.emplace_back();
    box.include(set.boxes[i].minimum);
    box.include(set.boxes[i].maximum);
  }
}

std::shared_ptr<const BottomLevelScene> make_scene(std::span<const GeometryInput> geometries, std::string_view label) {
  auto result = std::make_shared<BottomLevelScene>();
  std::vector<Bounds> bounds;
  for (std::uint32_t i = 0; i < geometries.size(); ++i) {
    GeometryMesh& geometry = result->geometries.emplace_back(read_geometry(geometries[i], label, i));
    if (auto* boxes = std::get_if<BoxSet>(&geometry)) {
      make_finite(*boxes);
      result->has_boxes = true;
    } else {
      const rhi::GeometryFlags flags = std::get<TriangleMesh>(geometry).flags;
      result->all_opaque = result->all_opaque && rhi::has(flags, rhi::GeometryFlags::opaque);
    }
    std::visit([&](const auto& each) { add_primitives(each, i, result->primitives, bounds); }, geometry);
  }
  result->bvh = Bvh(bounds);
  return result;
}

std::size_t bytes_of(const TriangleMesh& mesh) {
  return mesh.positions.size() * sizeof(Position) + mesh.triangles.size() * sizeof(TriangleIndices);
}

std::size_t bytes_of(const BoxSet& set) { return set.boxes.size() * sizeof(Box); }

}  // namespace

BottomLevel::BottomLevel(std::shared_ptr<const BottomLevelScene> scene) : scene_(std::move(scene)) {}

BottomLevel BottomLevel::build(std::span<const GeometryInput> geometries, std::string_view label) {
  return BottomLevel(make_scene(geometries, label));
}

void BottomLevel::update(std::span<const GeometryInput> geometries, std::string_view label) {
  scene_ = make_scene(geometries, label);
}

std::uint64_t BottomLevel::bytes() const noexcept {
  std::uint64_t bytes =
      sizeof(BottomLevelScene) + scene_->primitives.size() * sizeof(PrimitiveId) + scene_->bvh.bytes();
  for (const GeometryMesh& geometry : scene_->geometries) {
    bytes += sizeof(geometry) + std::visit([](const auto& each) { return bytes_of(each); }, geometry);
  }
  return bytes;
}

}  // namespace tandem::cpu::exact
