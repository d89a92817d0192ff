#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "base/progress.hpp"
#include "compare/study/sampling_study.hpp"
#include "pathtracer/render/renderer.hpp"

/// What Metropolis light transport is worth in a scene: its error against that of path tracing in the same time.
namespace tandem::study {

struct MetropolisStudySettings {
  std::vector<std::uint32_t> sample_counts = {16, 64, 256};  ///< of both integrators, ascending
  std::uint32_t pictures = 4;  ///< of each count, at least 2: under seeds from that of the renderer's settings on
};

struct IntegratorResult {
  /// In the order of the counts. An error is the standard deviation of a pixel's channel between pictures under
  /// different seeds, and needs no reference: neither integrator is biased. The seconds are the mean.
  std::vector<Measurement> measurements;

  /// The error that the integrator would have after `seconds`, by the last measurement and N^-1/2.
  double error_after(double seconds) const;
};

struct MetropolisResult {
  IntegratorResult path;
  IntegratorResult metropolis;
  /// That chance alone makes the pictures of the largest count differ so much between the integrators.
  double bias_p_value = 1;

  /// The error of path tracing over that of Metropolis, in the time of the last Metropolis picture.
  double error_ratio() const;
};

/// Measures both in the renderer's scene, under its settings but for the integrator. The time counts the bootstrap.
/// Throws what Renderer throws. @return nothing when `progress` cancelled
std::optional<MetropolisResult> study_metropolis(pathtracer::Renderer& renderer,
                                                 const MetropolisStudySettings& settings,
                                                 const Progress& progress = {});

}  // namespace tandem::study
