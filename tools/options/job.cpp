#include "tools/options/job.hpp"

#include <cmath>
#include <optional>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <glm/vec3.hpp>

#include "devices/devices.hpp"
#include "pathtracer/load/scene_loader.hpp"
#include "tools/output/messages.hpp"

namespace tandem::tools {
namespace {

/// Upwards is +y in the picture, or -z where the camera looks straight up or down.
glm::vec3 up_for(const pathtracer::Camera& camera) {
  const glm::dvec3 view = glm::dvec3(camera.target) - glm::dvec3(camera.position);
  constexpr double smallest_slope = 1e-5;  // far above what the renderer takes for parallel
  const bool vertical = std::hypot(view.x, view.z) <= smallest_slope * std::abs(view.y);
  return vertical ? glm::vec3(0, 0, -1) : glm::vec3(0, 1, 0);
}

/// The camera of the options, or nothing when they say nothing of it.
std::optional<pathtracer::Camera> camera_of(const RenderOptions& options, const pathtracer::Scene& scene,
                                            float aspect) {
  const bool moved = options.camera_position || options.camera_target;
  if (!moved && !options.field_of_view && !options.camera && !options.view_height && !options.lens_radius &&
      !options.focus_distance)
    return std::nullopt;
  pathtracer::Camera camera = scene.camera ? *scene.camera : pathtracer::automatic_camera(scene, aspect);
  if (options.camera_position) {
    camera.position = *options.camera_position;
    camera.target = pathtracer::bounds(scene).centre();
  }
  camera.target = options.camera_target.value_or(camera.target);
  camera.vertical_fov = options.field_of_view.value_or(camera.vertical_fov);
  if (moved) camera.up = up_for(camera);
  if (options.camera && *options.camera != camera.kind) {
    camera.kind = *options.camera;
    camera.height = static_cast<float>(2 * std::tan(glm::radians(double{camera.vertical_fov}) / 2) *
                                       glm::distance(glm::dvec3(camera.position), glm::dvec3(camera.target)));
  }
  camera.height = options.view_height.value_or(camera.height);
  camera.lens_radius = options.lens_radius.value_or(camera.lens_radius);
  camera.focus_distance = options.focus_distance.value_or(camera.focus_distance);
  return camera;
}

}  // namespace

compare::Job load_job(const RenderOptions& options) {
  compare::Job job;
  job.file = options.scene;
  job.scene = pathtracer::load_scene(options.scene, {.allow_missing_mtl = options.allow_missing_mtl});
  print_warnings(job.scene.warnings);
  pathtracer::SceneSettings wanted = options.settings;
  if (options.size) {
    wanted.width = options.size->x;
    wanted.height = options.size->y;
  }
  wanted = merged(wanted, job.scene.settings);
  job.samples = wanted.samples.value_or(job.samples);
  job.settings = pathtracer::render_settings(wanted);
  job.settings.planned_samples = job.samples;
  const float aspect = static_cast<float>(job.settings.width) / static_cast<float>(job.settings.height);
  job.settings.camera = camera_of(options, job.scene, aspect);
  return job;
}

rhi::DeviceHandle open_device(const std::string& name, const RenderOptions& options) {
  rhi::DeviceDesc desc;
  desc.name = name;
  desc.driver_validation = options.validation;
  desc.thread_count = options.threads;
  desc.on_message = print_message;
  return create_device(desc);
}

}  // namespace tandem::tools
