#include "tools/explanation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <utility>

#include "base/error.hpp"
#include "pathtracer/render/renderer.hpp"
#include "tools/output/messages.hpp"
#include "tools/rendering.hpp"

namespace tandem::tools {
namespace {

using compare::DifferenceClass;
using pathtracer::PathStart;
using pathtracer::PathSummary;

/// Of a pixel with many samples, as many paths are judged at most: each costs some recordings.
constexpr std::size_t judged_at_most = 64;

bool is_same(const PathSummary& a, const PathSummary& b) {
  // By bits: a NaN is equal to itself, and the zeros are two. What is reserved holds anything.
  using Words = std::array<std::uint32_t, 3>;
  static_assert(sizeof(Words) == sizeof(a.radiance));
  return std::bit_cast<Words>(a.radiance) == std::bit_cast<Words>(b.radiance) && a.ray_count == b.ray_count &&
         a.event_count == b.event_count && a.digest == b.digest;
}

bool has_mismatch(const ExplainedSample& sample) {
  return sample.judgement && sample.judgement->worst() == DifferenceClass::mismatch;
}

void check(const ExplanationOptions& options, const RenderJob& job) {
  if (options.pixel.x >= job.settings.width || options.pixel.y >= job.settings.height) {
    throw Error(fmt::format("--pixel {},{} is outside the image of {}x{} pixels", options.pixel.x, options.pixel.y,
                            job.settings.width, job.settings.height));
  }
  if (options.sample && *options.sample >= job.samples) {
    throw Error(fmt::format("--sample {} does not exist: the pixel has samples 0 to {} (--spp {})", *options.sample,
                            job.samples - 1, job.samples));
  }
}

std::vector<ExplainedSample> compare_samples(const ExplanationOptions& options, std::uint32_t count,
                                             pathtracer::Renderer& a, pathtracer::Renderer& b) {
  std::vector<ExplainedSample> samples;
  std::vector<PathStart> starts;
  for (std::uint32_t sample = 0; sample < count; ++sample) {
    if (options.sample.value_or(sample) != sample) continue;
    samples.push_back({.sample = sample});
    starts.push_back({.path = {.pixel = options.pixel, .sample = sample}});
  }
  const std::vector<PathSummary> of_a = a.summarize_paths(starts), of_b = b.summarize_paths(starts);
  for (std::size_t i = 0; i < samples.size(); ++i) samples[i].differs = !is_same(of_a[i], of_b[i]);
  return samples;
}

/// Those that differ; where none does, all, because what is observed may be wrong all the same.
void judge(std::vector<ExplainedSample>& samples, const glm::uvec2& pixel, const compare::Devices& devices) {
  const bool any = std::ranges::any_of(samples, &ExplainedSample::differs);
  std::vector<std::size_t> judged;
  std::vector<pathtracer::PathId> paths;
  for (std::size_t i = 0; i < samples.size() && judged.size() < judged_at_most; ++i) {
    if (any && !samples[i].differs) continue;
    judged.push_back(i);
    paths.push_back({.pixel = pixel, .sample = samples[i].sample});
  }
  std::vector<compare::ClassifiedPath> judgements = compare::classify_paths(devices, paths);
  for (std::size_t i = 0; i < judged.size(); ++i) samples[judged[i]].judgement = std::move(judgements[i]);
}

/// The first that differs, else the first with a mismatch, else the first.
std::size_t choose(const std::vector<ExplainedSample>& samples) {
  auto found = std::ranges::find_if(samples, &ExplainedSample::differs);
  if (found == samples.end()) found = std::ranges::find_if(samples, has_mismatch);
  return found == samples.end() ? 0 : static_cast<std::size_t>(found - samples.begin());
}

std::vector<compare::PathRay> rays_of(const pathtracer::PathId& path, std::span<const compare::EventPair> pairs) {
  std::vector<compare::PathRay> rays;
  for (const compare::EventPair& pair : pairs) {
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
    if (!sample.judgement) continue;
    count += static_cast<std::uint64_t>(std::ranges::count(sample.judgement->divergences, DifferenceClass::mismatch,
                                                           &compare::Divergence::difference_class));
  }
  return count;
}

Explanation explain(const ExplanationOptions& options, const RenderOptions& render_options) {
  const RenderJob job = load_job(render_options);
  check(options, job);
  const auto renderer = [&](const rhi::DeviceHandle& device, const std::optional<pathtracer::TracingMode>& trace) {
    return pathtracer::Renderer(device, job.scene, job.settings, trace);
  };
  const auto form = [&](const std::optional<pathtracer::TracingMode>& own) { return own ? own : render_options.trace; };
  const rhi::DeviceHandle device_a = open_device(options.a, render_options);
  const rhi::DeviceHandle device_b = open_device(options.b, render_options);
  const rhi::DeviceHandle device_arbiter = open_device(options.arbiter, render_options);
  pathtracer::Renderer a = renderer(device_a, form(options.trace_a));
  pathtracer::Renderer b = renderer(device_b, form(options.trace_b));
  pathtracer::Renderer arbiter = renderer(device_arbiter, {});
  print_warnings(a.warnings());

  Explanation result{.job = summary(render_options, job),
                     .a = device_a->info(),
                     .b = device_b->info(),
                     .arbiter = device_arbiter->info(),
                     .trace_a = a.trace(),
                     .trace_b = b.trace(),
                     .pixel = options.pixel,
                     .samples = compare_samples(options, job.samples, a, b),
                     .names = compare::SceneNames(job.scene)};
  judge(result.samples, options.pixel, {.a = a, .b = b, .arbiter = arbiter, .scene = job.scene});
  result.shown = choose(result.samples);
  const PathStart start{.path = {.pixel = options.pixel, .sample = result.shown_sample().sample}};
  result.events = compare::pair_events(a.record_paths({&start, 1})[0], b.record_paths({&start, 1})[0]);
  result.first = compare::first_difference(result.events);
  result.observed = compare::observed_differences(result.events);
  const bool same = std::ranges::none_of(result.samples, &ExplainedSample::differs);
  if (options.probe.value_or(same)) {
    result.probing =
        compare::probe(*device_a, *device_b, job.scene, rays_of(start.path, result.events), a.trace(), b.trace());
  }
  return result;
}

}  // namespace tandem::tools
