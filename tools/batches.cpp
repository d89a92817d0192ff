#include "tools/batches.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "tools/options/option_values.hpp"

namespace tandem::tools {
namespace {

constexpr std::uint32_t fewest_batches = 8;  // with fewer, the noise is hardly known, and next to nothing is found
constexpr std::uint32_t usual_batches = 32;  // more make the test hardly stronger
/// The mean over a tile must be nearly normal. Pixels of an edge are black or white in a batch of one sample; the mean
/// of four of them is near enough, that of one is not.
constexpr std::uint32_t smallest_tile = 4;

/// What renders batches: the settings but the seed are those of the renderer.
struct BatchPlan {
  pathtracer::RenderSettings settings;
  std::uint32_t batches = 0;
  std::uint32_t samples = 0;  ///< of each
  std::uint32_t tile = 0;
};

/// Renders the batches under seeds from `first_seed` on. `rendering` receives their mean, times and rays.
compare::BatchedEstimate render_batches(pathtracer::Renderer& renderer, const rhi::DeviceInfo& device,
                                        const BatchPlan& plan, std::uint32_t first_seed, Rendering& rendering) {
  compare::BatchedEstimate estimate(plan.settings.width, plan.settings.height, plan.tile);
  double milliseconds = 0;
  std::uint64_t rays = 0;
  pathtracer::RenderSettings settings = plan.settings;
  for (std::uint32_t i = 0; i < plan.batches; ++i) {
    settings.seed = first_seed + i;
    renderer.restart(settings);
    rendering = render(renderer, device, plan.samples);
    milliseconds += rendering.milliseconds;
    rays += rendering.rays;
    estimate.add(rendering.image);
  }
  rendering.image = estimate.image();
  rendering.milliseconds = milliseconds;
  rendering.rays = rays;
  rendering.metadata["samples"] = fmt::format("{} batches of {}", plan.batches, plan.samples);
  rendering.metadata["seed"] = fmt::format("from {} on, one for each batch", first_seed);
  rendering.metadata["rays"] = fmt::to_string(rays);
  rendering.metadata["milliseconds"] = fmt::format("{:.3f}", milliseconds);
  return estimate;
}

}  // namespace

void add_batch_options(CLI::App& command, BatchOptions& options) {
  CLI::App& group = *command.add_option_group("Tier statistical");
  add_whole_number(group, "--batches", options.batches, fewest_batches, 1U << 16,
                   "Number of batches, each with its own seed, into which the samples are divided to measure the noise "
                   "[one per sample, from 8 to 32]");
  add_whole_number(group, "--tile", options.tile, smallest_tile, 1U << 16, "Side of the tested tiles in pixels");
  add_whole_number(group, "--seed-b", options.seed_b, 0, UINT32_MAX,
                   "Seed of the second device's first batch [one that the first device does not use]");
}

Statistics compare_batches(pathtracer::Renderer& a, const rhi::DeviceInfo& device_a, pathtracer::Renderer& b,
                           const rhi::DeviceInfo& device_b, const RenderJob& job, const BatchOptions& options,
                           double level, Rendering& rendering_a, Rendering& rendering_b) {
  BatchPlan plan{.settings = job.settings, .batches = 0, .samples = 0, .tile = options.tile};
  plan.batches = options.batches.value_or(std::clamp(job.samples, fewest_batches, usual_batches));
  plan.samples = (job.samples + plan.batches - 1) / plan.batches;
  plan.settings.planned_samples = plan.samples;
  Statistics result{.level = level, .batches = plan.batches, .batch_samples = plan.samples, .tile = plan.tile};
  // One after another from that of the job on, so that no two batches have the same; modulo 2^32, as is the range.
  result.seed_a = job.settings.seed;
  result.control_seed_a = result.seed_a + plan.batches;
  result.seed_b = options.seed_b.value_or(result.control_seed_a + plan.batches);
  result.control_seed_b = result.seed_b + plan.batches;
  Rendering control;
  const auto estimate_a = render_batches(a, device_a, plan, result.seed_a, rendering_a);
  const auto estimate_b = render_batches(b, device_b, plan, result.seed_b, rendering_b);
  result.bias = compare::test_bias(estimate_a, estimate_b);
  result.power = compare::bias_power(estimate_a, estimate_b, level);
  result.control_a = compare::test_bias(estimate_a, render_batches(a, device_a, plan, result.control_seed_a, control));
  result.control_b = compare::test_bias(estimate_b, render_batches(b, device_b, plan, result.control_seed_b, control));
  return result;
}

}  // namespace tandem::tools
