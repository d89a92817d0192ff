#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <variant>
#include <vector>

#include "rhi/acceleration_structure.hpp"

/// What bottom levels are built from in host memory, and what both tracers read out of it.
namespace tandem::cpu {

/// Triangles of one geometry; see rhi::TriangleGeometry.
struct TriangleInput {
  std::span<const std::byte> vertices = {};  ///< vertex_count positions, `vertex_stride` bytes apart
  std::uint32_t vertex_count = 0;
  std::uint32_t vertex_stride = 12;
  rhi::VertexFormat vertex_format = rhi::VertexFormat::float3;
  /// Tightly packed; empty with IndexFormat::none: consecutive triples of vertices.
  std::span<const std::byte> indices = {};
  rhi::IndexFormat index_format = rhi::IndexFormat::none;
  std::uint32_t triangle_count = 0;
  std::optional<std::array<float, 12>> transform = {};  ///< row-major 3x4, applied to the positions now
  rhi::GeometryFlags flags = rhi::GeometryFlags::opaque;
};

/// Boxes of one geometry; see rhi::AabbGeometry.
struct BoxInput {
  std::span<const std::byte> boxes = {};
  std::uint32_t box_count = 0;
  std::uint32_t stride = 24;
  rhi::GeometryFlags flags = rhi::GeometryFlags::opaque;
};

using GeometryInput = std::variant<TriangleInput, BoxInput>;

using Position = std::array<float, 3>;
using TriangleIndices = std::array<std::uint32_t, 3>;

/// The indices of a triangle that is inactive: it keeps its number and is never hit.
inline constexpr TriangleIndices inactive_triangle = {~0u, ~0u, ~0u};

/// Triangles as they are traced. Inactive are those with a vertex that is not finite, or of no area.
struct TriangleMesh {
  std::vector<Position> positions;  ///< transformed
  std::vector<TriangleIndices> triangles;
  rhi::GeometryFlags flags = rhi::GeometryFlags::opaque;
};

struct Box {
  Position minimum;
  Position maximum;
};

/// Boxes as they are traced. Inactive are those with a NaN anywhere, and those whose minimum exceeds the maximum; they
/// have a NaN as minimum[0] here.
struct BoxSet {
  std::vector<Box> boxes;
  rhi::GeometryFlags flags = rhi::GeometryFlags::opaque;
};

using GeometryMesh = std::variant<TriangleMesh, BoxSet>;

/// Throws rhi::Error, in the name of `label` and geometry `number`, for spans shorter than the counts say and for an
/// index that is not below vertex_count.
GeometryMesh read_geometry(const GeometryInput& input, std::string_view label, std::size_t number);

}  // namespace tandem::cpu
