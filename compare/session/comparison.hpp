#pragma once

#include <cstdint>
#include <optional>

#include "base/progress.hpp"
#include "compare/cause/classification.hpp"
#include "compare/metrics/detailed_metrics.hpp"
#include "compare/metrics/metrics.hpp"
#include "compare/probe/probing.hpp"
#include "compare/session/batches.hpp"
#include "compare/session/job.hpp"
#include "compare/session/rendering.hpp"
#include "compare/verdict/thresholds.hpp"
#include "compare/verdict/verdict.hpp"
#include "pathtracer/render/renderer.hpp"
#include "rhi/device.hpp"

/// One scene rendered on two devices and compared: the differential test as one call. A part of the comparison beyond
/// pictures, metrics and verdict has its options in ComparisonOptions, is done in compare_devices, and is kept in an
/// optional member of Comparison.
namespace tandem::compare {

/// What is compared, beside the scene, and how.
struct ComparisonOptions {
  std::optional<pathtracer::TracingMode> trace_a;  ///< none: what the device has, ray queries first
  std::optional<pathtracer::TracingMode> trace_b;
  std::optional<MetricSet> metrics;  ///< none: basic
  Thresholds thresholds;             ///< what the verdict holds the devices to; see thresholds_of for those of a scene
  BatchOptions batches;              ///< of tier statistical
  bool classify = false;             ///< say why pixels differ; takes an arbiter
  ClassificationOptions classification;
  bool probe = false;               ///< whether the scene's geometry is asked in other ways too
  std::uint64_t probe_rays = 2048;  ///< in each of the trials, at most
};

struct ComparedDevices {
  rhi::DeviceHandle a;             ///< the reference
  rhi::DeviceHandle b;             ///< the device under test
  rhi::DeviceHandle arbiter = {};  ///< knows the right answers to rays: `cpu-exact`; null: nothing can be classified
  /// The programs of each, for comparisons of several scenes; null: every comparison has its own.
  pathtracer::ProgramStoreHandle programs_a = {}, programs_b = {}, programs_arbiter = {};
};

/// The devices with programs that several comparisons share.
ComparedDevices with_programs(rhi::DeviceHandle a, rhi::DeviceHandle b, rhi::DeviceHandle arbiter = {});

/// All that a comparison found out.
struct Comparison {
  JobSummary job;
  Rendering a;
  Rendering b;
  Metrics metrics;
  std::optional<DetailedMetrics> detailed_metrics;
  Thresholds thresholds;
  Verdict verdict;
  std::optional<Statistics> statistics;          ///< in tier statistical; a and b are then means of batches
  std::optional<Classification> classification;  ///< where it was asked for
  std::optional<Probing> probes;                 ///< where it was asked for
};

/// A scene set up on the devices, before any rendering.
struct Session {
  ComparisonOptions options;
  JobSummary summary;
  Job job;
  ComparedDevices devices;
  pathtracer::Renderer a, b;
  std::optional<pathtracer::SceneOnDevice> arbiter;  ///< where paths are to be classified
};

/// Uploads the scene to every device, so that what one of them refuses does not cost a
/// rendering on another. Throws Error and rhi::Error; std::invalid_argument for `classify` without an arbiter or in
/// tier statistical, where every path of a and b is another.
Session prepare(ComparedDevices devices, Job job, const ComparisonOptions& options = {});

/// Compiles the shaders, renders on both devices, measures, classifies, and gives the verdict: all that the options ask
/// for.
/// @param progress its stages are the devices' names and "classification". Throws Cancelled, rhi::Error.
Comparison compare_devices(Session& session, const StageProgress& progress = {});

/// Both in one call.
Comparison compare_devices(ComparedDevices devices, Job job, const ComparisonOptions& options = {},
                           const StageProgress& progress = {});

}  // namespace tandem::compare
