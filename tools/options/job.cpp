#include "tools/options/job.hpp"

#include <cmath>
#include <optional>
#include <vector>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <glm/vec3.hpp>

#include "devices/devices.hpp"
#include "pathtracer/load/scene_loader.hpp"
#include "pathtracer/scene/panes.hpp"
#include "pathtracer/scene/studio.hpp"
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
    camera.position = glm::vec3(*options.camera_position - scene.origin);
    camera.target = pathtracer::bounds(scene).centre();
  }
  if (options.camera_target) camera.target = glm::vec3(*options.camera_target - scene.origin);
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

void say_origin(const pathtracer::Scene& scene) {
  const glm::dvec3& origin = scene.origin;
  if (origin == glm::dvec3(0)) return;
  print_note(fmt::format(
      "{}: far from 0,0,0, so it is rendered relative to {},{},{}; camera positions count from the file's 0,0,0",
      scene.name, origin.x, origin.y, origin.z));
}

/// Glass that light enters and does not leave: a warning for each material, or panes where the options say so.
void treat_open_glass(pathtracer::Scene& scene, bool thin_panes) {
  const std::vector<std::uint32_t> open = open_dielectrics(scene);
  if (thin_panes) return make_panes(scene, open);
  for (const std::uint32_t material : open)
    print_warnings(
        {fmt::format("{}: the mesh of the dielectric material '{}' is not closed, so light that enters it "
                     "does not leave it; --thin-panes makes it a thin pane",
                     scene.name, scene.material_names[material])});
}

/// A model that is opened for the first time is to be seen. A description that lights itself badly means to.
void light_up(pathtracer::Scene& scene, bool is_description) {
  const pathtracer::OwnLight light = own_light(scene);
  if (light == pathtracer::OwnLight::sufficient) return;
  if (light == pathtracer::OwnLight::negligible && is_description) return;
  add_studio(scene);
  print_note(
      fmt::format("{}: {}, so a neutral studio light is added; --background R,G,B renders without it", scene.name,
                  light == pathtracer::OwnLight::none ? "nothing emits light" : "what it emits hardly lights it"));
}

}  // namespace

compare::Job load_job(const RenderOptions& options) {
  compare::Job job;
  std::optional<ShownStage> stage("loading " + options.scene.filename().string());
  job.file = options.scene;
  job.scene = pathtracer::load_scene(options.scene, {.allow_missing_mtl = options.allow_missing_mtl,
                                                     .allow_outside_files = options.allow_outside_files});
  stage.reset();
  print_warnings(job.scene.warnings);
  say_origin(job.scene);
  treat_open_glass(job.scene, options.thin_panes);
  pathtracer::SceneSettings wanted = options.settings;
  if (options.size) {
    wanted.width = options.size->x;
    wanted.height = options.size->y;
  }
  wanted = merged(wanted, job.scene.settings);
  if (!wanted.background) light_up(job.scene, options.scene.extension() == ".json");
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
  desc.robust_access = false;  // the path tracer stays inside of its buffers
  desc.thread_count = options.threads;
  desc.on_message = print_message;
  return create_device(desc);
}

}  // namespace tandem::tools
