#include "tools/comparison.hpp"

#include <utility>

#include "base/error.hpp"
#include "tools/options/option_values.hpp"
#include "tools/output/interruption.hpp"
#include "tools/output/progress_bar.hpp"

namespace tandem::tools {

void add_comparison_options(CLI::App& command, ComparisonOptions& options) {
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
  command.add_option("--arbiter", options.arbiter, "Device that decides which of two ray hits is right")
      ->type_name("D3")
      ->capture_default_str();
  command.add_flag(
      "--probe", options.probe,
      "Also trace recorded rays with features of acceleration structures and rays that the path tracer does not "
      "use: masks, culling, ranges of t, transformed and mirrored instances, updates, ...");
  add_whole_number(command, "--probe-rays", options.probe_rays, 1, std::uint64_t{1} << 19,
                   "Maximum number of rays to probe with, from paths spread over the whole image");
  add_threshold_options(command, options.thresholds);
  add_batch_options(command, options.batches);
}

compare::Thresholds thresholds_for(const ComparisonOptions& options, const RenderOptions& render_options) {
  compare::Thresholds thresholds = compare::thresholds_of(render_options.scene, options.usual_thresholds);
  apply(options.thresholds, thresholds);
  if (thresholds.tier == compare::Tier::statistical && options.classify)
    throw Error("--classify cannot be combined with --tier statistical: a and b have no paths in common");
  return thresholds;
}

ComparedDevices open_devices(const ComparisonOptions& options, const RenderOptions& render_options) {
  ComparedDevices devices;
  devices.a = open_device(options.a, render_options);
  devices.b = open_device(options.b, render_options);
  if (options.classify) devices.arbiter = open_device(options.arbiter, render_options);
  devices.programs_a = std::make_shared<pathtracer::ProgramStore>(devices.a);
  devices.programs_b = std::make_shared<pathtracer::ProgramStore>(devices.b);
  if (devices.arbiter) devices.programs_arbiter = std::make_shared<pathtracer::ProgramStore>(devices.arbiter);
  return devices;
}

Comparison prepare(const ComparisonOptions& options, const RenderOptions& render_options, RenderJob job,
                   ComparedDevices devices) {
  compare::Thresholds thresholds = thresholds_for(options, render_options);
  const auto renderer = [&](const rhi::DeviceHandle& device, const std::optional<pathtracer::TracingMode>& trace,
                            const pathtracer::ProgramStoreHandle& programs) {
    return pathtracer::Renderer(device, job.scene, job.settings, trace, programs);
  };
  pathtracer::Renderer a =
      renderer(devices.a, options.trace_a ? options.trace_a : render_options.trace, devices.programs_a);
  pathtracer::Renderer b =
      renderer(devices.b, options.trace_b ? options.trace_b : render_options.trace, devices.programs_b);
  a.prepare();
  b.prepare();
  std::optional<pathtracer::Renderer> arbiter;
  if (options.classify && devices.arbiter) arbiter.emplace(renderer(devices.arbiter, {}, devices.programs_arbiter));
  JobSummary job_summary = summary(render_options, job);
  return {.options = options,
          .thresholds = std::move(thresholds),
          .summary = std::move(job_summary),
          .job = std::move(job),
          .devices = std::move(devices),
          .a = std::move(a),
          .b = std::move(b),
          .arbiter = std::move(arbiter)};
}

namespace {

compare::Classification classify(Comparison& comparison, const DiffReport& report) {
  ProgressBar bar("classification");
  compare::Classification result = compare::classify(
      {comparison.a, comparison.b, *comparison.arbiter, comparison.job.scene}, report.a.image, report.b.image,
      comparison.job.samples, comparison.options.classification, [&](double fraction) {
        bar.show(fraction);
        return !interrupted();
      });
  if (interrupted()) throw Interrupted();
  return result;
}

}  // namespace

DiffReport compare_devices(Comparison& comparison) {
  const ComparisonOptions& options = comparison.options;
  const RenderJob& job = comparison.job;
  DiffReport report;
  report.job = comparison.summary;
  report.thresholds = comparison.thresholds;
  compare::Evidence evidence;
  if (report.thresholds.tier == compare::Tier::statistical) {
    report.statistics = compare_batches(comparison.a, comparison.devices.a->info(), comparison.b,
                                        comparison.devices.b->info(), job, options.batches,
                                        report.thresholds.limit(compare::RuleMetric::bias_p_value), report.a, report.b);
    evidence.bias = bias_findings(*report.statistics);
  } else {
    report.a = render(comparison.a, comparison.devices.a->info(), job.samples);
    report.b = render(comparison.b, comparison.devices.b->info(), job.samples);
  }
  evidence.metrics = report.metrics = compare::measure(report.a.image, report.b.image);
  report.detailed_metrics =
      compare::measure_in_detail(report.a.image, report.b.image, options.metrics.value_or(compare::MetricSet::basic));
  if (options.probe) {
    report.probes = compare::probe(*comparison.devices.a, *comparison.devices.b, job.scene,
                                   compare::path_rays(comparison.a, options.probe_rays), comparison.a.trace(),
                                   comparison.b.trace());
    evidence.probe_mismatches = report.probes->count(compare::DifferenceClass::mismatch);
  }
  if (comparison.arbiter) {
    report.classification = classify(comparison, report);
    evidence.mismatches = report.classification->mismatches();
  }
  report.verdict = compare::judge(evidence, report.thresholds);
  return report;
}

}  // namespace tandem::tools
