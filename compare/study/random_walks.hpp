#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "compare/study/fredholm_equation.hpp"
#include "rhi/device.hpp"

namespace tandem::study {

/// How a walk x_0, x_1, ..., x_n from x_0 = x scores, so that the expected score is u(x). The next state is uniform
/// over [0, 1]; the weight is W_0 = 1, W_m = W_(m-1) k(x_(m-1), x_m) / (1 - p), where p is the probability that the
/// walk is absorbed at a state.
enum class WalkEstimator : std::uint32_t {
  /// The sum of W_m f(x_m) over a walk of a given length that is never absorbed: Farnoosh and Ebrahimi (Applied
  /// Mathematics and Computation 195(1), 2008), as the thesis's section 3.5.3 has it. It leaves out the rest of the
  /// Neumann series.
  fixed_length = 0,
  absorption = 1,     ///< W_n f(x_n) / p of the state where the walk is absorbed
  collision = 2,      ///< the sum of W_m f(x_m) over its states
  expected_value = 3  ///< f(x_0) and the sum of W_m (Kf)(x_m): what collision scores next, as an expectation
};

/// Names in the order of the values: "fixed length", ...
std::vector<std::string> walk_estimator_names();

struct WalkSettings {
  std::uint32_t points = 64;  ///< (i + 1/2) / points, where the solution is sought
  double absorption = 0.5;    ///< p, in [0.1, 0.7], within which all estimators have a finite variance
  std::uint32_t length = 24;  ///< steps of WalkEstimator::fixed_length: the rest of the series is below norm^length
  std::uint32_t seed = 1;
};

/// Of the solution, at each point.
struct WalkEstimates {
  std::vector<double> means;
  std::vector<double> variances;  ///< of one walk
  double seconds = 0;             ///< of the device

  bool operator==(const WalkEstimates&) const = default;
};

/// Random walks on a device: the same bits on all of them.
class RandomWalks {
 public:
  /// Throws rhi::Error.
  explicit RandomWalks(rhi::DeviceHandle device);

  /// Runs `walks` walks from each point, a multiple of 64. Walks `first_walk` and following have random numbers that
  /// depend on nothing but seed, equation, estimator, point and their index.
  WalkEstimates run(FredholmKernel kernel, WalkEstimator estimator, const WalkSettings& settings,
                    std::uint32_t first_walk, std::uint32_t walks);

 private:
  rhi::DeviceHandle device_;
  rhi::ComputePipelineHandle pipeline_;
  rhi::QueryPoolHandle timestamps_;  ///< null where the device has none
};

}  // namespace tandem::study
