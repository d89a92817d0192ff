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
                   "Number of batches, each with its own seed, into which the samples are divided to measure the noise "
                   "[one per sample, from 8 to 32]");
  add_whole_number(group, "--tile", options.tile, compare::smallest_tile, 1U << 16,
                   "Side of the tested tiles in pixels");
  add_whole_number(group, "--seed-b", options.seed_b, 0, UINT32_MAX,
                   "Seed of the second device's first batch [one that the first device does not use]");
}

}  // namespace

void add_comparison_options(CLI::App& command, ComparisonArguments& arguments) {
  compare::ComparisonOptions& options = arguments.comparison;
  add_tracing_mode(command, "--trace-a", options.trace_a, "As --trace, for the first device only");
  add_tracing_mode(command, "--trace-b", options.trace_b, "As --trace, for the second device only");
  add_named(command, "--metrics", options.metrics, compare::metric_set_names(),
            "all: also FLIP and a table of regions, which take some seconds [basic]");
  command.add_flag("--classify", options.classify,
                   "Classify why pixels differ: rounding, a tie, a decision flipped by rounding, or a mismatch");
  add_whole_number(command, "--classify-pixels", options.classification.pixel_limit, 1, std::uint64_t{1} << 24,
                   "Maximum number of pixels to classify, spread evenly over those that differ");
  add_whole_number(
      command, "--survey", options.classification.survey_pixels, 0, std::uint64_t{1} << 24,
      "Number of further pixels, spread over the whole image, whose paths are compared even if the pixels agree");
  command.add_option("--arbiter", arguments.arbiter, "Device that decides which of two ray hits is right")
      ->type_name("D3")
      ->capture_default_str();
  command.add_flag(
      "--probe", options.probe,
      "Also trace recorded rays with features of acceleration structures and rays that the path tracer does not "
      "use: masks, culling, ranges of t, transformed and mirrored instances, updates, ...");
  add_whole_number(command, "--probe-rays", options.probe_rays, 1, std::uint64_t{1} << 19,
                   "Maximum number of rays to probe with, from paths spread over the whole image");
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
    throw Error("--classify cannot be combined with --tier statistical: a and b have no paths in common");
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
