#include "pathtracer/device_scene.hpp"

#include <algorithm>
#include <iterator>
#include <limits>
#include <span>

#include <fmt/format.h>

#include "pathtracer/error.hpp"
#include "pathtracer/lights.hpp"

namespace tandem::pathtracer {
namespace {

template <typename T>
rhi::BufferHandle upload_all(rhi::Device& device, rhi::CommandList& list, const std::vector<T>& values,
                             rhi::BufferUsage usage, const std::string& label) {
  const std::span<const std::byte> bytes = std::as_bytes(std::span(values));
  rhi::BufferHandle buffer = device.create_buffer({.size = bytes.size(), .usage = usage, .label = label});
  list.upload(buffer, 0, bytes);
  return buffer;
}

/// No buffer may be empty; the shaders do not read what stands in for nothing.
template <typename T>
std::vector<T> never_empty(std::vector<T> values) {
  if (values.empty()) values.push_back({});
  return values;
}

struct AlphaTexels {
  std::vector<GpuAlphaTexture> textures;
  std::vector<std::uint8_t> texels;  ///< in whole words
};

AlphaTexels alpha_texels(const Scene& scene) {
  AlphaTexels all;
  for (const AlphaTexture& texture : scene.alpha_textures) {
    if (all.texels.size() + texture.texels.size() > std::numeric_limits<std::uint32_t>::max())
      throw Error(fmt::format("the textures of {} have more texels than can be counted", scene.name));
    all.textures.push_back({.first_texel = static_cast<std::uint32_t>(all.texels.size()),
                            .width = texture.width,
                            .height = texture.height});
    all.texels.insert(all.texels.end(), texture.texels.begin(), texture.texels.end());
  }
  constexpr std::size_t word = sizeof(std::uint32_t);
  all.texels.resize((std::max<std::size_t>(all.texels.size(), 1) + word - 1) / word * word);
  return all;
}

}  // namespace

Scene in_device_order(const Scene& scene) {
  Scene sorted = scene;
  std::ranges::stable_partition(sorted.triangles,
                                [&](const GpuTriangle& triangle) { return !is_transparent(scene, triangle); });
  return sorted;
}

DeviceScene::DeviceScene(rhi::Device& device, const Scene& scene)
    : triangle_count_(static_cast<std::uint32_t>(scene.triangles.size())) {
  const auto is_opaque = [&](const GpuTriangle& triangle) { return !is_transparent(scene, triangle); };
  opaque_count_ = static_cast<std::uint32_t>(std::ranges::count_if(scene.triangles, is_opaque));
  if (transparency())
    upload(device, in_device_order(scene));
  else
    upload(device, scene);
}

void DeviceScene::upload(rhi::Device& device, const Scene& scene) {
  using rhi::BufferUsage;
  const std::vector<GpuLight> lights = build_lights(scene);
  light_count_ = static_cast<std::uint32_t>(lights.size());
  const rhi::CommandListHandle list = device.create_command_list("upload of " + scene.name);
  const auto store = [&](const auto& values, const char* label) {
    return upload_all(device, *list, values, BufferUsage::storage, label);
  };
  positions_ = upload_all(device, *list, scene.positions,
                          BufferUsage::storage | BufferUsage::acceleration_structure_input, "positions");
  normals_ = store(scene.normals, "normals");
  triangles_ = store(scene.triangles, "triangles");
  materials_ = store(scene.materials, "materials");
  lights_ = store(never_empty(lights), "lights");
  if (transparency()) {
    const AlphaTexels alpha = alpha_texels(scene);
    texture_coordinates_ = store(never_empty(scene.texture_coordinates), "texture coordinates");
    alpha_textures_ = store(never_empty(alpha.textures), "alpha textures");
    alpha_texels_ = store(alpha.texels, "alpha texels");
  }
  create_structures(device, *list, scene);
  device.submit(list)->wait();
}

void DeviceScene::create_structures(rhi::Device& device, rhi::CommandList& list, const Scene& scene) {
  std::vector<std::uint32_t> indices;
  indices.reserve(3 * scene.triangles.size());
  for (const GpuTriangle& triangle : scene.triangles)
    indices.insert(indices.end(), std::begin(triangle.vertices), std::end(triangle.vertices));
  const rhi::BufferHandle index_buffer =
      upload_all(device, list, indices, rhi::BufferUsage::acceleration_structure_input, "indices");

  // The shaders know a transparent triangle by its geometry's index, so the opaque geometry stays even where it is
  // empty.
  const auto add_geometry = [&](std::uint32_t first, std::uint32_t count, rhi::GeometryFlags flags) {
    rhi::TriangleGeometry geometry;
    geometry.vertices = {positions_};
    geometry.vertex_count = static_cast<std::uint32_t>(scene.positions.size());
    geometry.indices = {index_buffer, 3 * sizeof(std::uint32_t) * std::uint64_t{first}};
    geometry.index_format = rhi::IndexFormat::uint32;
    geometry.triangle_count = count;
    geometry.flags = flags;
    bottom_.geometries.emplace_back(geometry);
  };
  add_geometry(0, opaque_count_, rhi::GeometryFlags::opaque);
  if (transparency()) add_geometry(opaque_count_, triangle_count_ - opaque_count_, rhi::GeometryFlags::none);
  bottom_.label = scene.name;
  bottom_level_ = device.create_bottom_level(bottom_);

  const std::vector<rhi::InstanceDesc> instances = {rhi::make_instance(*bottom_level_)};
  top_.instances.buffer =
      upload_all(device, list, instances, rhi::BufferUsage::acceleration_structure_input, "instances");
  top_.instance_count = 1;
  top_.label = scene.name;
  top_level_ = device.create_top_level(top_);
}

void DeviceScene::record_build(rhi::CommandList& list) {
  list.build_bottom_level(bottom_level_, bottom_);
  list.build_top_level(top_level_, top_);
  bottom_ = {};
  top_ = {};
}

std::vector<rhi::BindGroupEntry> DeviceScene::entries(const rhi::PipelineInterface& interface) const {
  const rhi::BufferHandle buffers[] = {positions_,           normals_,        triangles_,   materials_, lights_,
                                       texture_coordinates_, alpha_textures_, alpha_texels_};
  std::vector<rhi::BindGroupEntry> entries;
  for (const rhi::ShaderBinding& binding : interface.bindings) {
    if (binding.set != 0) continue;
    if (binding.binding == 0)
      entries.push_back({.binding = 0, .resource = top_level_});
    else
      entries.push_back(
          {.binding = binding.binding, .resource = rhi::BufferRange{std::span(buffers)[binding.binding - 1]}});
  }
  return entries;
}

}  // namespace tandem::pathtracer
