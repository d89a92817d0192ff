#include <algorithm>
#include <cstddef>
#include <utility>

#include "pathtracer/renderer.hpp"

// Rays one by one: what the comparison of devices asks for when their pictures differ.

namespace tandem::pathtracer {
namespace {

/// Bytes of rays that one dispatch writes at most.
constexpr std::uint64_t most_log_bytes = 64ull << 20;

/// PathId of shaders/path_log.glsl.
struct GpuPathId {
  glm::uvec2 pixel;
  std::uint32_t sample;
  std::uint32_t ray_count;
};
static_assert(sizeof(GpuPathId) == 16);

template <typename T>
rhi::BufferHandle store(rhi::Device& device, const std::vector<T>& values, const std::string& label) {
  const std::span<const std::byte> bytes = std::as_bytes(std::span(values));
  rhi::BufferHandle buffer =
      device.create_buffer({.size = bytes.size(), .usage = rhi::BufferUsage::storage, .label = label});
  const rhi::CommandListHandle list = device.create_command_list("upload of " + label);
  list->upload(buffer, 0, bytes);
  device.submit(list)->wait();
  return buffer;
}

template <typename T>
std::vector<T> load(rhi::Device& device, const rhi::BufferHandle& buffer, std::size_t count) {
  std::vector<T> values(count);
  device.download(buffer, 0, std::as_writable_bytes(std::span(values)));
  return values;
}

}  // namespace

void Renderer::run_task(PathTraceTask task, const std::vector<rhi::BufferHandle>& buffers,
                        std::span<const DispatchConstants> dispatches) {
  const PathTraceProgram program(*device_, trace_, program_->features(), task);
  const rhi::PipelineHandle& pipeline = program.pipeline();
  std::vector<rhi::BindGroupEntry> entries;
  for (const rhi::BufferHandle& buffer : buffers)
    entries.push_back(
        {.binding = static_cast<std::uint32_t>(2 + entries.size()), .resource = rhi::BufferRange{buffer}});
  const std::vector<rhi::BindGroupHandle> groups = {
      device_->create_bind_group({.pipeline = pipeline,
                                  .set = 0,
                                  .entries = scene_.entries(pipeline->interface(), constants_buffer_),
                                  .label = "scene"}),
      device_->create_bind_group({.pipeline = pipeline, .set = 1, .entries = entries, .label = "rays"})};
  for (const DispatchConstants& constants : dispatches) {
    const rhi::CommandListHandle list = device_->create_command_list("rays one by one");
    program.record(*list, groups, constants);
    device_->submit(list)->wait();
  }
}

std::vector<std::vector<TracedRay>> Renderer::log_paths(std::span<const PathId> paths) {
  // A segment traces its own ray and one to a light.
  const std::uint32_t rays_per_path = 2 * settings_.max_depth;
  const std::size_t batch = std::max<std::uint64_t>(1, most_log_bytes / (rays_per_path * sizeof(TracedRay)));
  std::vector<std::vector<TracedRay>> logs;
  logs.reserve(paths.size());
  for (std::size_t first = 0; first < paths.size(); first += batch) {
    const std::size_t count = std::min(batch, paths.size() - first);
    std::vector<GpuPathId> ids;
    for (const PathId& path : paths.subspan(first, count))
      ids.push_back({.pixel = path.pixel, .sample = path.sample, .ray_count = 0});
    const rhi::BufferHandle log = device_->create_buffer(
        {.size = count * rays_per_path * sizeof(TracedRay), .usage = rhi::BufferUsage::storage, .label = "ray log"});
    const rhi::BufferHandle id_buffer = store(*device_, ids, "paths");
    const DispatchConstants constants{.tile_size = {count, 1}, .sample_count = rays_per_path};
    run_task(PathTraceTask::log, {log, id_buffer}, {&constants, 1});
    ids = load<GpuPathId>(*device_, id_buffer, count);
    const std::vector<TracedRay> rays = load<TracedRay>(*device_, log, count * rays_per_path);
    for (std::size_t i = 0; i < count; ++i) {
      const auto begin = rays.begin() + static_cast<std::ptrdiff_t>(i * rays_per_path);
      logs.emplace_back(begin, begin + ids[i].ray_count);
    }
  }
  return logs;
}

std::vector<std::uint32_t> Renderer::answer(std::span<const TracedRay> rays) {
  const std::size_t batch = most_log_bytes / sizeof(TracedRay);
  std::vector<std::uint32_t> answers;
  answers.reserve(rays.size());
  for (std::size_t first = 0; first < rays.size(); first += batch) {
    const std::span<const TracedRay> some = rays.subspan(first, std::min(batch, rays.size() - first));
    const rhi::BufferHandle log = store(*device_, std::vector<TracedRay>(some.begin(), some.end()), "rays");
    const DispatchConstants constants{.tile_size = {some.size(), 1}, .sample_count = 0};
    run_task(PathTraceTask::answer, {log}, {&constants, 1});
    for (const TracedRay& ray : load<TracedRay>(*device_, log, some.size())) answers.push_back(ray.answer);
  }
  return answers;
}

}  // namespace tandem::pathtracer
