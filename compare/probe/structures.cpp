#include "compare/probe/structures.hpp"

#include <string>
#include <utility>

#include <glm/common.hpp>
#include <glm/vec4.hpp>

#include "rhi/build.hpp"
#include "rhi/transfer.hpp"

namespace tandem::compare {
namespace {

using pathtracer::Bounds;
using pathtracer::GpuSphere;
using pathtracer::GpuTriangle;
using rhi::BufferUsage;

template <typename T>
rhi::BufferHandle store(rhi::Device& device, const std::vector<T>& values, BufferUsage usage,
                        const std::string& label) {
  if (values.empty()) return nullptr;
  return rhi::create_filled(device, values, usage, label);
}

template <typename T>
rhi::BufferHandle store_input(rhi::Device& device, const std::vector<T>& values, const std::string& label) {
  return store(device, values, BufferUsage::acceleration_structure_input, label);
}

/// Of `count` primitives, those of a geometry.
std::uint32_t count_in(std::size_t count, std::uint32_t geometry) {
  return static_cast<std::uint32_t>((count + 1 - geometry) / 2);
}

constexpr rhi::GeometryFlags flags_of(std::uint32_t geometry) {
  return geometry == 0 ? rhi::GeometryFlags::opaque : rhi::GeometryFlags::none;
}

/// The corners of all triangles, those of geometry 0 first.
std::vector<std::uint32_t> corner_indices(const pathtracer::Scene& scene) {
  std::vector<std::uint32_t> indices;
  indices.reserve(3 * scene.triangles.size());
  for (std::size_t geometry = 0; geometry < 2; ++geometry)
    for (std::size_t i = geometry; i < scene.triangles.size(); i += 2)
      indices.insert(indices.end(), std::begin(scene.triangles[i].vertices), std::end(scene.triangles[i].vertices));
  return indices;
}

/// A little larger than the spheres, so that no device's rounding loses a ray that touches one. Those of geometry 0
/// first.
std::vector<Bounds> boxes_of(const pathtracer::Scene& scene) {
  constexpr float margin = 1e-5f;
  std::vector<Bounds> boxes;
  for (std::size_t geometry = 0; geometry < 2; ++geometry) {
    for (std::size_t i = geometry; i < scene.spheres.size(); i += 2) {
      const GpuSphere& sphere = scene.spheres[i];
      const glm::vec3 reach = sphere.radius + margin * (glm::abs(sphere.centre) + sphere.radius);
      boxes.push_back({sphere.centre - reach, sphere.centre + reach});
    }
  }
  return boxes;
}

/// Somewhere else: a scene that is still there has not been updated.
glm::vec3 elsewhere(const glm::vec3& p, const Bounds& bounds) {
  const glm::vec3 from_centre = p - bounds.centre();
  return bounds.centre() + glm::vec3(from_centre.y, from_centre.z, from_centre.x) + 0.75f * bounds.extent();
}

Bounds elsewhere(const Bounds& box, const Bounds& bounds) {
  const glm::vec3 a = elsewhere(box.minimum, bounds), b = elsewhere(box.maximum, bounds);
  return {glm::min(a, b), glm::max(a, b)};
}

template <typename T>
std::vector<T> all_elsewhere(std::vector<T> values, const Bounds& bounds) {
  for (T& value : values) value = elsewhere(value, bounds);
  return values;
}

}  // namespace

ProbeStructures::ProbeStructures(rhi::Device& device, const pathtracer::Scene& scene) : device_(device), scene_(scene) {
  const std::vector<std::uint32_t> indices = corner_indices(scene);
  std::vector<glm::vec3> soup;
  for (const std::uint32_t index : indices) soup.push_back(scene.positions[index]);
  positions_ = store_input(device, scene.positions, "probe: positions");
  indices_ = store_input(device, indices, "probe: indices");
  soup_ = store_input(device, soup, "probe: corners");
  boxes_ = store_input(device, boxes_of(scene), "probe: boxes");
  std::vector<glm::vec4> spheres;
  for (const GpuSphere& sphere : scene.spheres) spheres.emplace_back(sphere.centre, sphere.radius);
  if (spheres.empty()) spheres.emplace_back(0);
  spheres_ = store(device, spheres, BufferUsage::storage, "probe: spheres");
  if (!scene.triangles.empty())
    plain_.push_back(
        rhi::build_bottom_level(device, triangles(positions_, true, nullptr, rhi::BuildFlags::prefer_fast_trace)));
  if (!scene.spheres.empty())
    plain_.push_back(rhi::build_bottom_level(device, this->spheres(boxes_, rhi::BuildFlags::prefer_fast_trace)));
}

rhi::BottomLevelDesc ProbeStructures::triangles(const rhi::BufferHandle& positions, bool indexed,
                                                const rhi::BufferHandle& transform, rhi::BuildFlags flags) const {
  rhi::BottomLevelDesc desc;
  std::uint64_t first_corner = 0;
  for (std::uint32_t i = 0; i < 2; ++i) {
    rhi::TriangleGeometry geometry;
    geometry.triangle_count = count_in(scene_.triangles.size(), i);
    if (geometry.triangle_count == 0) break;
    if (indexed) {
      geometry.vertices = {positions};
      geometry.vertex_count = static_cast<std::uint32_t>(scene_.positions.size());
      geometry.indices = {indices_, sizeof(std::uint32_t) * first_corner};
      geometry.index_format = rhi::IndexFormat::uint32;
    } else {
      geometry.vertices = {positions, sizeof(glm::vec3) * first_corner};
      geometry.vertex_count = 3 * geometry.triangle_count;
    }
    if (transform) geometry.transform = {transform};
    geometry.flags = flags_of(i);
    first_corner += 3 * std::uint64_t{geometry.triangle_count};
    desc.geometries.emplace_back(geometry);
  }
  desc.flags = flags;
  desc.label = "probe of " + scene_.name;
  return desc;
}

rhi::BottomLevelDesc ProbeStructures::spheres(const rhi::BufferHandle& boxes, rhi::BuildFlags flags) const {
  rhi::BottomLevelDesc desc;
  for (std::uint32_t i = 0; i < 2; ++i) {
    rhi::AabbGeometry geometry;
    geometry.box_count = count_in(scene_.spheres.size(), i);
    if (geometry.box_count == 0) break;
    geometry.boxes = {boxes, i == 0 ? 0 : sizeof(Bounds) * std::uint64_t{count_in(scene_.spheres.size(), 0)}};
    geometry.flags = flags_of(i);
    desc.geometries.emplace_back(geometry);
  }
  desc.flags = flags;
  desc.label = "probe of " + scene_.name + ", spheres";
  return desc;
}

std::vector<rhi::AccelerationStructureHandle> ProbeStructures::bottom_levels(InstanceSetup instance_setup) const {
  std::vector<rhi::AccelerationStructureHandle> structures;
  const auto add = [&](const rhi::BottomLevelDesc& desc) {
    structures.push_back(rhi::build_bottom_level(device_, desc));
  };
  const bool has_triangles = !scene_.triangles.empty(), has_spheres = !scene_.spheres.empty();
  switch (instance_setup) {
    case InstanceSetup::refitted: {
      const Bounds bounds = pathtracer::bounds(scene_);
      const auto flags = rhi::BuildFlags::allow_update;
      const auto refit = [&](const rhi::BottomLevelDesc& first, const rhi::BottomLevelDesc& then) {
        add(first);
        const rhi::CommandListHandle list = device_.create_command_list("update of " + then.label);
        list->update_bottom_level(structures.back(), then);
        device_.submit(list)->wait();
      };
      if (has_triangles)
        refit(triangles(store_input(device_, all_elsewhere(scene_.positions, bounds), "probe: positions elsewhere"),
                        true, nullptr, flags),
              triangles(positions_, true, nullptr, flags));
      if (has_spheres)
        refit(spheres(store_input(device_, all_elsewhere(boxes_of(scene_), bounds), "probe: boxes elsewhere"), flags),
              spheres(boxes_, flags));
      return structures;
    }
    case InstanceSetup::build_transform: {
      const Transform transform = placements(instance_setup, scene_).front().transform;
      if (has_triangles)
        add(triangles(positions_, true,
                      store_input(device_, std::vector<float>(transform.begin(), transform.end()), "probe: transform"),
                      rhi::BuildFlags::prefer_fast_trace));
      return structures;
    }
    case InstanceSetup::without_indices:
      if (has_triangles) add(triangles(soup_, false, nullptr, rhi::BuildFlags::prefer_fast_build));
      if (has_spheres) structures.push_back(plain_.back());
      return structures;
    case InstanceSetup::compacted:
      if (has_triangles) add(triangles(positions_, true, nullptr, rhi::BuildFlags::allow_compaction));
      if (has_spheres) add(spheres(boxes_, rhi::BuildFlags::allow_compaction));
      for (rhi::AccelerationStructureHandle& structure : structures)
        structure = device_.create_compacted(structure, structure->label() + ", compacted");
      return structures;
    default:
      return plain_;
  }
}

ProbeStructures::Built ProbeStructures::build(InstanceSetup instance_setup) {
  Built built{.bottom_levels = bottom_levels(instance_setup), .top_level = {}};
  std::vector<rhi::InstanceDesc> instances;
  std::uint32_t number = 0;
  for (const Placement& placement : placements(instance_setup, scene_)) {
    for (std::size_t i = 0; i < built.bottom_levels.size(); ++i) {
      const bool is_spheres = i == 1 || scene_.triangles.empty();
      rhi::InstanceDesc& instance = instances.emplace_back(rhi::make_instance(
          *built.bottom_levels[i], is_transformed_at_build(instance_setup) ? identity_transform : placement.transform));
      instance.mask = placement.mask & 0xff;
      instance.flags = static_cast<std::uint32_t>(placement.flags) & 0xff;
      instance.custom_index = custom_index(number, is_spheres) & 0xffffff;
      instance.sbt_offset = hit_record(number, is_spheres) & 0xffffff;
    }
    ++number;
  }
  rhi::TopLevelDesc desc;
  desc.instance_count = static_cast<std::uint32_t>(instances.size());
  desc.label = "probe of " + scene_.name;
  const auto describe = [&](const std::vector<rhi::InstanceDesc>& described) {
    desc.instances = {store_input(device_, described, "probe: instances")};
    return desc;
  };
  const rhi::CommandListHandle list = device_.create_command_list("build of " + desc.label);
  if (instance_setup == InstanceSetup::moved) {
    desc.flags = rhi::BuildFlags::allow_update;
    std::vector<rhi::InstanceDesc> others;
    const Transform away = placements(InstanceSetup::instances, scene_)[1].transform;
    for (std::size_t i = 0; i < instances.size(); ++i) {
      rhi::InstanceDesc& other = others.emplace_back(rhi::make_instance(*built.bottom_levels[i], away));
      other.mask = 0;
      other.flags = static_cast<std::uint32_t>(rhi::InstanceFlags::triangle_flip_facing) & 0xff;
    }
    built.top_level = device_.create_top_level(describe(others));
    list->build_top_level(built.top_level, desc);
    list->update_top_level(built.top_level, describe(instances));
  } else {
    built.top_level = device_.create_top_level(describe(instances));
    list->build_top_level(built.top_level, desc);
  }
  device_.submit(list)->wait();
  return built;
}

const rhi::AccelerationStructureHandle& ProbeStructures::top_level(InstanceSetup instance_setup) {
  const auto found = built_.find(instance_setup);
  if (found != built_.end()) return found->second.top_level;
  return built_.emplace(instance_setup, build(instance_setup)).first->second.top_level;
}

}  // namespace tandem::compare
