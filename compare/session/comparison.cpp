#include "compare/session/comparison.hpp"

#include <memory>
#include <stdexcept>
#include <utility>

#include "compare/cause/unexplained_difference.hpp"
#include "compare/probe/ray.hpp"

namespace tandem::compare {

ComparedDevices with_programs(rhi::DeviceHandle a, rhi::DeviceHandle b, rhi::DeviceHandle arbiter) {
  const auto programs = [](const rhi::DeviceHandle& device) {
    return device ? std::make_shared<pathtracer::ProgramStore>(device) : nullptr;
  };
  ComparedDevices devices;
  devices.a = std::move(a);
  devices.b = std::move(b);
  devices.arbiter = std::move(arbiter);
  devices.programs_a = programs(devices.a);
  devices.programs_b = programs(devices.b);
  devices.programs_arbiter = programs(devices.arbiter);
  return devices;
}

Session prepare(ComparedDevices devices, Job job, const ComparisonOptions& options) {
  if (options.classify && !devices.arbiter) throw std::invalid_argument("prepare: classify takes an arbiter");
  if (options.classify) check_has_paths(job.settings);
  if (options.classify && options.thresholds.tier == Tier::statistical)
    throw std::invalid_argument("prepare: tier statistical has no paths to classify");
  pathtracer::Renderer a(devices.a, job.scene, job.settings, options.trace_a, devices.programs_a);
  pathtracer::Renderer b(devices.b, job.scene, job.settings, options.trace_b, devices.programs_b);
  // Both programs before either is run: making them is when a device refuses one.
  a.prepare();
  b.prepare();
  std::optional<pathtracer::SceneOnDevice> arbiter;
  if (options.classify)
    arbiter.emplace(devices.arbiter, job.scene, job.settings, std::nullopt, devices.programs_arbiter);
  JobSummary job_summary = summary(job);
  return {.options = options,
          .summary = std::move(job_summary),
          .job = std::move(job),
          .devices = std::move(devices),
          .a = std::move(a),
          .b = std::move(b),
          .arbiter = std::move(arbiter)};
}

Comparison compare_devices(Session& session, const StageProgress& progress) {
  const ComparisonOptions& options = session.options;
  const Job& job = session.job;
  compile(session.a, progress);
  compile(session.b, progress);
  Comparison result;
  result.job = session.summary;
  result.thresholds = options.thresholds;
  Evidence evidence;
  if (result.thresholds.tier == Tier::statistical) {
    result.statistics =
        compare_batches(session.a, session.b, job, options.batches, result.thresholds.limit(RuleMetric::bias_p_value),
                        result.a, result.b, progress);
    evidence.bias = bias_findings(*result.statistics);
  } else {
    result.a = render(session.a, job.samples, progress);
    result.b = render(session.b, job.samples, progress);
  }
  evidence.metrics = result.metrics = measure(result.a.image, result.b.image);
  result.detailed_metrics =
      measure_in_detail(result.a.image, result.b.image, options.metrics.value_or(MetricSet::basic));
  pathtracer::SceneOnDevice& a = session.a.scene();
  pathtracer::SceneOnDevice& b = session.b.scene();
  if (options.probe) {
    result.probes = probe(*session.devices.a, *session.devices.b, job.scene, path_rays(a, options.probe_rays),
                          a.trace(), b.trace());
    evidence.probe_mismatches = result.probes->count(DifferenceClass::mismatch);
  }
  if (session.arbiter) {
    // Cancelled, the classification is cut short; a later stage must not take it for a whole one.
    bool cancelled = false;
    const auto watched = [&](double fraction) {
      cancelled = progress && !progress("classification", fraction);
      return !cancelled;
    };
    result.classification = classify({a, b, *session.arbiter, job.scene}, result.a.image, result.b.image, job.samples,
                                     options.classification, watched);
    if (cancelled) throw Cancelled();
    evidence.mismatches = result.classification->mismatches();
    evidence.unexplained = leave_out_explained(*result.classification, result.a.image, result.b.image);
  }
  result.verdict = make_verdict(evidence, result.thresholds);
  return result;
}

Comparison compare_devices(ComparedDevices devices, Job job, const ComparisonOptions& options,
                           const StageProgress& progress) {
  Session session = prepare(std::move(devices), std::move(job), options);
  return compare_devices(session, progress);
}

}  // namespace tandem::compare
