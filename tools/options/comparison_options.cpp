#include "tools/options/comparison_options.hpp"

#include "base/error.hpp"
#include "tools/options/job.hpp"
#include "tools/options/option_values.hpp"

namespace tandem::tools {
namespace {

/// Of tier statistical.
void add_batch_options(CLI::App& command, compare::BatchOptions& options) {
  CLI::App& group = *command.add_option_group("Tier statistical");
  add_whole_number(group, "--batches", options.batches, compare::fewest_batches, 1U << 16,
                   "Batches into which the samples are divided, each under a seed of its own, from which the noise is "
                   "known [as many as samples, from 8 to 32]");
  add_whole_number(group, "--tile", options.tile, compare::smallest_tile, 1U << 16,
                   "Side in pixels of the tiles that are tested");
  add_whole_number(group, "--seed-b", options.seed_b, 0, UINT32_MAX,
                   "Seed of the first batch of the second device [one that the first does not use]");
}

}  // namespace

void add_comparison_options(CLI::App& command, ComparisonArguments& arguments) {
  compare::ComparisonOptions& options = arguments.comparison;
  add_tracing_mode(command, "--trace-a", options.trace_a, "As --trace, for the first device only");
  add_tracing_mode(command, "--trace-b", options.trace_b, "As --trace, for the second device only");
  add_named(command, "--metrics", options.metrics, compare::metric_set_names(),
            "all: FLIP and a table of regions too, which takes some seconds [basic]");
  command.add_flag("--classify", options.classify,
                   "Say why pixels differ: rounding, a tie, a decision that rounding turned, or a mismatch");
  add_whole_number(command, "--classify-pixels", options.classification.pixel_limit, 1, std::uint64_t{1} << 24,
                   "Pixels to classify at most, spread evenly over those that differ");
  add_whole_number(command, "--survey", options.classification.survey_pixels, 0, std::uint64_t{1} << 24,
                   "Pixels all over the picture whose paths are compared whether they differ or not");
  command.add_option("--arbiter", arguments.arbiter, "The device that says which answer to a ray is right")
      ->type_name("D3")
      ->capture_default_str();
  command.add_flag("--probe", options.probe,
                   "Ask the scene's geometry in ways that the path tracer does not use, too: under masks, culling, "
                   "other ranges of t, moved and mirrored, updated, ...");
  add_whole_number(command, "--probe-rays", options.probe_rays, 1, std::uint64_t{1} << 19,
                   "Rays to probe with at most, of paths all over the picture");
  add_threshold_options(command, arguments.thresholds);
  add_batch_options(command, options.batches);
}

compare::ComparisonOptions comparison_options(const ComparisonArguments& arguments,
                                              const RenderOptions& render_options) {
  compare::ComparisonOptions options = arguments.comparison;
  options.thresholds = compare::thresholds_of(render_options.scene, options.thresholds);
  apply(arguments.thresholds, options.thresholds);
  if (!options.trace_a) options.trace_a = render_options.trace;
  if (!options.trace_b) options.trace_b = render_options.trace;
  if (options.thresholds.tier == compare::Tier::statistical && options.classify)
    throw Error(
        "--classify cannot be combined with --tier statistical: there a and b take other samples, so no two paths "
        "correspond");
  return options;
}

compare::ComparedDevices open_devices(const ComparisonArguments& arguments, const RenderOptions& render_options) {
  rhi::DeviceHandle a = open_device(arguments.a, render_options);
  rhi::DeviceHandle b = open_device(arguments.b, render_options);
  rhi::DeviceHandle arbiter;
  if (arguments.comparison.classify) arbiter = open_device(arguments.arbiter, render_options);
  return compare::with_programs(std::move(a), std::move(b), std::move(arbiter));
}

}  // namespace tandem::tools
