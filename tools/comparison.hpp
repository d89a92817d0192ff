#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <optional>
#include <string>

#include "compare/cause/classification.hpp"
#include "compare/metrics/detailed_metrics.hpp"
#include "compare/verdict/thresholds.hpp"
#include "pathtracer/render/renderer.hpp"
#include "pathtracer/render/tracing_mode.hpp"
#include "rhi/device.hpp"
#include "tools/batches.hpp"
#include "tools/options/render_options.hpp"
#include "tools/options/threshold_options.hpp"
#include "tools/rendering.hpp"
#include "tools/report/diff_report.hpp"
#include "tools/report/job_report.hpp"

/// One scene rendered on two devices and compared: what diff, gallery, suite and matrix share. A part of the comparison
/// beyond pictures, metrics and verdict has its options in ComparisonOptions, is declared in add_comparison_options,
/// done in compare_devices, and kept in an optional member of DiffReport.
namespace tandem::tools {

/// What is compared, beside the scene, and how.
struct ComparisonOptions {
  std::string a = "cpu";                           ///< the first device, the reference
  std::string b = "vulkan";                        ///< the second
  std::optional<pathtracer::TracingMode> trace_a;  ///< none: that of the RenderOptions
  std::optional<pathtracer::TracingMode> trace_b;
  std::optional<compare::MetricSet> metrics;  ///< none: basic
  compare::Thresholds usual_thresholds;       ///< where neither `thresholds` nor the scene's file says otherwise
  ThresholdOptions thresholds;
  BatchOptions batches;   ///< of tier statistical
  bool classify = false;  ///< say why pixels differ
  compare::ClassificationOptions classification;
  std::string arbiter = "cpu-exact";  ///< the device that knows the answers to rays, for `classify`
  bool probe = false;                 ///< whether the scene's geometry is asked in other ways too
  std::uint64_t probe_rays = 2048;    ///< in each of the trials, at most
};

/// Declares the options on the command, all but the devices a and b. `options` must outlive the parsing.
void add_comparison_options(CLI::App& command, ComparisonOptions& options);

/// What a verdict holds the devices to: the options, the scene's file, and the usual thresholds, in this order. Throws
/// Error.
compare::Thresholds thresholds_for(const ComparisonOptions& options, const RenderOptions& render_options);

struct ComparedDevices {
  rhi::DeviceHandle a, b;
  rhi::DeviceHandle arbiter;  ///< null: nothing is classified
  /// The programs of each, for comparisons of several scenes; null: every comparison has its own.
  pathtracer::ProgramStoreHandle programs_a, programs_b, programs_arbiter;
};

/// Throws rhi::Error for a device that is not there.
ComparedDevices open_devices(const ComparisonOptions& options, const RenderOptions& render_options);

/// A scene set up on the devices, before any rendering.
struct Comparison {
  ComparisonOptions options;
  compare::Thresholds thresholds;
  JobSummary summary;
  RenderJob job;
  ComparedDevices devices;
  pathtracer::Renderer a, b;
  std::optional<pathtracer::Renderer> arbiter;
};

/// Reads the scene's thresholds and uploads the scene to every device, so that what one of them refuses does not cost a
/// rendering on another. Throws Error and rhi::Error.
Comparison prepare(const ComparisonOptions& options, const RenderOptions& render_options, RenderJob job,
                   ComparedDevices devices);

/// Renders on both devices, measures, judges, and does all parts that the options ask for. Throws Interrupted.
DiffReport compare_devices(Comparison& comparison);

}  // namespace tandem::tools
