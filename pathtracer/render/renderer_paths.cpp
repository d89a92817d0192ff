#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

#include "pathtracer/render/renderer.hpp"

// Paths and rays one by one: what the comparison of devices asks for when their pictures differ.

namespace tandem::pathtracer {
namespace {

/// Bytes of rays or events that one dispatch writes at most, as long as one path does not need more.
constexpr std::uint64_t most_log_bytes = 64ull << 20;

/// Paths of one submission at most.
constexpr std::size_t most_paths = 1u << 15;

/// PathStart of shaders/integrator/events.glsl.
struct GpuPathStart {
  glm::uvec2 pixel;
  std::uint32_t sample;
  std::uint32_t has_state;
  std::uint32_t segment_count;
  std::uint32_t first_event;
  std::uint32_t capacity;
  std::uint32_t reserved;
  std::array<std::uint32_t, 24> state;
};
static_assert(sizeof(GpuPathStart) == 128);

GpuPathStart gpu_path_start(const PathStart& start, std::uint32_t first_event, std::uint32_t capacity) {
  GpuPathStart gpu{.pixel = start.path.pixel,
                   .sample = start.path.sample,
                   .has_state = start.state ? 1u : 0u,
                   .segment_count = start.segment_count,
                   .first_event = first_event,
                   .capacity = capacity,
                   .reserved = 0,
                   .state = {}};
  if (start.state) std::copy_n(start.state->words.begin() + 2, gpu.state.size(), gpu.state.begin());
  return gpu;
}

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
  const PathTraceProgram& task_program = program(task);
  const rhi::PipelineHandle& pipeline = task_program.pipeline();
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
    task_program.record(*list, groups, constants);
    device_->submit(list)->wait();
  }
}

std::vector<PathSummary> Renderer::record(std::span<const PathStart> starts, std::span<const std::uint32_t> capacities,
                                          PathEvents& events) {
  std::vector<GpuPathStart> gpu_starts;
  gpu_starts.reserve(starts.size());
  std::uint32_t event_count = 0;
  for (std::size_t i = 0; i < starts.size(); ++i) {
    gpu_starts.push_back(gpu_path_start(starts[i], event_count, capacities[i]));
    event_count += capacities[i];
  }
  // No buffer may be empty.
  const auto output = [&](std::size_t count, std::size_t size, const char* label) {
    return device_->create_buffer(
        {.size = std::max<std::size_t>(1, count) * size, .usage = rhi::BufferUsage::storage, .label = label});
  };
  const rhi::BufferHandle log = output(event_count, sizeof(PathEvent), "event log");
  const rhi::BufferHandle summaries = output(starts.size(), sizeof(PathSummary), "path summaries");
  const DispatchConstants constants{.tile_size = {starts.size(), 1}};
  run_task(PathTraceTask::log, {log, store(*device_, gpu_starts, "path starts"), summaries}, {&constants, 1});
  events = event_count == 0 ? PathEvents{} : load<PathEvent>(*device_, log, event_count);
  return load<PathSummary>(*device_, summaries, starts.size());
}

std::vector<PathSummary> Renderer::summarize_paths(std::span<const PathStart> starts) {
  std::vector<PathSummary> summaries;
  summaries.reserve(starts.size());
  for (std::size_t first = 0; first < starts.size(); first += most_paths) {
    const std::span<const PathStart> some = starts.subspan(first, std::min(most_paths, starts.size() - first));
    PathEvents none;
    const std::vector<PathSummary> found = record(some, std::vector<std::uint32_t>(some.size(), 0), none);
    summaries.insert(summaries.end(), found.begin(), found.end());
  }
  return summaries;
}

std::vector<PathEvents> Renderer::record_paths(std::span<const PathStart> starts) {
  // How much room each needs is known once they have all been traced.
  std::vector<std::uint32_t> capacities;
  for (const PathSummary& summary : summarize_paths(starts)) capacities.push_back(summary.event_count);
  std::vector<PathEvents> paths;
  paths.reserve(starts.size());
  for (std::size_t first = 0; first < starts.size();) {
    std::size_t end = first;
    std::uint64_t event_count = 0;
    while (end < starts.size() && end - first < most_paths &&
           (end == first || event_count + capacities[end] <= most_log_bytes / sizeof(PathEvent))) {
      event_count += capacities[end];
      ++end;
    }
    PathEvents events;
    record(starts.subspan(first, end - first), std::span(capacities).subspan(first, end - first), events);
    auto begin = events.begin();
    for (; first < end; ++first) {
      paths.emplace_back(begin, begin + capacities[first]);
      begin += capacities[first];
    }
  }
  return paths;
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
