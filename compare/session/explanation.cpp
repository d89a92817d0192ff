#include "compare/session/explanation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "base/error.hpp"
#include "pathtracer/render/path_recorder.hpp"

namespace tandem::compare {
namespace {

using pathtracer::PathStart;
using pathtracer::PathSummary;

/// Of a pixel with many samples, as many paths are classified at most: each costs some recordings.
constexpr std::size_t classified_at_most = 64;

bool has_mismatch(const ExplainedSample& sample) {
  return sample.classified && sample.classified->worst() == DifferenceClass::mismatch;
}

void check(const ExplanationOptions& options, const Job& job) {
  check_has_paths(job.settings);
  if (options.pixel.x >= job.settings.width || options.pixel.y >= job.settings.height) {
    throw Error(fmt::format("pixel {},{} is outside the image of {}x{} pixels", options.pixel.x, options.pixel.y,
                            job.settings.width, job.settings.height));
  }
  if (options.sample && *options.sample >= job.samples) {
    throw Error(fmt::format("the pixel has no sample {}: its samples are 0 to {}", *options.sample, job.samples - 1));
  }
}

std::vector<ExplainedSample> compare_samples(const ExplanationOptions& options, std::uint32_t count,
                                             pathtracer::SceneOnDevice& a, pathtracer::SceneOnDevice& b) {
  std::vector<ExplainedSample> samples;
  std::vector<PathStart> starts;
  for (std::uint32_t sample = 0; sample < count; ++sample) {
    if (options.sample.value_or(sample) != sample) continue;
    samples.push_back({.sample = sample});
    starts.push_back({.path = {.pixel = options.pixel, .sample = sample}});
  }
  const std::vector<PathSummary> of_a = pathtracer::summarize_paths(a, starts),
                                 of_b = pathtracer::summarize_paths(b, starts);
  for (std::size_t i = 0; i < samples.size(); ++i) samples[i].differs = of_a[i] != of_b[i];
  return samples;
}

/// Those that differ; where none does, all, because what is observed may be wrong all the same.
void classify(std::vector<ExplainedSample>& samples, const glm::uvec2& pixel, const Devices& devices) {
  const bool any = std::ranges::any_of(samples, &ExplainedSample::differs);
  std::vector<std::size_t> chosen;
  std::vector<pathtracer::PathId> paths;
  for (std::size_t i = 0; i < samples.size() && chosen.size() < classified_at_most; ++i) {
    if (any && !samples[i].differs) continue;
    chosen.push_back(i);
    paths.push_back({.pixel = pixel, .sample = samples[i].sample});
  }
  std::vector<ClassifiedPath> paths_classified = classify_paths(devices, paths);
  for (std::size_t i = 0; i < chosen.size(); ++i) samples[chosen[i]].classified = std::move(paths_classified[i]);
}

/// The first that differs, else the first with a mismatch, else the first.
std::size_t choose(const std::vector<ExplainedSample>& samples) {
  auto found = std::ranges::find_if(samples, &ExplainedSample::differs);
  if (found == samples.end()) found = std::ranges::find_if(samples, has_mismatch);
  return found == samples.end() ? 0 : static_cast<std::size_t>(found - samples.begin());
}

std::vector<PathRay> rays_of(const pathtracer::PathId& path, std::span<const EventPair> pairs) {
  std::vector<PathRay> rays;
  for (const EventPair& pair : pairs) {
    if (!pair.a || pair.a->kind() != pathtracer::EventKind::ray) continue;
    rays.push_back(
        {.path = path, .index = static_cast<std::uint32_t>(rays.size()), .ray = pathtracer::ray_of(path, *pair.a)});
  }
  return rays;
}

}  // namespace

std::uint64_t Explanation::mismatches() const {
  std::uint64_t count = probing ? probing->count(DifferenceClass::mismatch) : 0;
  for (const ExplainedSample& sample : samples) {
    if (!sample.classified) continue;
    count += static_cast<std::uint64_t>(
        std::ranges::count(sample.classified->divergences, DifferenceClass::mismatch, &Divergence::difference_class));
  }
  return count;
}

Explanation explain(const ComparedDevices& devices, const Job& job, const ExplanationOptions& options) {
  if (!devices.arbiter) throw std::invalid_argument("explain: no arbiter");
  check(options, job);
  const auto on = [&](const rhi::DeviceHandle& device, const pathtracer::ProgramStoreHandle& programs,
                      const std::optional<pathtracer::TracingMode>& trace) {
    return pathtracer::SceneOnDevice(device, job.scene, job.settings, trace, programs);
  };
  pathtracer::SceneOnDevice a = on(devices.a, devices.programs_a, options.trace_a);
  pathtracer::SceneOnDevice b = on(devices.b, devices.programs_b, options.trace_b);
  pathtracer::SceneOnDevice arbiter = on(devices.arbiter, devices.programs_arbiter, {});

  Explanation result{.job = summary(job),
                     .a = devices.a->info(),
                     .b = devices.b->info(),
                     .arbiter = devices.arbiter->info(),
                     .trace_a = a.trace(),
                     .trace_b = b.trace(),
                     .pixel = options.pixel,
                     .samples = compare_samples(options, job.samples, a, b),
                     .names = SceneNames(job.scene),
                     .warnings = a.warnings()};
  classify(result.samples, options.pixel, {.a = a, .b = b, .arbiter = arbiter, .scene = job.scene});
  result.shown = choose(result.samples);
  const PathStart start{.path = {.pixel = options.pixel, .sample = result.shown_sample().sample}};
  result.events = pair_events(record_paths(a, {&start, 1})[0], record_paths(b, {&start, 1})[0]);
  result.first = first_difference(result.events);
  result.observed = observed_differences(result.events);
  const bool same = std::ranges::none_of(result.samples, &ExplainedSample::differs);
  if (options.probe.value_or(same)) {
    result.probing = probe(*devices.a, *devices.b, job.scene, rays_of(start.path, result.events), a.trace(), b.trace());
  }
  return result;
}

}  // namespace tandem::compare
