#include <cmath>
#include <cstring>
#include <utility>

#include <fmt/format.h>

#include "rhi/error.hpp"
#include "rhi_cpu/trace/acceleration_structure.hpp"
#include "rhi_cpu/trace/scene.hpp"

namespace tandem::cpu {
namespace {

using Position = std::array<float, 3>;
using TriangleIndices = std::array<std::uint32_t, 3>;

[[noreturn]] void reject(std::string_view label, std::size_t geometry, const std::string& why) {
  throw rhi::Error(rhi::ErrorCode::invalid_argument, label, fmt::format("geometry {}: {}", geometry, why));
}

std::uint64_t index_size(rhi::IndexFormat format) {
  switch (format) {
    case rhi::IndexFormat::none:
      return 0;
    case rhi::IndexFormat::uint16:
      return 2;
    case rhi::IndexFormat::uint32:
      return 4;
  }
  return 0;
}

void check_sizes(const TriangleInput& input, std::string_view label, std::size_t geometry) {
  if (input.vertex_count > 0) {
    if (input.vertex_stride < sizeof(Position)) {
      reject(label, geometry, fmt::format("a vertex stride of {} bytes is less than a position", input.vertex_stride));
    }
    const std::uint64_t needed = std::uint64_t{input.vertex_count - 1} * input.vertex_stride + sizeof(Position);
    if (input.vertices.size() < needed) {
      reject(label, geometry,
             fmt::format("{} vertices need {} bytes, there are {}", input.vertex_count, needed, input.vertices.size()));
    }
  }
  const std::uint64_t index_count = std::uint64_t{input.triangle_count} * 3;
  if (input.index_format == rhi::IndexFormat::none) {
    if (index_count > input.vertex_count) {
      reject(label, geometry,
             fmt::format("{} triangles without indices need {} vertices, there are {}", input.triangle_count,
                         index_count, input.vertex_count));
    }
  } else if (input.indices.size() < index_count * index_size(input.index_format)) {
    reject(label, geometry,
           fmt::format("{} triangles need {} bytes of indices, there are {}", input.triangle_count,
                       index_count * index_size(input.index_format), input.indices.size()));
  }
}

Position read_position(const TriangleInput& input, std::uint32_t vertex) {
  Position p;
  std::memcpy(p.data(), input.vertices.data() + std::size_t{vertex} * input.vertex_stride, sizeof(p));
  if (!input.transform) return p;
  const std::array<float, 12>& m = *input.transform;
  Position transformed;
  for (std::size_t row = 0; row < 3; ++row) {
    transformed[row] = m[row * 4] * p[0] + m[row * 4 + 1] * p[1] + m[row * 4 + 2] * p[2] + m[row * 4 + 3];
  }
  return transformed;
}

std::uint32_t read_index(const TriangleInput& input, std::size_t position) {
  switch (input.index_format) {
    case rhi::IndexFormat::uint16: {
      std::uint16_t index;
      std::memcpy(&index, input.indices.data() + position * sizeof(index), sizeof(index));
      return index;
    }
    case rhi::IndexFormat::uint32: {
      std::uint32_t index;
      std::memcpy(&index, input.indices.data() + position * sizeof(index), sizeof(index));
      return index;
    }
    case rhi::IndexFormat::none:
      break;
  }
  return static_cast<std::uint32_t>(position);
}

/// Whether the triangle has finite vertices and an area. Differences and products of floats are exact in double for all
/// but absurd ranges, so collinear vertices give a cross product of exactly zero.
bool is_active(const Position& a, const Position& b, const Position& c) {
  std::array<double, 3> ab;
  std::array<double, 3> ac;
  for (std::size_t i = 0; i < 3; ++i) {
    if (!std::isfinite(a[i]) || !std::isfinite(b[i]) || !std::isfinite(c[i])) return false;
    ab[i] = double{b[i]} - double{a[i]};
    ac[i] = double{c[i]} - double{a[i]};
  }
  return ab[1] * ac[2] - ab[2] * ac[1] != 0 || ab[2] * ac[0] - ab[0] * ac[2] != 0 || ab[0] * ac[1] - ab[1] * ac[0] != 0;
}

GeometryPointer make_geometry(const EmbreeDevice& device, const TriangleInput& input, std::string_view label,
                              std::size_t geometry_index) {
  GeometryPointer geometry(rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_TRIANGLE));
  device.check(label);
  auto* positions = static_cast<Position*>(rtcSetNewGeometryBuffer(
      geometry.get(), RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(Position), input.vertex_count));
  auto* triangles = static_cast<TriangleIndices*>(rtcSetNewGeometryBuffer(
      geometry.get(), RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, sizeof(TriangleIndices), input.triangle_count));
  device.check(label);
  for (std::uint32_t i = 0; i < input.vertex_count; ++i) positions[i] = read_position(input, i);
  for (std::uint32_t i = 0; i < input.triangle_count; ++i) {
    TriangleIndices triangle;
    for (std::size_t corner = 0; corner < 3; ++corner) {
      triangle[corner] = read_index(input, std::size_t{i} * 3 + corner);
      if (triangle[corner] >= input.vertex_count) {
        reject(label, geometry_index,
               fmt::format("index {} of triangle {} is not below the {} vertices", triangle[corner], i,
                           input.vertex_count));
      }
    }
    // Embree leaves out triangles whose indices are out of range, and numbers the others as if they were there.
    const bool active = is_active(positions[triangle[0]], positions[triangle[1]], positions[triangle[2]]);
    triangles[i] = active ? triangle : TriangleIndices{~0u, ~0u, ~0u};
  }
  // A bottom level that is traced without its instance level has had its mask tested already.
  rtcSetGeometryMask(geometry.get(), 0xFFFFFFFFu);
  rtcCommitGeometry(geometry.get());
  device.check(label);
  return geometry;
}

}  // namespace

BottomLevel::BottomLevel(std::shared_ptr<const BottomLevelScene> scene) : scene_(std::move(scene)) {}

BottomLevel BottomLevel::build(const EmbreeDevice& device, std::span<const TriangleInput> geometries,
                               std::string_view label) {
  auto result = std::make_shared<BottomLevelScene>();
  result->scene.reset(rtcNewScene(device.get()));
  device.check(label);
  RTCScene scene = result->scene.get();
  rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST | filter_per_ray);
  for (std::size_t i = 0; i < geometries.size(); ++i) {
    const TriangleInput& input = geometries[i];
    check_sizes(input, label, i);
    result->flags.push_back(input.flags);
    result->all_opaque = result->all_opaque && rhi::has(input.flags, rhi::GeometryFlags::opaque);
    if (input.triangle_count == 0) continue;
    const GeometryPointer geometry = make_geometry(device, input, label, i);
    rtcAttachGeometryByID(scene, geometry.get(), static_cast<unsigned>(i));
  }
  rtcCommitScene(scene);
  device.check(label);
  return BottomLevel(std::move(result));
}

}  // namespace tandem::cpu
