#include "tools/program/scene_levels.hpp"

#include <utility>

#include "pathtracer/load/scene_loader.hpp"
#include "pathtracer/scene/scene.hpp"
#include "tools/output/messages.hpp"

namespace tandem::tools::program_run {

std::size_t add_scene(program::Job& job, const Setting& setting, bool is_opaque, std::uint32_t box_record) {
  const pathtracer::Scene scene = pathtracer::load_scene(setting.folder / setting.value, {.allow_missing_mtl = true});
  print_warnings(scene.warnings);
  const rhi::GeometryFlags flags = is_opaque ? rhi::GeometryFlags::opaque : rhi::GeometryFlags::none;
  program::TopLevel top{.name = scene.name, .instances = {}};
  const auto add = [&](const char* what, auto geometry, std::uint32_t record) {
    top.instances.push_back({.bottom_level = job.bottom_levels.size(), .sbt_offset = record});
    job.bottom_levels.push_back({.name = scene.name + ", " + what, .geometries = {std::move(geometry)}});
  };
  if (!scene.triangles.empty()) {
    program::Triangles triangles{.positions = {}, .flags = flags};
    for (const glm::vec3& position : scene.positions)
      triangles.positions.push_back({position.x, position.y, position.z});
    for (const pathtracer::GpuTriangle& triangle : scene.triangles)
      triangles.indices.insert(triangles.indices.end(), std::begin(triangle.vertices), std::end(triangle.vertices));
    add("triangles", std::move(triangles), 0);
  }
  if (!scene.spheres.empty()) {
    program::Boxes boxes{.boxes = {}, .flags = flags};
    for (const pathtracer::GpuSphere& sphere : scene.spheres) {
      const glm::vec3 least = sphere.centre - sphere.radius, most = sphere.centre + sphere.radius;
      boxes.boxes.push_back({least.x, least.y, least.z, most.x, most.y, most.z});
    }
    add("spheres", std::move(boxes), box_record);
  }
  job.top_levels.push_back(std::move(top));
  return job.top_levels.size() - 1;
}

}  // namespace tandem::tools::program_run
