#pragma once

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

}  // namespace tandem::tools
