#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <numbers>
#include <random>
#include <span>

#include "conformance/kit/cases.hpp"
#include "conformance/kit/check.hpp"
#include "conformance/ray_query/probe.hpp"

/// ray_query.watertightness: a ray that begins inside a closed mesh meets it, also where it leaves at an edge or a
/// vertex (docs/internals/rhi-contract.md). The rays are aimed at just these.
namespace tandem::conformance {
namespace {

/// A closed mesh around the origin, star-shaped, so that every ray from near the origin leaves it.
struct Mesh {
  std::vector<glm::vec3> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  float inner_radius = 0;  ///< of a ball around the origin that lies inside
};

Mesh cube() {
  Mesh mesh;
  for (std::uint32_t i = 0; i < 8; ++i)
    mesh.vertices.push_back({(i & 1) != 0 ? 1 : -1, (i & 2) != 0 ? 1 : -1, (i & 4) != 0 ? 1 : -1});
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  mesh.inner_radius = 0.9f;
  return mesh;
}

/// Rings of vertices between two poles; `radius_of(i)` is the distance of vertex i from the origin.
template <typename RadiusOf>
Mesh globe(std::uint32_t rings, std::uint32_t slices, RadiusOf&& radius_of) {
  Mesh mesh;
  const auto add_vertex = [&](double x, double y, double z) {
    mesh.vertices.push_back(glm::vec3(glm::dvec3(x, y, z) * radius_of(mesh.vertices.size())));
  };
  add_vertex(0, 0, 1);
  for (std::uint32_t ring = 1; ring <= rings; ++ring) {
    const double polar = std::numbers::pi * ring / (rings + 1);
    for (std::uint32_t slice = 0; slice < slices; ++slice) {
      const double azimuth = 2 * std::numbers::pi * slice / slices;
      add_vertex(std::sin(polar) * std::cos(azimuth), std::sin(polar) * std::sin(azimuth), std::cos(polar));
    }
  }
  add_vertex(0, 0, -1);
  const auto vertex = [&](std::uint32_t ring, std::uint32_t slice) { return 1 + (ring - 1) * slices + slice % slices; };
  const auto last = static_cast<std::uint32_t>(mesh.vertices.size() - 1);
  for (std::uint32_t slice = 0; slice < slices; ++slice) {
    mesh.triangles.push_back({0, vertex(1, slice), vertex(1, slice + 1)});
    for (std::uint32_t ring = 1; ring < rings; ++ring) {
      mesh.triangles.push_back({vertex(ring, slice), vertex(ring + 1, slice), vertex(ring + 1, slice + 1)});
      mesh.triangles.push_back({vertex(ring, slice), vertex(ring + 1, slice + 1), vertex(ring, slice + 1)});
    }
    mesh.triangles.push_back({vertex(rings, slice), last, vertex(rings, slice + 1)});
  }
  return mesh;
}

Mesh sphere() {
  Mesh mesh = globe(31, 64, [](std::size_t) { return 1.0; });
  mesh.inner_radius = 0.9f;
  return mesh;
}

/// Slivers: fans of 1000 around two poles.
Mesh fans() {
  Mesh mesh = globe(1, 1000, [](std::size_t) { return 1.0; });
  mesh.inner_radius = 0.5f;
  return mesh;
}

/// Every vertex at a random distance, over three orders of magnitude.
Mesh spikes() {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> exponent(0, 3);
  Mesh mesh = globe(15, 32, [&](std::size_t) { return std::pow(10.0, exponent(random)); });
  mesh.inner_radius = 1e-3f;
  return mesh;
}

const std::string source = R"(#version 460
#extension GL_EXT_ray_query : require
layout(local_size_x = 64) in;
struct Ray { vec4 origin; vec4 direction; };
layout(set = 0, binding = 0) uniform accelerationStructureEXT scene;
layout(set = 0, binding = 1, std430) readonly buffer Rays { Ray rays[]; };
layout(set = 0, binding = 2, std430) writeonly buffer Hits { uint hits[]; };
layout(push_constant) uniform Constants { uint ray_count; };
void main() {
  uint index = gl_GlobalInvocationID.x;
  if (index >= ray_count) return;
  rayQueryEXT query;
  rayQueryInitializeEXT(query, scene, 0u, 0xffu, rays[index].origin.xyz, 0.0, rays[index].direction.xyz, 1e30);
  rayQueryProceedEXT(query);
  hits[index] = rayQueryGetIntersectionTypeEXT(query, true);
}
)";

struct PaddedRay {
  glm::vec3 origin;
  float padding_1 = 0;
  glm::vec3 direction;
  float padding_2 = 0;
};

/// A ray from a random point near the origin to a vertex, or to a point of an edge, of a random triangle.
PaddedRay random_ray(const Mesh& mesh, std::mt19937& random) {
  std::uniform_real_distribution<float> signed_unit(-1, 1);
  std::uniform_real_distribution<float> unit(0, 1);
  const auto& triangle = mesh.triangles[random() % mesh.triangles.size()];
  const std::uint32_t corner = static_cast<std::uint32_t>(random() % 3);
  const glm::vec3 a = mesh.vertices[triangle[corner]];
  const glm::vec3 b = mesh.vertices[triangle[(corner + 1) % 3]];
  const glm::vec3 target = random() % 2 == 0 ? a : a + unit(random) * (b - a);
  // 0.57 < 1 / sqrt(3): the corners of this cube lie in the ball.
  const float size = 0.57f * mesh.inner_radius;
  const glm::vec3 origin = size * glm::vec3(signed_unit(random), signed_unit(random), signed_unit(random));
  return {.origin = origin, .direction = target - origin};
}

constexpr std::uint64_t most_rays_at_once = 1 << 18;
constexpr std::uint64_t mesh_count = 5;

rhi::TriangleGeometry geometry_of(rhi::Device& device, const Mesh& mesh) {
  rhi::TriangleGeometry geometry = triangles(device, mesh.vertices);
  geometry.indices = {buffer_of(device, mesh.triangles, "indices")};
  geometry.index_format = rhi::IndexFormat::uint32;
  geometry.triangle_count = static_cast<std::uint32_t>(mesh.triangles.size());
  return geometry;
}

void check_watertight(Context& context, const Mesh& mesh, const Transform& transform) {
  rhi::Device& device = context.device();
  const Scene scene = build_scene(device, {geometry_of(device, mesh)}, transform);
  const glm::mat3x3 linear(transform[0], transform[4], transform[8], transform[1], transform[5], transform[9],
                           transform[2], transform[6], transform[10]);
  const glm::vec3 place(transform[3], transform[7], transform[11]);
  const rhi::ComputePipelineHandle pipeline = context.compute_pipeline(source, "watertightness");
  std::mt19937 random(11);
  const std::uint64_t ray_count = context.settings().watertightness_rays / mesh_count;
  std::uint64_t misses = 0;
  std::string first_miss;
  for (std::uint64_t done = 0; done < ray_count;) {
    const auto count = static_cast<std::uint32_t>(std::min(most_rays_at_once, ray_count - done));
    std::vector<PaddedRay> rays;
    for (std::uint32_t i = 0; i < count; ++i) {
      const PaddedRay ray = random_ray(mesh, random);
      rays.push_back({.origin = linear * ray.origin + place, .direction = linear * ray.direction});
    }
    const rhi::BufferHandle hits = buffer_of(device, std::vector<std::uint32_t>(count), "hits");
    const rhi::BindGroupHandle group = device.create_bind_group(
        {.pipeline = pipeline,
         .entries = {{.binding = 0, .resource = scene.top_level},
                     {.binding = 1, .resource = rhi::BufferRange{buffer_of(device, rays, "rays")}},
                     {.binding = 2, .resource = rhi::BufferRange{hits}}},
         .label = "watertightness"});
    const rhi::CommandListHandle list = device.create_command_list("watertightness");
    list->dispatch({.pipeline = pipeline,
                    .bind_groups = {group},
                    .push_constants = std::as_bytes(std::span(&count, 1)),
                    .workgroup_count = {(count + 63) / 64, 1, 1}});
    device.submit(list);
    const std::vector<std::uint32_t> seen = rhi::read<std::uint32_t>(device, hits, count);
    for (std::uint32_t i = 0; i < count; ++i) {
      if (seen[i] != committed_type::none) continue;
      if (misses == 0)
        first_miss =
            fmt::format("origin ({:a}, {:a}, {:a}), direction ({:a}, {:a}, {:a})", rays[i].origin.x, rays[i].origin.y,
                        rays[i].origin.z, rays[i].direction.x, rays[i].direction.y, rays[i].direction.z);
      ++misses;
    }
    done += count;
  }
  context.note(fmt::format("{} of {} rays missed", misses, ray_count));
  check(misses == 0,
        fmt::format("{} of {} rays missed a closed mesh, the first with {}", misses, ray_count, first_miss));
}

}  // namespace

void add_ray_query_watertightness_cases(Cases& cases) {
  const Group group = {cases, "ray_query.watertightness"};
  const auto add = [&](const char* name, const char* behaviour, Mesh (*make)(), const Transform& transform) {
    group.add(name, behaviour, [=](Context& context) { check_watertight(context, make(), transform); });
  };
  add("cube", "no ray leaves a cube through its edges or corners", cube, identity);
  add("sphere", "no ray leaves a sphere of 3968 triangles through its edges or vertices", sphere, identity);
  add("fans", "no ray leaves a mesh of slivers through its edges or the two poles that all share", fans, identity);
  add("spikes", "no ray leaves a mesh of random spikes through its edges or vertices", spikes, identity);
  add("transformed_sphere", "no ray leaves a rotated, scaled, sheared and moved sphere through its edges or vertices",
      sphere, {1.5f, -0.25f, 0.5f, 40, 0.75f, 1.25f, 0, -3, -0.5f, 0.25f, 2, 7});
}

}  // namespace tandem::conformance
