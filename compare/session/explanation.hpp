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
#include "compare/session/comparison.hpp"
#include "compare/session/job.hpp"
#include "pathtracer/render/path_event.hpp"
#include "pathtracer/render/tracing_mode.hpp"
#include "rhi/device.hpp"

/// What two devices do for one pixel.
namespace tandem::compare {

struct ExplanationOptions {
  std::optional<pathtracer::TracingMode> trace_a;  ///< none: what the device has, ray queries first
  std::optional<pathtracer::TracingMode> trace_b;
  glm::uvec2 pixel{0};                  ///< from the upper left corner
  std::optional<std::uint32_t> sample;  ///< none: all of the pixel's, of which one is shown
  std::optional<bool> probe;            ///< none: if the devices do the same for the pixel
};

/// A sample of the pixel on both devices.
struct ExplainedSample {
  std::uint32_t sample = 0;
  bool differs = false;                           ///< in any bit that is not just observed
  std::optional<ClassifiedPath> classified = {};  ///< where it was asked for
};

/// All that is found out of a pixel.
struct Explanation {
  JobSummary job;
  rhi::DeviceInfo a, b, arbiter;
  pathtracer::TracingMode trace_a{}, trace_b{};
  glm::uvec2 pixel{0};
  std::vector<ExplainedSample> samples;  ///< that were looked at
  SceneNames names;
  std::size_t shown = 0;  ///< index of the sample that the rest is about
  std::vector<EventPair> events = {};
  std::optional<FirstDifference> first = {};
  ObservedDifferences observed = {};
  std::optional<Probing> probing = {};
  std::vector<std::string> warnings = {};  ///< choices the user may not expect

  const ExplainedSample& shown_sample() const { return samples[shown]; }
  /// Divergences and probes of class mismatch.
  std::uint64_t mismatches() const;
};

/// Records the pixel's paths; renders no picture. Throws Error for a pixel outside the picture and a sample that the
/// pixel does not have, rhi::Error for what a device refuses. @param devices with an arbiter
Explanation explain(const ComparedDevices& devices, const Job& job, const ExplanationOptions& options);

}  // namespace tandem::compare
