#include "pathtracer/render/path_recorder.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

#include "rhi/transfer.hpp"

namespace tandem::pathtracer {
namespace {

/// Bytes of events that one dispatch writes at most, as long as one path does not need more.
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

/// Records paths that fit into one submission, of each as many events as `capacities` says, one after the other.
std::vector<PathSummary> record(SceneOnDevice& scene, std::span<const PathStart> starts,
                                std::span<const std::uint32_t> capacities, PathEvents& events) {
  rhi::Device& device = scene.device();
  std::vector<GpuPathStart> gpu_starts;
  gpu_starts.reserve(starts.size());
  std::uint32_t event_count = 0;
  for (std::size_t i = 0; i < starts.size(); ++i) {
    gpu_starts.push_back(gpu_path_start(starts[i], event_count, capacities[i]));
    event_count += capacities[i];
  }
  // No buffer may be empty.
  const auto output = [&](std::size_t count, std::size_t size, const char* label) {
    return device.create_buffer(
        {.size = std::max<std::size_t>(1, count) * size, .usage = rhi::BufferUsage::storage, .label = label});
  };
  const rhi::BufferHandle log = output(event_count, sizeof(PathEvent), "event log");
  const rhi::BufferHandle summaries = output(starts.size(), sizeof(PathSummary), "path summaries");
  const DispatchConstants constants{.tile_size = {starts.size(), 1}};
  scene.run(
      PathTraceTask::log,
      std::array{log, rhi::create_filled(device, gpu_starts, rhi::BufferUsage::storage, "path starts"), summaries},
      {&constants, 1});
  events = event_count == 0 ? PathEvents{} : rhi::read<PathEvent>(device, log, event_count);
  return rhi::read<PathSummary>(device, summaries, starts.size());
}

}  // namespace

std::vector<PathSummary> summarize_paths(SceneOnDevice& scene, std::span<const PathStart> starts) {
  std::vector<PathSummary> summaries;
  summaries.reserve(starts.size());
  for (std::size_t first = 0; first < starts.size(); first += most_paths) {
    const std::span<const PathStart> some = starts.subspan(first, std::min(most_paths, starts.size() - first));
    PathEvents none;
    const std::vector<PathSummary> found = record(scene, some, std::vector<std::uint32_t>(some.size(), 0), none);
    summaries.insert(summaries.end(), found.begin(), found.end());
  }
  return summaries;
}

std::vector<PathEvents> record_paths(SceneOnDevice& scene, std::span<const PathStart> starts) {
  // How much room each needs is known once they have all been traced.
  std::vector<std::uint32_t> capacities;
  for (const PathSummary& summary : summarize_paths(scene, starts)) capacities.push_back(summary.event_count);
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
    record(scene, starts.subspan(first, end - first), std::span(capacities).subspan(first, end - first), events);
    auto begin = events.begin();
    for (; first < end; ++first) {
      paths.emplace_back(begin, begin + capacities[first]);
      begin += capacities[first];
    }
  }
  return paths;
}

}  // namespace tandem::pathtracer
