#include "tools/rendering.hpp"

#include <cmath>

#include <glm/vec3.hpp>

#include "devices/devices.hpp"
#include "pathtracer/scene_loader.hpp"
#include "tools/interruption.hpp"
#include "tools/messages.hpp"
#include "tools/progress_bar.hpp"

namespace tandem::tools {
namespace {

/// Upwards is +y in the picture, or -z where the camera looks straight up or down.
glm::vec3 up_for(const pathtracer::Camera& camera) {
  const glm::dvec3 view = glm::dvec3(camera.target) - glm::dvec3(camera.position);
  constexpr double smallest_slope = 1e-5;  // far above what the renderer takes for parallel
  const bool vertical = std::hypot(view.x, view.z) <= smallest_slope * std::abs(view.y);
  return vertical ? glm::vec3(0, 0, -1) : glm::vec3(0, 1, 0);
}

}  // namespace

pathtracer::Scene load_scene(const RenderOptions& options) {
  pathtracer::Scene scene = pathtracer::load_scene(options.scene, {.allow_missing_mtl = options.allow_missing_mtl});
  print_warnings(scene.warnings);
  return scene;
}

pathtracer::RenderSettings render_settings(const RenderOptions& options, const pathtracer::Scene& scene) {
  pathtracer::RenderSettings settings;
  settings.width = options.size.x;
  settings.height = options.size.y;
  settings.max_depth = options.depth;
  settings.seed = options.seed;
  settings.background = options.background;
  if (options.camera_position || options.camera_target || options.field_of_view) {
    const float aspect = static_cast<float>(options.size.x) / static_cast<float>(options.size.y);
    pathtracer::Camera camera = pathtracer::automatic_camera(scene, aspect);
    if (options.camera_position) {
      camera.position = *options.camera_position;
      camera.target = pathtracer::bounds(scene).centre();
    }
    camera.target = options.camera_target.value_or(camera.target);
    camera.vertical_fov = options.field_of_view.value_or(camera.vertical_fov);
    if (options.camera_position || options.camera_target) camera.up = up_for(camera);
    settings.camera = camera;
  }
  return settings;
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
