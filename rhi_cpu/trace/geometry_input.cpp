#include "rhi_cpu/trace/geometry_input.hpp"

#include <cmath>
#include <cstring>
#include <limits>
#include <string>

#include <fmt/format.h>

#include "rhi/error.hpp"

namespace tandem::cpu {
namespace {

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
    if (input.vertex_stride < rhi::size_of(input.vertex_format)) {
      reject(label, geometry, fmt::format("a vertex stride of {} bytes is less than a position", input.vertex_stride));
    }
    const std::uint64_t needed =
        std::uint64_t{input.vertex_count - 1} * input.vertex_stride + rhi::size_of(input.vertex_format);
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

/// A number of 16 bits, exactly: subnormals, infinities and NaN included.
float half_to_float(std::uint16_t half) {
  const int exponent = half >> 10 & 0x1F;
  const int mantissa = half & 0x3FF;
  float magnitude = 0;
  if (exponent == 0)
    magnitude = std::ldexp(static_cast<float>(mantissa), -24);
  else if (exponent < 31)
    magnitude = std::ldexp(static_cast<float>(mantissa + 1024), exponent - 25);
  else
    magnitude = mantissa == 0 ? std::numeric_limits<float>::infinity() : std::numeric_limits<float>::quiet_NaN();
  return (half & 0x8000) != 0 ? -magnitude : magnitude;
}

float snorm_to_float(std::int16_t value) { return std::fmax(static_cast<float>(value) / 32767.0f, -1.0f); }

Position decoded(const std::byte* bytes, rhi::VertexFormat format) {
  Position position;
  if (format == rhi::VertexFormat::float3) {
    std::memcpy(position.data(), bytes, sizeof(position));
    return position;
  }
  for (std::size_t i = 0; i < 3; ++i) {
    std::uint16_t component;
    std::memcpy(&component, bytes + i * sizeof(component), sizeof(component));
    position[i] = format == rhi::VertexFormat::half3 ? half_to_float(component)
                                                     : snorm_to_float(static_cast<std::int16_t>(component));
  }
  return position;
}

Position read_position(const TriangleInput& input, std::uint32_t vertex) {
  const Position p = decoded(input.vertices.data() + std::size_t{vertex} * input.vertex_stride, input.vertex_format);
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

TriangleMesh read(const TriangleInput& input, std::string_view label, std::size_t number) {
  check_sizes(input, label, number);
  TriangleMesh mesh{.positions = {}, .triangles = {}, .flags = input.flags};
  if (input.triangle_count == 0) return mesh;
  mesh.positions.reserve(input.vertex_count);
  for (std::uint32_t i = 0; i < input.vertex_count; ++i) mesh.positions.push_back(read_position(input, i));
  mesh.triangles.reserve(input.triangle_count);
  for (std::uint32_t i = 0; i < input.triangle_count; ++i) {
    TriangleIndices triangle;
    for (std::size_t corner = 0; corner < 3; ++corner) {
      triangle[corner] = read_index(input, std::size_t{i} * 3 + corner);
      if (triangle[corner] >= input.vertex_count)
        reject(label, number,
               fmt::format("index {} of triangle {} is not below the {} vertices", triangle[corner], i,
                           input.vertex_count));
    }
    const bool active =
        is_active(mesh.positions[triangle[0]], mesh.positions[triangle[1]], mesh.positions[triangle[2]]);
    mesh.triangles.push_back(active ? triangle : inactive_triangle);
  }
  return mesh;
}

BoxSet read(const BoxInput& input, std::string_view label, std::size_t number) {
  if (input.box_count > 0) {
    if (input.stride < sizeof(Box))
      reject(label, number, fmt::format("a stride of {} bytes is less than a box", input.stride));
    const std::uint64_t needed = std::uint64_t{input.box_count - 1} * input.stride + sizeof(Box);
    if (input.boxes.size() < needed)
      reject(label, number,
             fmt::format("{} boxes need {} bytes, there are {}", input.box_count, needed, input.boxes.size()));
  }
  BoxSet set{.boxes = {}, .flags = input.flags};
  set.boxes.reserve(input.box_count);
  for (std::uint32_t i = 0; i < input.box_count; ++i) {
    Box box;
    std::memcpy(&box, input.boxes.data() + std::size_t{i} * input.stride, sizeof(box));
    bool active = true;
    for (std::size_t axis = 0; axis < 3; ++axis) active = active && box.minimum[axis] <= box.maximum[axis];
    if (!active) box.minimum[0] = std::numeric_limits<float>::quiet_NaN();
    set.boxes.push_back(box);
  }
  return set;
}

}  // namespace

GeometryMesh read_geometry(const GeometryInput& input, std::string_view label, std::size_t number) {
  return std::visit([&](const auto& each) { return GeometryMesh(read(each, label, number)); }, input);
}

}  // namespace tandem::cpu
