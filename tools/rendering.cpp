#include "tools/rendering.hpp"

#include <cmath>
#include <optional>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <glm/vec3.hpp>

#include "devices/devices.hpp"
#include "pathtracer/load/scene_loader.hpp"
#include "tools/output/interruption.hpp"
#include "tools/output/messages.hpp"
#include "tools/output/progress_bar.hpp"

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

RenderJob load_job(const RenderOptions& options) {
  RenderJob job;
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

void render_samples(pathtracer::Renderer& renderer, std::uint32_t samples, const std::string& label) {
  ProgressBar bar(label);
  const bool finished = renderer.render(samples, [&](double fraction) {
    bar.show(fraction);
    return !interrupted();
  });
  if (!finished || interrupted()) throw Interrupted();
}

Rendering render(pathtracer::Renderer& renderer, const rhi::DeviceInfo& device, std::uint32_t samples) {
  render_samples(renderer, samples, device.name);
  return {.image = renderer.image(),
          .device = device,
          .trace = renderer.trace(),
          .camera = renderer.camera(),
          .background = renderer.background(),
          .milliseconds = renderer.device_milliseconds(),
          .build_milliseconds = renderer.build_milliseconds(),
          .rays = renderer.ray_count(),
          .metadata = renderer.metadata(),
          .warnings = renderer.warnings()};
}

double per_second_in_millions(double count, double milliseconds) {
  return milliseconds > 0.0 ? count / milliseconds / 1000.0 : 0.0;
}

}  // namespace tandem::tools
