#include "pathtracer/render/device_scene.hpp"

#include <algorithm>
#include <iterator>
#include <limits>
#include <span>
#include <utility>

#include <fmt/format.h>
#include <glm/common.hpp>

#include "base/error.hpp"
#include "base/srgb.hpp"
#include "pathtracer/scene/environment.hpp"
#include "rhi/transfer.hpp"

namespace tandem::pathtracer {
namespace {

/// No buffer may be empty; the shaders do not read what stands in for nothing.
template <typename T>
std::vector<T> never_empty(std::vector<T> values) {
  if (values.empty()) values.push_back({});
  return values;
}

constexpr std::size_t word_size = sizeof(std::uint32_t);

/// The images one after the other behind the table of sRGB (scene.glsl), and the textures that know where.
struct TexelStore {
  std::vector<GpuTexture> textures;
  std::vector<std::byte> texels;  ///< in whole words
};

TexelStore store_texels(const Scene& scene) {
  TexelStore store;
  for (int value = 0; value < 256; ++value) {
    const float linear = srgb_decode(static_cast<float>(value) / 255.0f);
    const auto bytes = std::as_bytes(std::span(&linear, 1));
    store.texels.insert(store.texels.end(), bytes.begin(), bytes.end());
  }
  std::vector<std::size_t> offsets;
  for (const TextureImage& image : scene.images) {
    offsets.push_back(store.texels.size());
    store.texels.insert(store.texels.end(), image.texels.begin(), image.texels.end());
    store.texels.resize((store.texels.size() + word_size - 1) / word_size * word_size);
    if (store.texels.size() > std::numeric_limits<std::uint32_t>::max())
      throw Error(fmt::format("the textures of {} need more than 4 GiB of texels", scene.name));
  }
  for (const Texture& texture : scene.textures) {
    GpuTexture gpu = texture.gpu;
    if (gpu.kind == TextureKind::image) {
      const TextureImage& image = scene.images[texture.image];
      gpu.format = image.format;
      gpu.width = image.width;
      gpu.height = image.height;
      const std::size_t unit = image.format == TexelFormat::single_unorm8 ? 1 : word_size;
      gpu.first_word = static_cast<std::uint32_t>(offsets[texture.image] / unit);
    }
    store.textures.push_back(gpu);
  }
  return store;
}

/// The light that each triangle, then each sphere is, or no_light.
std::vector<std::uint32_t> lights_of_primitives(const Scene& scene, std::span<const Emitter> emitters) {
  std::vector<std::uint32_t> of_primitives(scene.triangles.size() + scene.spheres.size(), no_light);
  for (std::size_t i = 0; i < emitters.size(); ++i)
    if (emitters[i].area > 0) of_primitives[emitters[i].light.primitive] = static_cast<std::uint32_t>(i);
  return of_primitives;
}

/// What tells instances apart: their custom index, and the hit record of their primitives.
constexpr std::uint32_t triangle_instance = 0;
constexpr std::uint32_t sphere_instance = 1;

/// The box of each sphere wherever it moves, a little larger, so that no device's rounding loses a ray that touches the
/// sphere.
std::vector<Bounds> boxes_of(const std::vector<GpuSphere>& spheres) {
  constexpr float margin = 1e-5f;
  std::vector<Bounds> boxes;
  boxes.reserve(spheres.size());
  for (const GpuSphere& sphere : spheres) {
    const glm::vec3 end = sphere.centre + sphere.motion;
    const glm::vec3 reach = sphere.radius + margin * (glm::max(glm::abs(sphere.centre), glm::abs(end)) + sphere.radius);
    boxes.push_back({glm::min(sphere.centre, end) - reach, glm::max(sphere.centre, end) + reach});
  }
  return boxes;
}
static_assert(sizeof(Bounds) == 6 * sizeof(float));

rhi::BottomLevelDesc describe_spheres(rhi::Device& device, rhi::CommandList& list, const Scene& scene) {
  rhi::AabbGeometry geometry;
  geometry.boxes = {rhi::create_filled(device, list, boxes_of(scene.spheres),
                                       rhi::BufferUsage::acceleration_structure_input, "boxes of spheres")};
  geometry.box_count = static_cast<std::uint32_t>(scene.spheres.size());
  rhi::BottomLevelDesc desc;
  desc.geometries.emplace_back(geometry);
  desc.label = scene.name + ", spheres";
  return desc;
}

}  // namespace

Scene in_device_order(const Scene& scene) {
  Scene sorted = scene;
  std::stable_partition(sorted.triangles.begin(), sorted.triangles.end(),
                        [&](const GpuTriangle& triangle) { return !is_transparent(scene, triangle); });
  return sorted;
}

DeviceScene::DeviceScene(rhi::Device& device, const Scene& scene)
    : triangle_count_(static_cast<std::uint32_t>(scene.triangles.size())),
      features_(features_of(scene)),
      environment_(scene.environment),
      medium_(scene.medium),
      moves_(
          std::ranges::any_of(scene.spheres, [](const GpuSphere& sphere) { return sphere.motion != glm::vec3(0); })) {
  const auto is_opaque = [&](const GpuTriangle& triangle) { return !is_transparent(scene, triangle); };
  opaque_count_ = static_cast<std::uint32_t>(std::ranges::count_if(scene.triangles, is_opaque));
  if (opaque_count_ < triangle_count_)
    upload(device, in_device_order(scene));
  else
    upload(device, scene);
}

void DeviceScene::upload(rhi::Device& device, const Scene& scene) {
  using rhi::BufferUsage;
  name_ = scene.name;
  emitters_ = scene_emitters(scene);
  radius_ = scene_radius(scene);
  const auto environment = std::ranges::find_if(
      emitters_, [](const Emitter& emitter) { return emitter.light.kind == LightKind::environment; });
  if (environment != emitters_.end()) environment_light_ = static_cast<std::uint32_t>(environment - emitters_.begin());
  const rhi::CommandListHandle list = device.create_command_list("upload of " + scene.name);
  const auto store = [&](auto values, const char* label) {
    return rhi::create_filled(device, *list, never_empty(std::move(values)), BufferUsage::storage, label);
  };
  positions_ = rhi::create_filled(device, *list, never_empty(scene.positions),
                                  BufferUsage::storage | BufferUsage::acceleration_structure_input, "positions");
  normals_ = store(scene.normals, "normals");
  triangles_ = store(scene.triangles, "triangles");
  materials_ = store(scene.materials, "materials");
  upload_lights(device, *list, punctual_emitters(scene.lights, name_, radius_));
  // Shaders with textures built in read them of every vertex, whatever its material.
  std::vector<glm::vec2> texture_coordinates = scene.texture_coordinates;
  texture_coordinates.resize(scene.positions.size(), glm::vec2(0));
  texture_coordinates_ = store(std::move(texture_coordinates), "texture coordinates");
  std::vector<GpuVertexAttributes> attributes = scene.attributes;
  if (!attributes.empty()) attributes.resize(scene.positions.size());
  attributes_ = store(std::move(attributes), "vertex attributes");
  TexelStore texels = store_texels(scene);
  textures_ = store(std::move(texels.textures), "textures");
  texels_ = store(std::move(texels.texels), "texels");
  primitive_lights_ = store(lights_of_primitives(scene, emitters_), "lights of primitives");
  spheres_ = store(scene.spheres, "spheres");
  environment_cells_ = store(pathtracer::environment_cells(scene), "environment cells");
  media_ = store(scene.media, "media");
  create_structures(device, *list, scene);
  device.submit(list)->wait();
}

void DeviceScene::upload_lights(rhi::Device& device, rhi::CommandList& list, std::span<const Emitter> punctual) {
  // Those that stay come first, so that they keep their indices.
  std::vector<Emitter> all = emitters_;
  all.insert(all.end(), punctual.begin(), punctual.end());
  const std::vector<GpuLight> lights = light_table(all);
  lights_ = rhi::create_filled(device, list, never_empty(lights), rhi::BufferUsage::storage, "lights");
  light_count_ = static_cast<std::uint32_t>(lights.size());
}

void DeviceScene::set_lights(rhi::Device& device, std::span<const PunctualLight> lights) {
  const std::vector<Emitter> punctual = punctual_emitters(lights, name_, radius_);
  const rhi::CommandListHandle list = device.create_command_list("lights of " + name_);
  upload_lights(device, *list, punctual);
  device.submit(list)->wait();
  if (!lights.empty()) features_ |= feature::lights;
}

std::uint64_t DeviceScene::structure_bytes() const {
  std::uint64_t bytes = top_level_->sizes().structure;
  for (const BottomLevel& level : bottom_levels_) bytes += level.structure->sizes().structure;
  return bytes;
}

void DeviceScene::describe(RenderConstants& constants) const {
  constants.triangle_count = triangle_count_;
  constants.opaque_count = opaque_count_;
  constants.light_count = light_count_;
  constants.environment_light = environment_light_;
  constants.environment_texture = environment_ ? environment_->texture : no_texture;
  if (environment_) set_environment_frame(constants, *environment_);
  constants.medium = medium_;
  if (moves_) constants.shutter = 1;
}

rhi::BottomLevelDesc DeviceScene::describe_triangles(rhi::Device& device, rhi::CommandList& list,
                                                     const Scene& scene) const {
  rhi::BottomLevelDesc desc;
  std::vector<std::uint32_t> indices;
  indices.reserve(3 * scene.triangles.size());
  for (const GpuTriangle& triangle : scene.triangles)
    indices.insert(indices.end(), std::begin(triangle.vertices), std::end(triangle.vertices));
  const rhi::BufferHandle index_buffer =
      rhi::create_filled(device, list, indices, rhi::BufferUsage::acceleration_structure_input, "indices");

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
    desc.geometries.emplace_back(geometry);
  };
  add_geometry(0, opaque_count_, rhi::GeometryFlags::opaque);
  if (opaque_count_ < triangle_count_)
    add_geometry(opaque_count_, triangle_count_ - opaque_count_, rhi::GeometryFlags::none);
  desc.label = scene.name;
  return desc;
}

void DeviceScene::create_structures(rhi::Device& device, rhi::CommandList& list, const Scene& scene) {
  std::vector<rhi::InstanceDesc> instances;
  const auto add_instance = [&](rhi::BottomLevelDesc desc, std::uint32_t kind) {
    bottom_levels_.push_back({device.create_bottom_level(desc), std::move(desc)});
    rhi::InstanceDesc& instance = instances.emplace_back(rhi::make_instance(*bottom_levels_.back().structure));
    instance.custom_index = kind & 0xffffffu;  // fields of 24 bits
    instance.sbt_offset = kind & 0xffffffu;
  };
  if (!scene.triangles.empty()) add_instance(describe_triangles(device, list, scene), triangle_instance);
  if (!scene.spheres.empty()) add_instance(describe_spheres(device, list, scene), sphere_instance);
  top_.instances.buffer =
      rhi::create_filled(device, list, instances, rhi::BufferUsage::acceleration_structure_input, "instances");
  top_.instance_count = static_cast<std::uint32_t>(instances.size());
  top_.label = scene.name;
  top_level_ = device.create_top_level(top_);
}

void DeviceScene::record_build(rhi::CommandList& list) {
  for (BottomLevel& bottom_level : bottom_levels_) {
    list.build_bottom_level(bottom_level.structure, bottom_level.desc);
    bottom_level.desc = {};
  }
  list.build_top_level(top_level_, top_);
  top_ = {};
}

std::vector<rhi::BindGroupEntry> DeviceScene::entries(const rhi::PipelineInterface& interface,
                                                      const rhi::BufferHandle& constants) const {
  const rhi::BindGroupEntry all[] = {
      {.binding = binding::scene_tlas, .resource = top_level_},
      {.binding = binding::positions, .resource = rhi::BufferRange{positions_}},
      {.binding = binding::normals, .resource = rhi::BufferRange{normals_}},
      {.binding = binding::triangles, .resource = rhi::BufferRange{triangles_}},
      {.binding = binding::materials, .resource = rhi::BufferRange{materials_}},
      {.binding = binding::lights, .resource = rhi::BufferRange{lights_}},
      {.binding = binding::texture_coordinates, .resource = rhi::BufferRange{texture_coordinates_}},
      {.binding = binding::textures, .resource = rhi::BufferRange{textures_}},
      {.binding = binding::texels, .resource = rhi::BufferRange{texels_}},
      {.binding = binding::primitive_lights, .resource = rhi::BufferRange{primitive_lights_}},
      {.binding = binding::spheres, .resource = rhi::BufferRange{spheres_}},
      {.binding = binding::environment_cells, .resource = rhi::BufferRange{environment_cells_}},
      {.binding = binding::media, .resource = rhi::BufferRange{media_}},
      {.binding = binding::render, .resource = rhi::BufferRange{constants}},
      {.binding = binding::attributes, .resource = rhi::BufferRange{attributes_}}};
  std::vector<rhi::BindGroupEntry> used;
  for (const rhi::BindGroupEntry& entry : all)
    if (std::ranges::any_of(interface.bindings, [&](const rhi::ShaderBinding& declared) {
          return declared.set == 0 && declared.binding == entry.binding;
        }))
      used.push_back(entry);
  return used;
}

}  // namespace tandem::pathtracer
