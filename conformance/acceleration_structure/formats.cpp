#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/gtc/packing.hpp>
#include <limits>

#include "conformance/kit/cases.hpp"
#include "conformance/kit/check.hpp"
#include "conformance/kit/reference.hpp"
#include "conformance/ray_query/probe.hpp"

/// acceleration_structures.formats: how vertices and indices are stored.
namespace tandem::conformance {
namespace {

using rhi::IndexFormat;
using rhi::VertexFormat;

/// A position as it is stored, and what it means.
struct StoredPosition {
  std::array<std::byte, 12> bytes = {};
  glm::dvec3 meaning = {};
};

StoredPosition store(VertexFormat format, const glm::vec3& position) {
  StoredPosition stored;
  for (int i = 0; i < 3; ++i) {
    if (format == VertexFormat::float3) {
      std::memcpy(&stored.bytes[static_cast<std::size_t>(i) * 4], &position[i], 4);
      stored.meaning[i] = position[i];
    } else if (format == VertexFormat::half3) {
      const std::uint16_t half = glm::packHalf1x16(position[i]);
      std::memcpy(&stored.bytes[static_cast<std::size_t>(i) * 2], &half, 2);
      stored.meaning[i] = glm::unpackHalf1x16(half);
    } else {
      const auto integer = static_cast<std::int16_t>(std::lround(position[i] * 32767));
      std::memcpy(&stored.bytes[static_cast<std::size_t>(i) * 2], &integer, 2);
      stored.meaning[i] = std::max(integer / 32767.0, -1.0);
    }
  }
  return stored;
}

struct Layout {
  VertexFormat format = VertexFormat::float3;
  std::uint32_t stride = 12;
  IndexFormat indices = IndexFormat::none;
  std::uint32_t vertex_offset = 0;  ///< bytes
  std::uint32_t index_offset = 0;   ///< bytes
};

/// Two triangles that share an edge, not in one plane.
const std::vector<glm::vec3> corners = {
    {-0.75f, -0.5f, 0.25f}, {0.5f, -0.625f, 0.125f}, {-0.5f, 0.875f, -0.25f}, {0.6f, 0.7f, 0.5f}};
const std::vector<std::uint32_t> quad_indices = {0, 1, 2, 1, 3, 2};

void append(std::vector<std::byte>& bytes, const void* data, std::size_t size) {
  const auto* const begin = static_cast<const std::byte*>(data);
  bytes.insert(bytes.end(), begin, begin + size);
}

/// The quad in this layout. Gaps are filled with bytes of ones, which are NaNs.
rhi::TriangleGeometry quad(rhi::Device& device, const Layout& layout) {
  std::vector<std::byte> vertices(layout.vertex_offset, std::byte(0xff));
  const auto append_vertex = [&](std::uint32_t index) {
    const StoredPosition stored = store(layout.format, corners[index]);
    const std::size_t size = rhi::size_of(layout.format);
    append(vertices, stored.bytes.data(), size);
    vertices.resize(vertices.size() + layout.stride - size, std::byte(0xff));
  };
  std::vector<std::byte> indices(layout.index_offset, std::byte(0xff));
  rhi::TriangleGeometry geometry;
  if (layout.indices == IndexFormat::none) {
    for (const std::uint32_t index : quad_indices) append_vertex(index);
    geometry.vertex_count = 6;
  } else {
    for (std::uint32_t index = 0; index < 4; ++index) append_vertex(index);
    geometry.vertex_count = 4;
    for (const std::uint32_t index : quad_indices) {
      const auto narrow = static_cast<std::uint16_t>(index);
      if (layout.indices == IndexFormat::uint16) append(indices, &narrow, 2);
      if (layout.indices == IndexFormat::uint32) append(indices, &index, 4);
    }
    geometry.indices = {buffer_of(device, indices, "indices"), layout.index_offset};
  }
  geometry.vertices = {buffer_of(device, vertices, "vertices"), layout.vertex_offset};
  geometry.vertex_stride = layout.stride;
  geometry.vertex_format = layout.format;
  geometry.index_format = layout.indices;
  geometry.triangle_count = 2;
  return geometry;
}

/// Rays through both triangles against the reference.
void check_layout(Context& context, const Layout& layout) {
  const Scene scene = build_scene(context.device(), {quad(context.device(), layout)});
  std::vector<Ray> rays;
  std::vector<TriangleHit> expected;
  for (std::uint32_t primitive = 0; primitive < 2; ++primitive) {
    std::array<glm::dvec3, 3> triangle;
    for (std::size_t i = 0; i < 3; ++i)
      triangle[i] = store(layout.format, corners[quad_indices[primitive * 3 + i]]).meaning;
    for (const auto& [u, v] : {std::pair(0.3, 0.3), {0.1, 0.1}, {0.8, 0.1}, {0.1, 0.8}}) {
      const glm::dvec3 target = triangle[0] * (1 - u - v) + triangle[1] * u + triangle[2] * v;
      rays.push_back({.origin = glm::vec3(target) + glm::vec3(0.5f, 0.25f, 3), .direction = {-0.5f, -0.25f, -3}});
      expected.push_back(intersect(triangle, rays.back().origin, rays.back().direction).value());
    }
  }
  const std::vector<Traversal> seen = trace(context, scene.top_level, rays);
  for (std::uint32_t i = 0; i < rays.size(); ++i) {
    const std::string what = fmt::format("ray {}", i);
    check_triangle(what, seen[i], {.primitive = i / 4}, expected[i].t);
    check_close(what + ": the first barycentric", seen[i].committed.barycentrics.x, expected[i].u, 1);
    check_close(what + ": the second barycentric", seen[i].committed.barycentrics.y, expected[i].v, 1);
  }
}

std::string_view name_of(VertexFormat format) {
  switch (format) {
    case VertexFormat::float3:
      return "float3";
    case VertexFormat::half3:
      return "half3";
    case VertexFormat::snorm3:
      return "snorm3";
  }
  return "";
}

std::string_view name_of(IndexFormat format) {
  switch (format) {
    case IndexFormat::none:
      return "no_indices";
    case IndexFormat::uint16:
      return "uint16";
    case IndexFormat::uint32:
      return "uint32";
  }
  return "";
}

void add_layout_cases(const Group& group) {
  const auto add = [&](const std::string& name, const std::string& behaviour, const Layout& layout) {
    group.add(name, behaviour, [layout](Context& context) { check_layout(context, layout); });
  };
  for (const VertexFormat format : {VertexFormat::float3, VertexFormat::half3, VertexFormat::snorm3}) {
    const std::uint32_t size = rhi::size_of(format);
    for (const IndexFormat indices : {IndexFormat::none, IndexFormat::uint16, IndexFormat::uint32})
      add(fmt::format("{}_{}", name_of(format), name_of(indices)),
          fmt::format("{} positions, {}", name_of(format),
                      indices == IndexFormat::none ? "three a triangle" : "shared by indices"),
          {.format = format, .stride = size, .indices = indices});
    add(fmt::format("{}_padded", name_of(format)), "positions may have a component that is not read",
        {.format = format, .stride = size / 3 * 4, .indices = IndexFormat::uint16});
    add(fmt::format("{}_stride", name_of(format)), "other data may lie between positions",
        {.format = format, .stride = size * 4, .indices = IndexFormat::uint32});
    add(fmt::format("{}_offsets", name_of(format)), "positions and indices may begin inside their buffers",
        {.format = format,
         .stride = size * 2,
         .indices = IndexFormat::uint16,
         .vertex_offset = 36,
         .index_offset = 10});
  }
}

/// A row of triangles, one of them without a hit: the others keep their numbers.
void check_row(Context& context, std::vector<glm::vec3> vertices, std::uint32_t missing) {
  const Scene scene = build_scene(context.device(), {triangles(context.device(), vertices)});
  std::vector<Ray> rays;
  for (std::uint32_t i = 0; i < vertices.size() / 3; ++i)
    rays.push_back({.origin = {2 * static_cast<float>(i) + 0.25f, 0.25f, 5}});
  const std::vector<Traversal> seen = trace(context, scene.top_level, rays);
  for (std::uint32_t i = 0; i < rays.size(); ++i) {
    const std::string what = fmt::format("the ray at triangle {}", i);
    if (i == missing) {
      check_miss(what, seen[i]);
    } else {
      check_triangle(what, seen[i], {.primitive = i}, 5);
    }
  }
}

std::vector<glm::vec3> row_of_triangles(std::uint32_t count) {
  std::vector<glm::vec3> vertices;
  for (std::uint32_t i = 0; i < count; ++i)
    for (const glm::vec3& corner : triangle_at({2 * static_cast<float>(i), 0, 0})) vertices.push_back(corner);
  return vertices;
}

void add_special_triangle_cases(const Group& group) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  constexpr const char* names[] = {"nan_first_vertex", "nan_second_vertex", "nan_third_vertex"};
  for (std::uint32_t corner = 0; corner < 3; ++corner) {
    group.add(names[corner],
              "a triangle with a NaN as a vertex's first component is never met, and the others keep their "
              "numbers",
              [corner, nan](Context& context) {
                std::vector<glm::vec3> vertices = row_of_triangles(4);
                vertices[3 + corner].x = nan;
                check_row(context, vertices, 1);
              });
  }
  group.add("nan_all", "a triangle of NaNs alone is never met, and the others keep their numbers",
            [nan](Context& context) {
              std::vector<glm::vec3> vertices = row_of_triangles(4);
              for (std::size_t i = 6; i < 9; ++i) vertices[i] = glm::vec3(nan);
              check_row(context, vertices, 2);
            });
  group.add("only_inactive", "a structure of inactive triangles alone is never met", [nan](Context& context) {
    check_row(context, {{nan, 0, 0}, {nan, 0, 0}, {nan, 0, 0}}, 0);
  });
  group.add("degenerate_line", "a triangle whose corners lie on a line is never met", [](Context& context) {
    std::vector<glm::vec3> vertices = row_of_triangles(3);
    vertices[3] = {2, 0, 0};
    vertices[4] = {2.5f, 0.5f, 0};
    vertices[5] = {3, 1, 0};
    check_row(context, vertices, 1);
  });
  group.add("degenerate_point", "a triangle whose corners are one point is never met", [](Context& context) {
    std::vector<glm::vec3> vertices = row_of_triangles(3);
    vertices[3] = vertices[4] = vertices[5] = {2.25f, 0.25f, 0};
    check_row(context, vertices, 1);
  });
  group.add("repeated_index", "a triangle that names a vertex twice is never met, and the others keep their numbers",
            [](Context& context) {
              rhi::Device& device = context.device();
              rhi::TriangleGeometry geometry = triangles(device, row_of_triangles(3));
              geometry.indices = {buffer_of(device, std::vector<std::uint32_t>{0, 1, 2, 3, 4, 4, 6, 7, 8}, "indices")};
              geometry.index_format = IndexFormat::uint32;
              const Scene scene = build_scene(device, {geometry});
              check_triangle("the ray", trace(context, scene.top_level, Ray{.origin = {4.25f, 0.25f, 5}}),
                             {.primitive = 2}, 5);
              check_miss("the ray", trace(context, scene.top_level, Ray{.origin = {2.25f, 0.25f, 5}}));
            });
  group.add("large_index", "indices of 16 bits reach vertex 65535", [](Context& context) {
    rhi::Device& device = context.device();
    std::vector<glm::vec3> vertices(65536, glm::vec3(50));
    const std::vector<glm::vec3> triangle = triangle_at({0, 0, 0});
    vertices[0] = triangle[0];
    vertices[32768] = triangle[1];
    vertices[65535] = triangle[2];
    rhi::TriangleGeometry geometry = triangles(device, vertices);
    geometry.indices = {buffer_of(device, std::vector<std::uint16_t>{0, 32768, 65535, 0}, "indices")};
    geometry.index_format = IndexFormat::uint16;
    geometry.triangle_count = 1;
    const Scene scene = build_scene(device, {geometry});
    check_triangle("the ray", trace(context, scene.top_level, Ray{}), {}, 5);
  });
  group.add("shared_vertex_buffer", "geometries may share one buffer of vertices", [](Context& context) {
    rhi::Device& device = context.device();
    rhi::TriangleGeometry first = triangles(device, row_of_triangles(2));
    rhi::TriangleGeometry second = first;
    first.vertices.size = 36;
    second.vertices.offset = 36;
    first.vertex_count = second.vertex_count = 3;
    first.triangle_count = second.triangle_count = 1;
    const Scene scene = build_scene(device, {first, second});
    for (std::uint32_t i = 0; i < 2; ++i)
      check_triangle("the ray",
                     trace(context, scene.top_level, Ray{.origin = {2 * static_cast<float>(i) + 0.25f, 0.25f, 5}}),
                     {.geometry = i}, 5);
  });
}

}  // namespace

void add_acceleration_structure_format_cases(Cases& cases) {
  const Group group = {cases, "acceleration_structures.formats"};
  add_layout_cases(group);
  add_special_triangle_cases({cases, "acceleration_structures.special_triangles"});
}

}  // namespace tandem::conformance
