#pragma once

#include <nlohmann/json_fwd.hpp>
#include <vector>

namespace tandem::tools {

/// How repeated measurements of one quantity lie.
struct Spread {
  double median = 0.0;  ///< of an even number of values: the mean of the middle two
  double least = 0.0;
  double most = 0.0;
};

/// @param values at least one
Spread spread(std::vector<double> values);

/// How many times as fast as the first device another one is, round by round: what slows the machine for a while slows
/// both. As many times of each, at least one.
Spread speed_ratio(const std::vector<double>& first_milliseconds, const std::vector<double>& milliseconds);

/// median, min and max.
nlohmann::ordered_json to_json(const Spread& values);

}  // namespace tandem::tools
