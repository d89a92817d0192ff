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

using Clock = std::chrono::steady_clock;

double milliseconds_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

std::string text_of(const glm::vec3& v) { return fmt::format("{} {} {}", v.x, v.y, v.z); }

}  // namespace

Renderer::Renderer(rhi::DeviceHandle device, const Scene& scene, const RenderSettings& settings,
                   std::optional<TracingMode> trace, ProgramStoreHandle programs)
    : scene_(std::move(device), scene, settings, trace, std::move(programs)) {
  restart(settings);
}

void Renderer::prepare() {
  if (picture_group_) return;
  const Clock::time_point start = Clock::now();
  if (metropolis_) {
    metropolis_->prepare(scene_);
    compile_milliseconds_ += milliseconds_since(start);
    return;
  }
  picture_group_ =
      scene_.device().create_bind_group({.pipeline = scene_.program(PathTraceTask::picture).pipeline(),
                                         .set = 1,
                                         .entries = {{.binding = 0, .resource = rhi::BufferRange{radiance_sum_}},
                                                     {.binding = 1, .resource = rhi::BufferRange{ray_counts_}}},
                                         .label = "picture"});
  compile_milliseconds_ += milliseconds_since(start);
}

void Renderer::warm_up() {
  prepare();
  if (is_warm_) return;
  const Clock::time_point start = Clock::now();
  // No sample is added to the sum of the first pixel.
  if (metropolis_) {
    metropolis_->warm_up(scene_);
  } else {
    scene_.execute("warm up", [&](rhi::CommandList& list) { record(list, {.sample_count = 0}); });
  }
  compile_milliseconds_ += milliseconds_since(start);
  is_warm_ = true;
}

void Renderer::restart(const RenderSettings& settings) {
  scene_.configure(settings);
  const std::uint64_t pixels = std::uint64_t{settings.width} * settings.height;
  if (!radiance_sum_ || radiance_sum_->size() != pixels * sizeof(glm::vec3)) {
    radiance_sum_ = scene_.device().create_buffer(
        {.size = pixels * sizeof(glm::vec3), .usage = rhi::BufferUsage::storage, .label = "radiance sums"});
    ray_counts_ = scene_.device().create_buffer(
        {.size = pixels * sizeof(std::uint32_t), .usage = rhi::BufferUsage::storage, .label = "ray counts"});
  }
  metropolis_.reset();
  if (settings.integrator == Integrator::metropolis) metropolis_.emplace();
  picture_group_ = nullptr;  // the settings may ask for another program
  is_warm_ = false;
  compile_milliseconds_ = 0;
  pace_ = Pace(settings.submission_seconds);
  clear_picture();
}

void Renderer::set_lights(std::span<const PunctualLight> lights) {
  scene_.set_lights(lights);
  restart(RenderSettings(scene_.settings()));
}

void Renderer::clear_picture() {
  const rhi::CommandListHandle list = scene_.device().create_command_list("clear the picture");
  list->fill({radiance_sum_}, 0);
  list->fill({ray_counts_}, 0);
  scene_.device().submit(list)->wait();
  if (metropolis_) metropolis_.emplace();
  samples_ = 0;
  ray_count_ = 0;
  device_milliseconds_ = 0;
}

void Renderer::collect_ray_counts() {
  std::vector<std::uint32_t> counts(ray_counts_->size() / sizeof(std::uint32_t));
  scene_.device().download(ray_counts_, 0, std::as_writable_bytes(std::span(counts)));
  for (const std::uint32_t count : counts) ray_count_ += count;
  const rhi::CommandListHandle list = scene_.device().create_command_list("clear the ray counts");
  list->fill({ray_counts_}, 0);
  scene_.device().submit(list)->wait();
}

void Renderer::record(rhi::CommandList& list, const DispatchConstants& constants) {
  scene_.program(PathTraceTask::picture)
      .record(list, {scene_.bind_group(PathTraceTask::picture), picture_group_}, constants);
}

void Renderer::dispatch(const Tile& tile, std::uint32_t first_sample, std::uint32_t sample_count) {
  const DispatchConstants constants{
      .tile_offset = tile.offset, .tile_size = tile.size, .first_sample = first_sample, .sample_count = sample_count};
  const Clock::time_point start = Clock::now();
  device_milliseconds_ += scene_.execute("path tracing", [&](rhi::CommandList& list) { record(list, constants); });
  pace_.measured(double(tile.size.x) * double(tile.size.y) * sample_count, milliseconds_since(start) / 1000);
}

bool Renderer::render(std::uint32_t samples, const Progress& progress) {
  if (samples > std::numeric_limits<std::uint32_t>::max() - samples_)
    throw Error(fmt::format("{} samples after {} are more than can be counted", samples, samples_));
  warm_up();
  if (metropolis_) {
    if (!metropolis_->render(scene_, samples_ + samples, pace_, progress)) {
      clear_picture();
      return false;
    }
    samples_ += samples;
    return true;
  }
  const RenderSettings& settings = scene_.settings();
  const glm::uvec2 resolution(settings.width, settings.height);
  const double pixels = double(resolution.x) * double(resolution.y);
  // A sample traces at most two rays for each segment: its own and one to a light.
  const std::uint32_t uncollected_limit = std::numeric_limits<std::uint32_t>::max() / (2 * settings.max_depth);
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
    for (TileCursor cursor(resolution, settings.maximum_tile); !cursor.at_end();) {
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
  const RenderSettings& settings = scene_.settings();
  Image image{settings.width, settings.height, {}};
  image.pixels.resize(std::size_t{image.width} * image.height, glm::vec3(0));
  if (samples_ == 0) return image;
  if (metropolis_) return metropolis_->image(scene_, samples_);
  scene_.device().download(radiance_sum_, 0, std::as_writable_bytes(std::span(image.pixels)));
  for (glm::vec3& pixel : image.pixels) pixel /= static_cast<float>(samples_);
  return image;
}

ImageMetadata Renderer::metadata() const {
  const RenderSettings& settings = scene_.settings();
  const rhi::DeviceInfo& device = scene_.device().info();
  return {{"scene", scene_.name()},
          {"triangles", fmt::to_string(scene_.triangle_count())},
          {"device", device.name},
          {"hardware", device.description},
          {"driver", device.driver},
          {"trace", std::string(name(scene_.trace()))},
          {"size", fmt::format("{}x{}", settings.width, settings.height)},
          {"samples", fmt::to_string(samples_)},
          {"depth", fmt::to_string(settings.max_depth)},
          {"seed", fmt::to_string(settings.seed)},
          {"camera",
           fmt::format("position {} target {} up {} fov {}", text_of(scene_.camera().position),
                       text_of(scene_.camera().target), text_of(scene_.camera().up), scene_.camera().vertical_fov)},
          {"background", text_of(scene_.background())},
          {"integrator", name_of(integrator_names(), settings.integrator)},
          {"sampler", name_of(sampler_names(), settings.sampler)},
          {"rays", fmt::to_string(ray_count_)},
          {"milliseconds", fmt::format("{:.3f}", device_milliseconds_)},
          {"version", TANDEM_VERSION}};
}

}  // namespace tandem::pathtracer
