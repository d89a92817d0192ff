#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "conformance/kit/check.hpp"
#include "conformance/pipeline/cases.hpp"
#include "conformance/pipeline/program.hpp"

// Rays through the edges and vertices of a closed mesh, from inside. Vulkan, "Watertightness": a ray must not pass
// between two triangles that share an edge or vertex.
namespace tandem::conformance {
namespace {

using namespace pipeline;

// Ray i of a batch goes from a random point near the centre to a point of a random edge of a random triangle: a vertex
// in one of four cases. Both are computed in floats, so that the ray is within rounding of the edge.
const std::string generation_text = R"(
layout(set = 0, binding = 0) uniform accelerationStructureEXT scene;
layout(set = 0, binding = 1, std430) readonly buffer Vertices { float vertices[]; };
layout(set = 0, binding = 2, std430) buffer Counts { uint hit_count; uint miss_count; };
layout(push_constant) uniform Constants { uint first_ray; uint triangle_count; };
layout(location = 0) rayPayloadEXT uint hit;
uint state;
uint next() {
  state = state * 747796405u + 2891336453u;
  uint word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
  return (word >> 22u) ^ word;
}
float next_float() { return float(next() >> 8u) * (1.0 / 16777216.0); }
vec3 vertex(uint index) { return vec3(vertices[3u * index], vertices[3u * index + 1u], vertices[3u * index + 2u]); }
void main() {
  state = first_ray + gl_LaunchIDEXT.x;
  next();
  uint triangle = next() % triangle_count;
  uint corner = next() % 3u;
  vec3 a = vertex(3u * triangle + corner);
  vec3 b = vertex(3u * triangle + (corner + 1u) % 3u);
  float weight = next() % 4u == 0u ? 0.0 : next_float();
  vec3 target = a + (b - a) * weight;
  float x = next_float();
  float y = next_float();
  float z = next_float();
  vec3 origin = (vec3(x, y, z) - 0.5) * 0.25;
  hit = 0u;
  traceRayEXT(scene, gl_RayFlagsOpaqueEXT, 0xffu, 0u, 0u, 0u, origin, 0.0, target - origin, 1e30, 0);
  if (hit == 1u) atomicAdd(hit_count, 1u);
  if (hit == 2u) atomicAdd(miss_count, 1u);
}
)";

/// A sphere of 24 by 48 cells around the origin, poles included.
std::vector<glm::vec3> sphere() {
  constexpr int rows = 24;
  constexpr int columns = 48;
  const auto vertex = [](int row, int column) {
    if (row == 0) return glm::vec3(0, 1, 0);
    if (row == rows) return glm::vec3(0, -1, 0);
    const double polar = std::numbers::pi * row / rows;
    const double azimuth = 2 * std::numbers::pi * (column % columns) / columns;
    return glm::vec3(std::sin(polar) * std::cos(azimuth), std::cos(polar), std::sin(polar) * std::sin(azimuth));
  };
  std::vector<glm::vec3> vertices;
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column) {
      const glm::vec3 upper_left = vertex(row, column);
      const glm::vec3 upper_right = vertex(row, column + 1);
      const glm::vec3 lower_left = vertex(row + 1, column);
      const glm::vec3 lower_right = vertex(row + 1, column + 1);
      if (row != rows - 1) vertices.insert(vertices.end(), {upper_left, lower_left, lower_right});
      if (row != 0) vertices.insert(vertices.end(), {upper_left, lower_right, upper_right});
    }
  return vertices;
}

void closed_mesh(Context& context) {
  rhi::Device& device = context.device();
  const std::vector<glm::vec3> vertices = sphere();
  const Scene scene = build_scene(device, {triangles(device, vertices)});
  const std::string in = "layout(location = 0) rayPayloadInEXT uint hit;\n";
  const auto pipeline = make_pipeline(context,
                                      {.ray_generation = {generation_text},
                                       .miss = {in + "void main() { hit = 2u; }\n"},
                                       .hit_groups = {{.closest_hit = in + "void main() { hit = 1u; }\n"}}},
                                      "watertightness");
  Launch launch;
  launch.scene = scene.top_level;
  launch.buffers = {buffer_of(device, vertices, "vertices"),
                    buffer_of(device, std::vector<std::uint32_t>(2), "counts")};
  const auto ray_count = static_cast<std::uint32_t>(context.settings().watertightness_rays / 4);
  constexpr std::uint32_t rays_per_batch = 1u << 18;
  for (std::uint32_t first = 0; first < ray_count; first += rays_per_batch) {
    const std::array<std::uint32_t, 2> constants = {first, static_cast<std::uint32_t>(vertices.size() / 3)};
    launch.trace.push_constants = std::as_bytes(std::span(constants));
    launch.trace.size = {std::min(rays_per_batch, ray_count - first), 1, 1};
    run(device, pipeline, launch);
  }
  const auto counts = rhi::read<std::uint32_t>(device, launch.buffers[1], 2);
  context.note(fmt::format("{} of {} rays missed", counts[1], ray_count));
  check_equal("rays that a shader heard of", counts[0] + counts[1], ray_count);
  check_equal("rays that left the mesh", counts[1], 0u);
}

}  // namespace

void add_pipeline_watertightness_cases(Cases& cases) {
  const Group group{.cases = cases,
                    .name = "ray_tracing_pipeline.watertightness",
                    .needs = {&rhi::Capabilities::ray_tracing_pipeline}};
  group.add("closed_mesh", "no ray from inside a closed mesh leaves it through an edge or vertex", closed_mesh);
}

}  // namespace tandem::conformance
