#include "pathtracer/render/renderer.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <span>
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

std::string text_of(const glm::vec3& v) { return fmt::format("{} {} {}", v.x, v.y, v.z); }

}  // namespace

Renderer::Renderer(rhi::DeviceHandle device, const Scene& scene, const RenderSettings& settings,
                   std::optional<TracingMode> trace, ProgramStoreHandle programs)
    : device_(std::move(device)),
      programs_(programs ? std::move(programs) : std::make_shared<ProgramStore>(device_)),
      scene_name_(scene.name),
      camera_(checked_camera(scene, settings)),
      trace_(choose_tracing_mode(device_->info(), trace)),
      scene_(*device_, scene) {
  if (device_->info().capabilities.timestamps)
    timestamps_ = device_->create_query_pool({.count = 2, .label = "dispatch times"});
  build_milliseconds_ = execute("build of " + scene_name_, [&](rhi::CommandList& list) { scene_.record_build(list); });
  constants_buffer_ = device_->create_buffer(
      {.size = sizeof(RenderConstants), .usage = rhi::BufferUsage::storage, .label = "render constants"});
  restart(settings);
}

const PathTraceProgram& Renderer::program(PathTraceTask task) { return programs_->program(trace_, features_, task); }

void Renderer::choose_features(const RenderSettings& settings) {
  const Features features = built_features(scene_.features() | features_of(settings));
  if (features == features_) return;
  features_ = features;
  scene_group_ = nullptr;
  picture_group_ = nullptr;
}

void Renderer::prepare() {
  const rhi::PipelineHandle& pipeline = program(PathTraceTask::picture).pipeline();
  if (!scene_group_)
    scene_group_ = device_->create_bind_group({.pipeline = pipeline,
                                               .set = 0,
                                               .entries = scene_.entries(pipeline->interface(), constants_buffer_),
                                               .label = "scene"});
  if (!picture_group_)
    picture_group_ =
        device_->create_bind_group({.pipeline = pipeline,
                                    .set = 1,
                                    .entries = {{.binding = 0, .resource = rhi::BufferRange{radiance_sum_}},
                                                {.binding = 1, .resource = rhi::BufferRange{ray_counts_}}},
                                    .label = "picture"});
}

double Renderer::execute(const std::string& label, const std::function<void(rhi::CommandList&)>& record) {
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

void Renderer::restart(const RenderSettings& settings) {
  check(settings);
  RenderSettings completed = settings;
  if (!completed.camera) completed.camera = camera_;
  set_camera(constants_, *completed.camera, settings.width, settings.height);
  camera_ = *completed.camera;
  choose_features(completed);
  const bool resized = !radiance_sum_ || settings.width != settings_.width || settings.height != settings_.height;
  settings_ = settings;
  warnings_.clear();
  background_ = scene_.environment() ? scene_.environment()->radiance : glm::vec3(0);
  if (settings.background) background_ = *settings.background;
  if (scene_.light_count() == 0 && !scene_.environment() && !settings.background) {
    background_ = glm::vec3(1);
    warnings_.push_back(fmt::format("{}: no emitters, so the background is white with radiance 1", scene_name_));
  }
  constants_.background = background_;
  scene_.describe(constants_);
  set_options(constants_, settings);
  if (resized) {
    const std::uint64_t pixels = std::uint64_t{settings.width} * settings.height;
    radiance_sum_ = device_->create_buffer(
        {.size = pixels * sizeof(glm::vec3), .usage = rhi::BufferUsage::storage, .label = "radiance sums"});
    ray_counts_ = device_->create_buffer(
        {.size = pixels * sizeof(std::uint32_t), .usage = rhi::BufferUsage::storage, .label = "ray counts"});
    picture_group_ = nullptr;
  }
  pace_ = Pace(settings.submission_seconds);
  clear_picture();
}

void Renderer::set_lights(std::span<const PunctualLight> lights) {
  scene_.set_lights(*device_, lights);
  scene_group_ = nullptr;
  restart(settings_);
}

void Renderer::clear_picture() {
  const rhi::CommandListHandle list = device_->create_command_list("clear the picture");
  list->upload(constants_buffer_, 0, std::as_bytes(std::span(&constants_, 1)));
  list->fill({radiance_sum_}, 0);
  list->fill({ray_counts_}, 0);
  device_->submit(list)->wait();
  samples_ = 0;
  ray_count_ = 0;
  device_milliseconds_ = 0;
}

void Renderer::collect_ray_counts() {
  std::vector<std::uint32_t> counts(ray_counts_->size() / sizeof(std::uint32_t));
  device_->download(ray_counts_, 0, std::as_writable_bytes(std::span(counts)));
  for (const std::uint32_t count : counts) ray_count_ += count;
  const rhi::CommandListHandle list = device_->create_command_list("clear the ray counts");
  list->fill({ray_counts_}, 0);
  device_->submit(list)->wait();
}

void Renderer::dispatch(const Tile& tile, std::uint32_t first_sample, std::uint32_t sample_count) {
  const DispatchConstants constants{
      .tile_offset = tile.offset, .tile_size = tile.size, .first_sample = first_sample, .sample_count = sample_count};
  const auto start = std::chrono::steady_clock::now();
  device_milliseconds_ += execute("path tracing", [&](rhi::CommandList& list) {
    program(PathTraceTask::picture).record(list, {scene_group_, picture_group_}, constants);
  });
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
  pace_.measured(double(tile.size.x) * double(tile.size.y) * sample_count, elapsed.count());
}

bool Renderer::render(std::uint32_t samples, const Progress& progress) {
  if (samples > std::numeric_limits<std::uint32_t>::max() - samples_)
    throw Error(fmt::format("{} samples after {} are more than can be counted", samples, samples_));
  prepare();
  const glm::uvec2 resolution(settings_.width, settings_.height);
  const double pixels = double(resolution.x) * double(resolution.y);
  // A sample traces at most two rays for each segment: its own and one to a light.
  const std::uint32_t uncollected_limit = std::numeric_limits<std::uint32_t>::max() / (2 * settings_.max_depth);
  const std::uint32_t first = samples_;
  const std::uint32_t end = samples_ + samples;
  std::uint32_t uncollected = 0;
  while (samples_ < end) {
    if (uncollected == uncollected_limit) {
      collect_ray_counts();
      uncollected = 0;
    }
    const std::uint32_t most = std::min(end - samples_, uncollected_limit - uncollected);
    const auto batch = static_cast<std::uint32_t>(std::clamp(pace_.budget() / pixels, 1.0, double(most)));
    for (TileCursor cursor(resolution, settings_.maximum_tile); !cursor.at_end();) {
      const Tile tile = cursor.next(pace_.budget() / batch);
      dispatch(tile, samples_, batch);
      if (!progress) continue;
      const double rows = double(tile.offset.y) * resolution.x + double(tile.offset.x + tile.size.x) * tile.size.y;
      if (!progress((double(samples_ - first) + rows / pixels * batch) / samples)) {
        clear_picture();
        return false;
      }
    }
    samples_ += batch;
    uncollected += batch;
  }
  if (uncollected != 0) collect_ray_counts();
  return true;
}

Image Renderer::image() const {
  Image image{settings_.width, settings_.height, {}};
  image.pixels.resize(std::size_t{image.width} * image.height, glm::vec3(0));
  if (samples_ == 0) return image;
  device_->download(radiance_sum_, 0, std::as_writable_bytes(std::span(image.pixels)));
  for (glm::vec3& pixel : image.pixels) pixel /= static_cast<float>(samples_);
  return image;
}

ImageMetadata Renderer::metadata() const {
  const rhi::DeviceInfo& device = device_->info();
  return {{"scene", scene_name_},
          {"triangles", fmt::to_string(scene_.triangle_count())},
          {"device", device.name},
          {"hardware", device.description},
          {"driver", device.driver},
          {"trace", std::string(name(trace_))},
          {"size", fmt::format("{}x{}", settings_.width, settings_.height)},
          {"samples", fmt::to_string(samples_)},
          {"depth", fmt::to_string(settings_.max_depth)},
          {"seed", fmt::to_string(settings_.seed)},
          {"camera", fmt::format("position {} target {} up {} fov {}", text_of(camera_.position),
                                 text_of(camera_.target), text_of(camera_.up), camera_.vertical_fov)},
          {"background", text_of(background_)},
          {"integrator", name_of(integrator_names(), settings_.integrator)},
          {"sampler", name_of(sampler_names(), settings_.sampler)},
          {"rays", fmt::to_string(ray_count_)},
          {"milliseconds", fmt::format("{:.3f}", device_milliseconds_)},
          {"version", TANDEM_VERSION}};
}

}  // namespace tandem::pathtracer
