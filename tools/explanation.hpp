#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "compare/cause/classification.hpp"
#include "compare/path/alignment.hpp"
#include "compare/path/scene_names.hpp"
#include "compare/probe/probing.hpp"
#include "pathtracer/render/path_event.hpp"
#include "pathtracer/render/tracing_mode.hpp"
#include "rhi/device.hpp"
#include "tools/options/render_options.hpp"
#include "tools/report/job_report.hpp"

/// What two devices do for one pixel.
namespace tandem::tools {

struct ExplanationOptions {
  std::string a = "cpu";                           ///< the first device, the reference
  std::string b = "vulkan";                        ///< the second
  std::string arbiter = "cpu-exact";               ///< says which of two answers to a ray is right
  std::optional<pathtracer::TracingMode> trace_a;  ///< none: that of the RenderOptions
  std::optional<pathtracer::TracingMode> trace_b;
  glm::uvec2 pixel{0};                  ///< from the upper left corner
  std::optional<std::uint32_t> sample;  ///< none: all of the pixel's, of which one is shown
  std::optional<bool> probe;            ///< none: if the devices do the same for the pixel
};

/// A sample of the pixel on both devices.
struct ExplainedSample {
  std::uint32_t sample = 0;
  bool differs = false;                                   ///< in any bit that is not just observed
  std::optional<compare::ClassifiedPath> judgement = {};  ///< where it was asked for
};

/// All that `tandem explain` finds out.
struct Explanation {
  JobSummary job;
  rhi::DeviceInfo a, b, arbiter;
  pathtracer::TracingMode trace_a{}, trace_b{};
  glm::uvec2 pixel{0};
  std::vector<ExplainedSample> samples;  ///< that were looked at
  compare::SceneNames names;
  std::size_t shown = 0;  ///< index of the sample that the rest is about
  std::vector<compare::EventPair> events = {};
  std::optional<compare::FirstDifference> first = {};
  compare::ObservedDifferences observed = {};
  std::optional<compare::Probing> probing = {};

  const ExplainedSample& shown_sample() const { return samples[shown]; }
  /// Divergences and probes of class mismatch.
  std::uint64_t mismatches() const;
};

/// Records the pixel's paths; renders no picture. Throws Error for a pixel outside the picture and a sample
/// that the pixel does not have, rhi::Error for a device that is not there.
Explanation explain(const ExplanationOptions& options, const RenderOptions& render_options);

}  // namespace tandem::tools
