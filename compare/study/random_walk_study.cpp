#include "compare/study/random_walk_study.hpp"

#include <algorithm>
#include <cmath>

#include "compare/study/convergence.hpp"

namespace tandem::study {
namespace {

WalkMeasurement measure(const WalkEstimates& estimates, std::uint32_t walks) {
  WalkMeasurement measurement{.walks = walks, .seconds = estimates.seconds};
  const auto points = static_cast<double>(estimates.means.size());
  for (std::size_t i = 0; i < estimates.means.size(); ++i) {
    const double error = estimates.means[i] - fredholm_solution((static_cast<double>(i) + 0.5) / points);
    const double squared_standard_error = estimates.variances[i] / walks;
    measurement.rmse += error * error / points;
    measurement.expected += squared_standard_error / points;
    measurement.largest_z = std::max(measurement.largest_z, std::abs(error) / std::sqrt(squared_standard_error));
  }
  measurement.rmse = std::sqrt(measurement.rmse);
  measurement.expected = std::sqrt(measurement.expected);
  return measurement;
}

}  // namespace

std::vector<std::uint32_t> walk_counts_up_to(std::uint32_t most) {
  std::vector<std::uint32_t> counts;
  for (std::uint32_t count = 64; count <= most; count *= 4) counts.push_back(count);
  return counts;
}

double WalkEstimatorResult::slope() const {
  std::vector<double> counts, errors;
  for (const WalkMeasurement& measurement : measurements) {
    counts.push_back(measurement.walks);
    errors.push_back(measurement.rmse);
  }
  return convergence(counts, errors).slope;
}

double WalkEstimatorResult::efficiency() const {
  const WalkMeasurement& last = measurements.back();
  return last.walks / (variance * last.seconds);
}

std::optional<std::vector<FredholmResult>> study_random_walks(const rhi::DeviceHandle& device,
                                                              const RandomWalkSettings& settings,
                                                              const Progress& progress) {
  RandomWalks walks(device);
  const std::size_t estimator_count = walk_estimator_names().size();
  double total = 0, done = 0;
  for (const std::uint32_t count : settings.walk_counts)
    total += count * static_cast<double>(fredholm_equations.size() * estimator_count);
  std::vector<FredholmResult> results;
  for (const FredholmEquation& equation : fredholm_equations) {
    FredholmResult result{.equation = equation, .estimators = {}};
    for (std::uint32_t i = 0; i < estimator_count; ++i) {
      const auto estimator = static_cast<WalkEstimator>(i);
      WalkEstimatorResult measured{.estimator = estimator, .measurements = {}};
      std::uint32_t first = 0;  // so that the counts share no walk, and their errors are independent
      for (const std::uint32_t count : settings.walk_counts) {
        if (progress && !progress(done / total)) return std::nullopt;
        const WalkEstimates estimates = walks.run(equation.kernel, estimator, settings.walks, first, count);
        measured.measurements.push_back(measure(estimates, count));
        measured.variance = 0;
        for (const double variance : estimates.variances)
          measured.variance += variance / static_cast<double>(estimates.variances.size());
        first += count;
        done += count;
      }
      result.estimators.push_back(std::move(measured));
    }
    results.push_back(std::move(result));
  }
  return results;
}

}  // namespace tandem::study
