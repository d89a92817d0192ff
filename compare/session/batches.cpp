#include "compare/session/batches.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "compare/statistics/bias_text.hpp"

namespace tandem::compare {
namespace {

constexpr std::uint32_t usual_batches = 32;  // more make the test hardly stronger

/// What renders batches: the settings but the seed are those of the renderer.
struct BatchPlan {
  pathtracer::RenderSettings settings;
  std::uint32_t batches = 0;
  std::uint32_t samples = 0;  ///< of each
  std::uint32_t tile = 0;
};

/// Renders the batches under seeds from `first_seed` on. `rendering` receives their mean, times and rays.
BatchedEstimate render_batches(pathtracer::Renderer& renderer, const BatchPlan& plan, std::uint32_t first_seed,
                               Rendering& rendering, const StageProgress& progress) {
  BatchedEstimate estimate(plan.settings.width, plan.settings.height, plan.tile);
  double milliseconds = 0;
  std::uint64_t rays = 0;
  pathtracer::RenderSettings settings = plan.settings;
  for (std::uint32_t i = 0; i < plan.batches; ++i) {
    settings.seed = first_seed + i;
    renderer.restart(settings);
    rendering = render(renderer, plan.samples, progress);
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

BiasFinding finding(const BiasTest& test, const std::string& what, const std::string& a, const std::string& b) {
  const bool in_tile = test.tiles_p_value < test.picture_p_value;
  const ComparedMean& worst = in_tile ? test.worst_tile : test.worst_mean;
  return {.sentence = fmt::format("{}: in the mean {} of {}, {}", what, name(worst.channel),
                                  in_tile ? text_of(worst.tile) : "the picture", text_of(worst, a, b)),
          .p_value = test.p_value};
}

}  // namespace

std::vector<BiasFinding> bias_findings(const Statistics& statistics) {
  return {finding(statistics.bias, "The images differ by more than noise", "a", "b"),
          finding(statistics.control_a, "Device a differs from itself under other seeds by more than noise",
                  "one picture", "the other"),
          finding(statistics.control_b, "Device b differs from itself under other seeds by more than noise",
                  "one picture", "the other")};
}

Statistics compare_batches(pathtracer::Renderer& a, pathtracer::Renderer& b, const Job& job,
                           const BatchOptions& options, double level, Rendering& rendering_a, Rendering& rendering_b,
                           const StageProgress& progress) {
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
  const auto estimate_a = render_batches(a, plan, result.seed_a, rendering_a, progress);
  const auto estimate_b = render_batches(b, plan, result.seed_b, rendering_b, progress);
  result.bias = test_bias(estimate_a, estimate_b);
  result.power = bias_power(estimate_a, estimate_b, level);
  result.control_a = test_bias(estimate_a, render_batches(a, plan, result.control_seed_a, control, progress));
  result.control_b = test_bias(estimate_b, render_batches(b, plan, result.control_seed_b, control, progress));
  return result;
}

}  // namespace tandem::compare
