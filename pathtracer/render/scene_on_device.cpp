#include "pathtracer/render/scene_on_device.hpp"

#include <chrono>
#include <memory>
#include <utility>

#include <fmt/format.h>

#include "base/error.hpp"

namespace tandem::pathtracer {
namespace {

/// Before the upload: bad settings, and a camera that looks nowhere, are known at once.
Camera checked_camera(const Scene& scene, const RenderSettings& settings) {
  check(settings);
  const float aspect = static_cast<float>(settings.width) / static_cast<float>(settings.height);
  const Camera camera = settings.camera ? *settings.camera
                        : scene.camera  ? *scene.camera
                                        : automatic_camera(scene, aspect);
  RenderConstants constants{};
  set_camera(constants, camera, settings.width, settings.height);
  return camera;
}

}  // namespace

SceneOnDevice::SceneOnDevice(rhi::DeviceHandle device, const Scene& scene, const RenderSettings& settings,
                             std::optional<TracingMode> trace, ProgramStoreHandle programs)
    : device_(std::move(device)),
      programs_(programs ? std::move(programs) : std::make_shared<ProgramStore>(device_)),
      name_(scene.name),
      camera_(checked_camera(scene, settings)),
      trace_(choose_tracing_mode(device_->info(), trace)),
      scene_(*device_, scene) {
  if (device_->info().capabilities.timestamps)
    timestamps_ = device_->create_query_pool({.count = 2, .label = "dispatch times"});
  build_milliseconds_ = execute("build of " + name_, [&](rhi::CommandList& list) { scene_.record_build(list); });
  constants_ = device_->create_buffer(
      {.size = sizeof(RenderConstants), .usage = rhi::BufferUsage::storage, .label = "render constants"});
  configure(settings);
}

void SceneOnDevice::configure(const RenderSettings& settings) {
  check(settings);
  RenderSettings completed = settings;
  if (!completed.camera) completed.camera = camera_;
  RenderConstants constants{};
  set_camera(constants, *completed.camera, settings.width, settings.height);
  camera_ = *completed.camera;
  if (const Features features = built_features(scene_.features() | features_of(completed)); features != features_) {
    features_ = features;
    bind_groups_.clear();
  }
  settings_ = settings;
  warnings_.clear();
  background_ = scene_.environment() ? scene_.environment()->radiance : glm::vec3(0);
  if (settings.background) background_ = *settings.background;
  if (scene_.light_count() == 0 && !scene_.environment() && !settings.background) {
    background_ = glm::vec3(1);
    warnings_.push_back(fmt::format("{}: no emitters, so the background is white with radiance 1", name_));
  }
  constants.background = background_;
  scene_.describe(constants);
  set_options(constants, settings);
  const rhi::CommandListHandle list = device_->create_command_list("render constants");
  list->upload(constants_, 0, std::as_bytes(std::span(&constants, 1)));
  device_->submit(list)->wait();
}

void SceneOnDevice::set_lights(std::span<const PunctualLight> lights) {
  scene_.set_lights(*device_, lights);
  bind_groups_.clear();
  configure(RenderSettings(settings_));
}

const PathTraceProgram& SceneOnDevice::program(PathTraceTask task) {
  return programs_->program(trace_, features_, task);
}

rhi::BindGroupHandle SceneOnDevice::bind_group(PathTraceTask task) {
  rhi::BindGroupHandle& group = bind_groups_[task];
  if (!group) {
    const rhi::PipelineHandle& pipeline = program(task).pipeline();
    group = device_->create_bind_group({.pipeline = pipeline,
                                        .set = 0,
                                        .entries = scene_.entries(pipeline->interface(), constants_),
                                        .label = "scene"});
  }
  return group;
}

void SceneOnDevice::run(PathTraceTask task, std::span<const rhi::BufferHandle> buffers,
                        std::span<const DispatchConstants> dispatches) {
  const PathTraceProgram& task_program = program(task);
  std::vector<rhi::BindGroupEntry> entries;
  for (const rhi::BufferHandle& buffer : buffers)
    entries.push_back(
        {.binding = static_cast<std::uint32_t>(2 + entries.size()), .resource = rhi::BufferRange{buffer}});
  const std::vector<rhi::BindGroupHandle> groups = {
      bind_group(task),
      device_->create_bind_group({.pipeline = task_program.pipeline(), .set = 1, .entries = entries, .label = "task"})};
  for (const DispatchConstants& constants : dispatches) {
    const rhi::CommandListHandle list = device_->create_command_list("task");
    task_program.record(*list, groups, constants);
    device_->submit(list)->wait();
  }
}

double SceneOnDevice::execute(const std::string& label, const std::function<void(rhi::CommandList&)>& record) {
  const rhi::CommandListHandle list = device_->create_command_list(label);
  if (timestamps_) list->write_timestamp(timestamps_, 0);
  record(*list);
  if (timestamps_) list->write_timestamp(timestamps_, 1);
  const auto start = std::chrono::steady_clock::now();
  device_->submit(list)->wait();
  const std::chrono::duration<double, std::milli> elapsed = std::chrono::steady_clock::now() - start;
  if (!timestamps_) return elapsed.count();
  const std::vector<double> times = timestamps_->timestamps_ns();
  return (times[1] - times[0]) * 1e-6;
}

}  // namespace tandem::pathtracer
