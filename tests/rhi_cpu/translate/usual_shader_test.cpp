// One shader as programs for GPUs have them, all at once: buffers in scalar layout, buffer references, arrays of
// descriptors under non-uniform indices, a storage image, push and specialisation constants, and a ray query that is
// passed to functions.

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "rhi/texture.hpp"
#include "rhi_cpu/kernel/trace.hpp"
#include "tests/rhi_cpu/translate/kernel_harness.hpp"

namespace {

namespace kernel = tandem::kernel;
using tandem::test::Kernel;
using tandem::test::KernelOptions;
using tandem::test::resource;

constexpr const char* source = R"(
#extension GL_EXT_ray_query : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_nonuniform_qualifier : require
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require

layout(local_size_x_id = 0, local_size_y_id = 1) in;
layout(constant_id = 2) const bool only_hits = false;
layout(constant_id = 3) const uint material_count = 1;

struct Material { vec3 color; uint texture; mat2x3 basis; };
layout(buffer_reference, scalar) readonly buffer Vertices { vec3 position[]; };
layout(buffer_reference, scalar) readonly buffer Indices { uvec3 triangle[]; };
struct Mesh { Vertices vertices; Indices indices; uint material; };

layout(set = 0, binding = 0) uniform accelerationStructureEXT scene;
layout(set = 0, binding = 1, rgba32f) uniform writeonly image2D picture;
layout(set = 1, binding = 0, scalar) readonly buffer Meshes { Mesh meshes[]; };
layout(set = 1, binding = 1, scalar) readonly buffer Materials { Material materials[2]; } material_sets[3];
layout(set = 1, binding = 2, scalar) uniform Scales { vec3 scale; float gain; } scales[2];
layout(push_constant, scalar) uniform Push { vec3 eye; uint set; uint64_t meshes_address; } push;

bool closest(rayQueryEXT query, vec3 origin, vec3 direction) {
  rayQueryInitializeEXT(query, scene, gl_RayFlagsOpaqueEXT, 0xff, origin, 0.0, direction, 100.0);
  while (rayQueryProceedEXT(query)) {}
  return rayQueryGetIntersectionTypeEXT(query, true) == gl_RayQueryCommittedIntersectionTriangleEXT;
}

vec3 corner(rayQueryEXT query, uint k) {
  Mesh mesh = meshes[rayQueryGetIntersectionInstanceCustomIndexEXT(query, true)];
  uvec3 triangle = mesh.indices.triangle[rayQueryGetIntersectionPrimitiveIndexEXT(query, true)];
  return mesh.vertices.position[triangle[k]];
}

void main() {
  if (any(greaterThanEqual(gl_GlobalInvocationID.xy, uvec2(imageSize(picture))))) return;
  uint n = gl_GlobalInvocationID.x + gl_GlobalInvocationID.y;
  rayQueryEXT query;
  vec4 color = vec4(-1);
  if (closest(query, push.eye, vec3(0, 0, gl_GlobalInvocationID.y == 0 ? 1 : -1))) {
    uint which = meshes[rayQueryGetIntersectionInstanceCustomIndexEXT(query, true)].material % material_count;
    Material material = material_sets[nonuniformEXT(push.set + n)].materials[which];
    color.rgb = material.color * scales[nonuniformEXT(n % 2)].scale + corner(query, n) + material.basis[1];
    color.a = scales[nonuniformEXT(n % 2)].gain + float(push.meshes_address);
  } else if (only_hits) {
    return;
  }
  imageStore(picture, ivec2(gl_GlobalInvocationID.xy), color);
})";

/// Every ray towards +z hits triangle 1 of the instance with custom index 1.
bool closest(const kernel::TopLevel&, const kernel::Ray& ray, kernel::Hit& hit) {
  hit = {.t = 1,
         .barycentrics = {0, 0},
         .instance_index = 0,
         .geometry_index = 0,
         .primitive_index = 1,
         .front_face = true,
         .opaque = true,
         .is_box = false};
  return ray.direction[2] > 0;
}

TEST_CASE("a shader with all that programs for GPUs use") {
  constexpr kernel::TraceFunctions functions = {closest, nullptr, nullptr, nullptr, nullptr, nullptr};
  constexpr kernel::Instance instance = {{}, {}, 1, 0};
  const kernel::TopLevel scene = {&functions, &instance, 1, true, false};
  for (const bool only_hits : {false, true}) {
    KernelOptions options;
    options.specialization = {{0, 2}, {1, 4}, {2, only_hits}, {3, 2}};
    const Kernel kernel(source, options);
    CHECK(kernel.info().workgroup_size[0] == 2);
    CHECK(kernel.info().workgroup_size[1] == 4);
    CHECK(kernel.info().push_constant_size == 24);

    const std::vector<float> vertices = {0, 0, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9};
    const std::vector<std::uint32_t> indices = {0, 0, 0, 1, 3, 2};
    struct Mesh {
      std::uint64_t vertices, indices;
      std::uint32_t material, unused;
    };
    std::vector<Mesh> meshes = {
        {},
        {reinterpret_cast<std::uintptr_t>(vertices.data()), reinterpret_cast<std::uintptr_t>(indices.data()), 3, 0}};
    // color, texture and basis: 40 bytes; two materials in each of three sets
    std::array<std::vector<float>, 3> materials;
    for (std::size_t s = 0; s < 3; ++s) {
      materials[s].assign(20, 0);
      for (std::size_t c = 0; c < 3; ++c) {
        materials[s][10 + c] = static_cast<float>(10 * s + c);
        materials[s][10 + 7 + c] = 1000;
      }
    }
    std::array<std::vector<float>, 2> scales = {{{1, 1, 1, 0.25f}, {100, 100, 100, 0.5f}}};
    std::vector<float> texels(4 * 2 * 2, 77);
    const kernel::Image picture = {reinterpret_cast<std::byte*>(texels.data()),
                                   {2, 2, 1},
                                   static_cast<std::uint32_t>(tandem::rhi::TextureFormat::rgba32_float)};
    struct {
      float eye[3];
      std::uint32_t set;
      std::uint64_t meshes_address;
    } push = {{0, 0, 0}, 1, 2};
    const auto bytes_of = [](const auto& object) {
      return const_cast<std::byte*>(reinterpret_cast<const std::byte*>(&object));
    };
    kernel.run({{bytes_of(scene), 0},
                {bytes_of(picture), 0},
                resource(meshes),
                resource(materials[0]),
                resource(materials[1]),
                resource(materials[2]),
                resource(scales[0]),
                resource(scales[1])},
               {1}, std::as_bytes(std::span(&push, 1)));
    const float rest = only_hits ? 77 : -1;
    CHECK(texels == std::vector<float>{10 * 1 + 1 + 1000, 11 * 1 + 2 + 1000, 12 * 1 + 3 + 1000, 2.25f,       //
                                       20 * 100 + 7 + 1000, 21 * 100 + 8 + 1000, 22 * 100 + 9 + 1000, 2.5f,  //
                                       rest, rest, rest, rest,                                               //
                                       rest, rest, rest, rest});
  }
}

}  // namespace
