#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "compare/cause/arbitration.hpp"
#include "compare/cause/difference_class.hpp"
#include "compare/probe/field.hpp"
#include "compare/probe/ray.hpp"
#include "compare/probe/trial.hpp"
#include "pathtracer/render/traced_ray.hpp"
#include "pathtracer/render/tracing_mode.hpp"
#include "pathtracer/scene/scene.hpp"
#include "rhi/device.hpp"

/// The scene's own geometry, asked in ways that the path tracer does not use, on two devices.
namespace tandem::compare {

/// Two answers to the same ray.
struct ProbeDifference {
  pathtracer::PathId path;
  std::uint32_t ray_index = 0;
  const char* trial = "";
  const ProbeField* field = nullptr;  ///< the first that differs, or the first by more than rounding
  std::uint32_t a = 0;                ///< the two values' bits
  std::uint32_t b = 0;
  std::uint64_t ulp = 0;  ///< between them; of numbers only
  DifferenceClass kind = DifferenceClass::mismatch;
  Ruling ruling = Ruling::tie;  ///< who is right, by doubles
};

/// What came of a trial.
struct ProbeTrial {
  const char* name = "";
  std::uint64_t rays = 0;
  std::uint64_t bit_equal = 0;  ///< rays whose answers have the same bits
  ClassCounts classes{};        ///< the other rays, by class
};

struct Probing {
  std::uint64_t rays = 0;  ///< asked in each trial
  std::vector<ProbeTrial> trials;
  std::vector<std::string> left_out;         ///< trials that were not made, and why: one sentence each
  std::vector<ProbeDifference> differences;  ///< all but those of class rounding: by trial, then ray
  /// Differences of all trials by class.
  ClassCounts classes() const;
  /// Those of one class.
  std::uint64_t count(DifferenceClass kind) const;
};

/// Asks both devices.
/// @param form_a,form_b as pathtracer::choose_tracing_mode takes them
/// @param rays finite, with a direction; others are left out
/// Throws rhi::Error for what a device refuses.
Probing probe(rhi::Device& a, rhi::Device& b, const pathtracer::Scene& scene, std::span<const PathRay> rays,
              std::optional<pathtracer::TracingMode> form_a = {}, std::optional<pathtracer::TracingMode> form_b = {});

}  // namespace tandem::compare
