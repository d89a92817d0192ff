#include <doctest/doctest.h>

#include <array>
#include <bit>

#include "tests/rhi/ray_probe.hpp"
#include "tests/support/device_test.hpp"

// A shader as renderers for GPUs usually have them, taken as it is: scalar layout, buffer references, arrays of buffers
// indexed non-uniformly, a storage image, push and specialisation constants, and ray queries handed to functions.

using namespace tandem;
using test::contents;

namespace {

const std::string ambient_occlusion = R"(#version 460
#extension GL_EXT_ray_query : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference2 : require
#extension GL_EXT_nonuniform_qualifier : require

layout(local_size_x_id = 0, local_size_y_id = 1) in;
layout(constant_id = 2) const uint SAMPLE_COUNT = 1;
layout(constant_id = 3) const float MAX_DISTANCE = 1.0;

struct Vertex { vec3 position; vec3 normal; float ao; };
struct Material { vec3 color; uint flags; };

layout(buffer_reference, scalar) readonly buffer VertexBuffer { Vertex v[]; };
layout(buffer_reference, scalar) readonly buffer IndexBuffer { uvec3 i[]; };

struct Mesh { VertexBuffer vertices; IndexBuffer indices; uint material; };

layout(set = 0, binding = 0) uniform accelerationStructureEXT tlas;
layout(set = 0, binding = 1, rgba32f) uniform image2D outImage;
layout(set = 0, binding = 2, scalar) readonly buffer Meshes { Mesh meshes[]; };
layout(set = 1, binding = 0, scalar) readonly buffer Materials { Material material; } materials[2];

layout(push_constant, scalar) uniform Push { vec3 eye; uint frame; vec2 scale; } push;

bool traceClosest(rayQueryEXT rq, vec3 origin, vec3 direction) {
  rayQueryInitializeEXT(rq, tlas, gl_RayFlagsOpaqueEXT, 0xff, origin, 0.001, direction, 1000.0);
  while (rayQueryProceedEXT(rq)) {}
  return rayQueryGetIntersectionTypeEXT(rq, true) != gl_RayQueryCommittedIntersectionNoneEXT;
}

float occlusion(vec3 position, vec3 normal) {
  float visible = 0.0;
  for (uint s = 0; s < SAMPLE_COUNT; ++s) {
    rayQueryEXT shadow;
    vec3 direction = normal + 0.25 * vec3(float(s & 1u), float(s >> 1u), 0.0);
    rayQueryInitializeEXT(shadow, tlas, gl_RayFlagsTerminateOnFirstHitEXT | gl_RayFlagsOpaqueEXT, 0xff, position, 0.001,
                          direction, MAX_DISTANCE);
    rayQueryProceedEXT(shadow);
    if (rayQueryGetIntersectionTypeEXT(shadow, true) == gl_RayQueryCommittedIntersectionNoneEXT) visible += 1.0;
  }
  return visible / float(SAMPLE_COUNT);
}

void main() {
  ivec2 size = imageSize(outImage);
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, size))) return;
  vec3 origin = push.eye + vec3((vec2(pixel) + 0.5) * push.scale, 0.0);
  vec4 color = vec4(0.0, 0.0, 0.0, 1.0);
  rayQueryEXT rq;
  if (traceClosest(rq, origin, vec3(0.0, 0.0, -1.0))) {
    Mesh mesh = meshes[rayQueryGetIntersectionInstanceCustomIndexEXT(rq, true)];
    uvec3 tri = mesh.indices.i[rayQueryGetIntersectionPrimitiveIndexEXT(rq, true)];
    vec2 b = rayQueryGetIntersectionBarycentricsEXT(rq, true);
    vec3 w = vec3(1.0 - b.x - b.y, b.x, b.y);
    vec3 normal = mesh.vertices.v[tri.x].normal;
    float ao = mesh.vertices.v[tri.x].ao * w.x + mesh.vertices.v[tri.y].ao * w.y + mesh.vertices.v[tri.z].ao * w.z;
    vec3 position = origin - vec3(0.0, 0.0, rayQueryGetIntersectionTEXT(rq, true));
    uint id = mesh.material;
    color.rgb = materials[nonuniformEXT(id)].material.color * (ao * occlusion(position, normal));
    color.a = float(materials[nonuniformEXT(id)].material.flags + push.frame);
  }
  imageStore(outImage, pixel, color);
}
)";

}  // namespace

TANDEM_DEVICE_TEST("a shader written for GPUs runs as it is") {
  const rhi::Capabilities& can = device.info().capabilities;
  REQUIRE(can.ray_query);
  REQUIRE(can.buffer_references);
  REQUIRE(can.non_uniform_indexing);
  REQUIRE(can.scalar_block_layout);
  constexpr std::uint32_t size = 16;
  const rhi::ComputePipelineHandle pipeline =
      test::compute_pipeline(device, ambient_occlusion, "ambient occlusion",
                             {{0, 8}, {1, 4}, {2, 4}, {3, std::bit_cast<std::uint32_t>(5.0F)}});

  // Mesh 0: a triangle that covers the lower left half at z = 0. Mesh 1: one at z = 1 over its left quarter, which
  // shades nothing below, because it is hit first.
  const std::vector<float> low = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  const std::vector<float> high = {0, 0, 1, 0.25F, 0, 1, 0, 0.25F, 1};
  // Position, normal and ambient occlusion: 28 bytes each. The occlusion is the same at all corners.
  const auto vertices_of = [&](const std::vector<float>& positions, float occlusion) {
    std::vector<float> values;
    for (std::size_t i = 0; i < 3; ++i)
      values.insert(values.end(), {positions[3 * i], positions[3 * i + 1], positions[3 * i + 2], 0, 0, 1, occlusion});
    return test::buffer_of(device, values, "vertices");
  };
  const rhi::BufferHandle vertices[2] = {vertices_of(low, 0.5F), vertices_of(high, 1.0F)};
  const rhi::BufferHandle indices = test::buffer_of(device, std::vector<std::uint32_t>{0, 1, 2}, "indices");
  struct Mesh {
    std::uint64_t vertices;
    std::uint64_t indices;
    std::uint32_t material;
    std::uint32_t padding;
  };
  const std::vector<Mesh> mesh_list = {{vertices[0]->device_address(), indices->device_address(), 1, 0},
                                       {vertices[1]->device_address(), indices->device_address(), 0, 0}};
  const rhi::BufferHandle meshes = test::buffer_of(device, mesh_list, "meshes");
  const auto material = [&](float red, float flags) {
    const std::vector<float> values = {red, 0.25F, 0.5F, flags};
    return test::buffer_of(device, values, "material");
  };
  const rhi::BufferHandle materials[2] = {material(1.0F, std::bit_cast<float>(10u)),
                                          material(0.75F, std::bit_cast<float>(20u))};
  const rhi::AccelerationStructureHandle bottom_levels[2] = {
      test::build_bottom_level(device, {test::triangles_of(device, low)}),
      test::build_bottom_level(device, {test::triangles_of(device, high)})};
  std::vector<rhi::InstanceDesc> instances = {rhi::make_instance(*bottom_levels[0]),
                                              rhi::make_instance(*bottom_levels[1])};
  instances[1].custom_index = 1;
  const rhi::AccelerationStructureHandle top_level = test::build_top_level(device, instances);
  const rhi::TextureHandle image =
      device.create_texture({.format = rhi::TextureFormat::rgba32_float, .size = {size, size, 1}, .label = "image"});

  const rhi::BindGroupHandle groups[2] = {
      device.create_bind_group({.pipeline = pipeline,
                                .set = 0,
                                .entries = {{.binding = 0, .resource = top_level},
                                            {.binding = 1, .resource = image},
                                            {.binding = 2, .resource = rhi::BufferRange{meshes}}},
                                .label = "scene"}),
      device.create_bind_group(
          {.pipeline = pipeline,
           .set = 1,
           .entries = {{.binding = 0, .resource = rhi::BufferRange{materials[0]}, .array_element = 0},
                       {.binding = 0, .resource = rhi::BufferRange{materials[1]}, .array_element = 1}},
           .label = "materials"})};
  struct Push {
    std::array<float, 3> eye = {0, 0, 5};
    std::uint32_t frame = 3;
    std::array<float, 2> scale = {1.0F / size, 1.0F / size};
  };
  const Push push;
  const rhi::BufferHandle texels = test::buffer_of(device, std::vector<float>(4 * size * size), "texels");
  const rhi::CommandListHandle list = device.create_command_list("ambient occlusion");
  list->dispatch({.pipeline = pipeline,
                  .bind_groups = {groups[0], groups[1]},
                  .push_constants = std::as_bytes(std::span(&push, 1)),
                  .workgroup_count = {size / 8, size / 4, 1}});
  list->copy_from_texture(image, {texels});
  device.submit(list);

  const std::vector<float> seen = contents<float>(device, texels, 4 * size * size);
  for (std::uint32_t y = 0; y < size; ++y)
    for (std::uint32_t x = 0; x < size; ++x) {
      const float u = (static_cast<float>(x) + 0.5F) / size;
      const float v = (static_cast<float>(y) + 0.5F) / size;
      if (u + v == 1.0F || u + v == 0.25F) continue;  // on an edge: either answer is right
      std::array<float, 4> expected = {0, 0, 0, 1};
      if (u + v < 0.25F) {
        expected = {1.0F, 0.25F, 0.5F, 13};  // nothing above the upper triangle
      } else if (u + v < 1.0F) {
        // The upper triangle is above at distance 1, where the ray of sample s, which leans by 0.25 to the right and
        // up, meets it nowhere: all of it lies below u + v = 0.25.
        expected = {0.75F * 0.5F, 0.25F * 0.5F, 0.5F * 0.5F, 23};
      }
      CAPTURE(x);
      CAPTURE(y);
      // The barycentrics sum to 1 but for rounding, so the occlusion is not exactly that of the corners.
      for (std::size_t channel = 0; channel < 4; ++channel)
        CHECK(seen[(y * size + x) * 4 + channel] == doctest::Approx(expected[channel]).epsilon(1e-5));
    }
}
