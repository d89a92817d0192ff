#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "base/progress.hpp"
#include "compare/study/random_walks.hpp"

/// How fast random walks solve integral equations: error, variance, time and order of convergence of each estimator,
/// against solutions that are known.
namespace tandem::study {

/// 64, 256, 1024, ... up to `most`.
std::vector<std::uint32_t> walk_counts_up_to(std::uint32_t most);

struct RandomWalkSettings {
  WalkSettings walks;
  std::vector<std::uint32_t> walk_counts = walk_counts_up_to(65536);  ///< multiples of 64, ascending, at least two
};

/// One number of walks from each point.
struct WalkMeasurement {
  std::uint32_t walks = 0;
  double rmse = 0;       ///< against the solution, over the points
  double expected = 0;   ///< what the walks' own variance says the RMSE should be
  double largest_z = 0;  ///< of all points, the largest error over its standard error
  double seconds = 0;    ///< of the device
};

struct WalkEstimatorResult {
  WalkEstimator estimator;
  std::vector<WalkMeasurement> measurements;  ///< in the order of the counts
  double variance = 0;                        ///< of one walk, the mean over the points, by the largest count

  double slope() const;       ///< of log RMSE over log walks; -1/2 for independent walks without bias
  double efficiency() const;  ///< 1 / (V T), T the seconds of one walk, by the largest count
};

struct FredholmResult {
  FredholmEquation equation;
  std::vector<WalkEstimatorResult> estimators;
};

/// Measures every estimator on every equation. Throws rhi::Error. @return nothing when `progress` cancelled
std::optional<std::vector<FredholmResult>> study_random_walks(const rhi::DeviceHandle& device,
                                                              const RandomWalkSettings& settings,
                                                              const Progress& progress = {});

}  // namespace tandem::study
