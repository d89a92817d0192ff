#include "tools/rendering.hpp"

#include "devices/devices.hpp"
#include "pathtracer/obj_loader.hpp"
#include "tools/interruption.hpp"
#include "tools/messages.hpp"
#include "tools/progress_bar.hpp"

namespace tandem::tools {

pathtracer::Scene load_scene(const RenderOptions& options) {
  pathtracer::Scene scene = pathtracer::load_obj(options.scene, {.allow_missing_mtl = options.allow_missing_mtl});
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

Rendering render(const rhi::DeviceHandle& device, const pathtracer::Scene& scene,
                 const pathtracer::RenderSettings& settings, std::uint32_t samples) {
  pathtracer::Renderer renderer(device, scene, settings);
  render_samples(renderer, samples, device->info().name);
  return {.image = renderer.image(),
          .device = device->info(),
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
