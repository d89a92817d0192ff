#include "tests/shaders/test_scene.hpp"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <string>
#include <utility>

#include <glm/geometric.hpp>

#include "pathtracer/render/features.hpp"
#include "tests/support/device_test.hpp"

namespace tandem::test {

using pathtracer::GpuMaterial;
using pathtracer::MaterialModel;

std::uint32_t TestScene::add_material(const GpuMaterial& material) {
  materials.push_back(material);
  return static_cast<std::uint32_t>(materials.size() - 1);
}

void TestScene::add_quad(const glm::vec3& origin, const glm::vec3& u, const glm::vec3& v, std::uint32_t material) {
  const auto first = static_cast<std::uint32_t>(positions.size());
  positions.insert(positions.end(), {origin, origin + u, origin + u + v, origin + v});
  triangles.push_back({.vertices = {first, first + 1, first + 2}, .material = material});
  triangles.push_back({.vertices = {first, first + 2, first + 3}, .material = material});
}

void TestScene::add_sphere(const glm::dvec3& centre, double radius, int subdivisions, std::uint32_t material) {
  normals.resize(positions.size());
  for (const glm::dvec3 sign :
       {glm::dvec3{1, 1, 1}, {-1, 1, 1}, {1, -1, 1}, {1, 1, -1}, {-1, -1, 1}, {-1, 1, -1}, {1, -1, -1}, {-1, -1, -1}}) {
    // Vertices on an edge of the octahedron are computed twice, with the same bits: the sphere is closed.
    const auto corner = [&](int x, int y) {
      const glm::dvec3 normal = glm::normalize(sign * glm::dvec3(x, y, subdivisions - x - y));
      positions.emplace_back(centre + radius * normal);
      normals.emplace_back(normal);
      return static_cast<std::uint32_t>(positions.size() - 1);
    };
    const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
      if (sign.x * sign.y * sign.z < 0) std::swap(b, c);
      triangles.push_back({.vertices = {a, b, c}, .material = material});
    };
    for (int x = 0; x < subdivisions; ++x)
      for (int y = 0; x + y < subdivisions; ++y) {
        const std::uint32_t b = corner(x + 1, y), c = corner(x, y + 1);
        add(corner(x, y), b, c);
        if (x + y + 1 < subdivisions) add(b, corner(x + 1, y + 1), c);
      }
  }
}

void TestScene::add_box(const glm::vec3& minimum, const glm::vec3& maximum, std::uint32_t material) {
  const glm::vec3 size = maximum - minimum;
  const glm::vec3 x(size.x, 0, 0), y(0, size.y, 0), z(0, 0, size.z);
  add_quad(minimum, y, x, material);
  add_quad(minimum + z, x, y, material);
  add_quad(minimum, x, z, material);
  add_quad(minimum + y, z, x, material);
  add_quad(minimum, z, y, material);
  add_quad(minimum + x, y, z, material);
}

void TestScene::add_lights() {
  for (std::uint32_t i = 0; i < triangles.size(); ++i) {
    if (materials[triangles[i].material & ~pathtracer::triangle_smooth].emission == glm::vec3(0)) continue;
    lights.push_back({.primitive = i, .alias = static_cast<std::uint32_t>(lights.size()), .threshold = 0xffffffffu});
  }
  for (pathtracer::GpuLight& light : lights) {
    const std::uint32_t* vertices = triangles[light.primitive].vertices;
    const float area = 0.5f * glm::length(glm::cross(positions[vertices[1]] - positions[vertices[0]],
                                                     positions[vertices[2]] - positions[vertices[0]]));
    light.area_density = 1.0f / (static_cast<float>(lights.size()) * area);
    light.probability = 1.0f / static_cast<float>(lights.size());
  }
}

GpuMaterial diffuse(const glm::vec3& albedo, const glm::vec3& emission) {
  GpuMaterial material;
  material.base_color = albedo;
  material.emission = emission;
  return material;
}

GpuMaterial mirror(const glm::vec3& reflectance) {
  GpuMaterial material = diffuse(glm::vec3(0));
  material.model = MaterialModel::mirror;
  material.reflectance = reflectance;
  return material;
}

GpuMaterial glass(float ior) {
  GpuMaterial material = diffuse(glm::vec3(0));
  material.model = MaterialModel::dielectric;
  material.ior = ior;
  return material;
}

DeviceScene upload(rhi::Device& device, const TestScene& scene) {
  DeviceScene result;
  result.positions = buffer_of(device, scene.positions, "positions");
  std::vector<glm::vec3> normals = scene.normals;
  normals.resize(scene.positions.size());
  result.normals = buffer_of(device, normals, "normals");
  result.triangles = buffer_of(device, scene.triangles, "triangles");
  result.materials = buffer_of(device, scene.materials, "materials");
  result.lights =
      buffer_of(device, scene.lights.empty() ? std::vector<pathtracer::GpuLight>(1) : scene.lights, "lights");
  std::vector<std::uint32_t> primitive_lights(scene.triangles.size(), pathtracer::no_light);
  for (std::uint32_t i = 0; i < scene.lights.size(); ++i)
    if (scene.lights[i].kind == pathtracer::LightKind::triangle) primitive_lights[scene.lights[i].primitive] = i;
  result.primitive_lights = buffer_of(device, primitive_lights, "lights of primitives");
  result.environment_cells = buffer_of(
      device,
      scene.environment_cells.empty() ? std::vector<pathtracer::GpuEnvironmentCell>(1) : scene.environment_cells,
      "environment cells");
  result.media = buffer_of(device, scene.media.empty() ? std::vector<pathtracer::GpuMedium>(1) : scene.media, "media");
  result.unused = buffer_of(device, std::vector<std::uint32_t>(256), "not used");

  std::vector<std::uint32_t> indices;
  for (const pathtracer::GpuTriangle& triangle : scene.triangles)
    indices.insert(indices.end(), triangle.vertices, triangle.vertices + 3);
  rhi::TriangleGeometry geometry;
  geometry.vertices = {.buffer = result.positions};
  geometry.vertex_count = static_cast<std::uint32_t>(scene.positions.size());
  geometry.indices = {.buffer = buffer_of(device, indices, "indices")};
  geometry.index_format = rhi::IndexFormat::uint32;
  geometry.triangle_count = static_cast<std::uint32_t>(scene.triangles.size());
  const rhi::BottomLevelDesc bottom_level = {.geometries = {geometry}, .label = "scene"};
  result.bottom_level = device.create_bottom_level(bottom_level);

  const std::vector<rhi::InstanceDesc> instances = {rhi::make_instance(*result.bottom_level)};
  const rhi::TopLevelDesc top_level = {
      .instances = {.buffer = buffer_of(device, instances, "instances")}, .instance_count = 1, .label = "scene"};
  result.top_level = device.create_top_level(top_level);
  rhi::CommandListHandle list = device.create_command_list("build the scene");
  list->build_bottom_level(result.bottom_level, bottom_level);
  list->build_top_level(result.top_level, top_level);
  device.submit(list)->wait();
  return result;
}

RenderConstants render_constants(const glm::vec3& position, std::uint32_t width, std::uint32_t height,
                                 const TestScene& scene) {
  RenderConstants constants;
  constants.camera_position = position;
  constants.seed = 1;
  constants.light_count = static_cast<std::uint32_t>(scene.lights.size());
  constants.resolution = {width, height};
  constants.triangle_count = static_cast<std::uint32_t>(scene.triangles.size());
  constants.opaque_count = constants.triangle_count;
  constants.dispatch.tile_size = {width, height};
  return constants;
}

std::vector<rhi::BindGroupEntry> scene_entries(const rhi::PipelineInterface& interface, const DeviceScene& scene,
                                               const rhi::BufferHandle& constants) {
  const std::map<std::uint32_t, rhi::BufferHandle> buffers = {
      {1, scene.positions},          {2, scene.normals}, {3, scene.triangles},
      {4, scene.materials},          {5, scene.lights},  {9, scene.primitive_lights},
      {11, scene.environment_cells}, {12, scene.media},  {13, constants}};
  std::vector<rhi::BindGroupEntry> entries;
  for (const rhi::ShaderBinding& binding : interface.bindings) {
    if (binding.set != 0) continue;
    const auto known = buffers.find(binding.binding);
    const rhi::BufferRange range{known == buffers.end() ? scene.unused : known->second};
    entries.push_back({.binding = binding.binding, .resource = range});
    if (binding.binding == 0) entries.back().resource = scene.top_level;
  }
  return entries;
}

rhi::ComputePipelineHandle path_trace_pipeline(rhi::Device& device, std::uint32_t features) {
  std::ifstream file(std::filesystem::path(TANDEM_SOURCE_DIRECTORY) / "shaders" / "path_trace.comp");
  const std::string source(std::istreambuf_iterator<char>(file), {});
  std::vector<rhi::SpecializationValue> specialization;
  for (std::uint32_t id = 0; id < pathtracer::feature::count; ++id)
    specialization.push_back({.id = id, .value = features >> id & 1u});
  return compute_pipeline(device, source, "path_trace", specialization);
}

Rendering path_trace(rhi::Device& device, const DeviceScene& scene, const std::vector<RenderConstants>& dispatches) {
  return path_trace(device, path_trace_pipeline(device), scene, dispatches);
}

Rendering path_trace(rhi::Device& device, const rhi::ComputePipelineHandle& pipeline, const DeviceScene& scene,
                     const std::vector<RenderConstants>& dispatches) {
  const std::size_t pixel_count = std::size_t{dispatches.front().resolution.x} * dispatches.front().resolution.y;
  const rhi::BufferHandle sum = buffer_of(device, std::vector<float>(3 * pixel_count), "radiance sum");
  const rhi::BufferHandle counts = buffer_of(device, std::vector<std::uint32_t>(pixel_count), "ray counts");
  const auto whole = [](const rhi::BufferHandle& buffer) { return rhi::BufferRange{.buffer = buffer}; };
  const rhi::BindGroupHandle film_group = device.create_bind_group(
      {.pipeline = pipeline,
       .set = 1,
       .entries = {{.binding = 0, .resource = whole(sum)}, {.binding = 1, .resource = whole(counts)}},
       .label = "film"});
  rhi::CommandListHandle list = device.create_command_list("path trace");
  for (const RenderConstants& constants : dispatches) {
    const rhi::BufferHandle buffer =
        buffer_of(device, std::vector<pathtracer::RenderConstants>{constants}, "render constants");
    const rhi::BindGroupHandle scene_group =
        device.create_bind_group({.pipeline = pipeline,
                                  .set = 0,
                                  .entries = scene_entries(pipeline->interface(), scene, buffer),
                                  .label = "scene"});
    const pathtracer::DispatchConstants& dispatch = constants.dispatch;
    list->dispatch({.pipeline = pipeline,
                    .bind_groups = {scene_group, film_group},
                    .push_constants = std::as_bytes(std::span(&dispatch, 1)),
                    .workgroup_count = {(dispatch.tile_size.x + 7) / 8, (dispatch.tile_size.y + 7) / 8, 1}});
  }
  device.submit(list)->wait();
  return {.radiance_sum = contents<float>(device, sum, 3 * pixel_count),
          .ray_counts = contents<std::uint32_t>(device, counts, pixel_count)};
}

}  // namespace tandem::test
