#pragma once

#include <string>
#include <vector>

namespace tandem::tools {

/// Where an axis begins and ends, and the values that it names.
struct Ticks {
  double least = 0;
  double most = 1;  ///< more than `least`
  std::vector<double> values;
};

/// Multiples of 1, 2 or 5 times a power of ten, about `count` of them, that enclose [least, most]. Of values that are
/// the same, an axis around them.
Ticks linear_ticks(double least, double most, int count = 6);

/// Powers of ten that enclose [least, most], also 2 and 5 times them where there are few. @param least more than 0
Ticks logarithmic_ticks(double least, double most);

/// "0.25", "1500", "2e-07": without digits that say nothing.
std::string tick_text(double value);

}  // namespace tandem::tools
