#include "tools/report/spread.hpp"

#include <algorithm>

namespace tandem::tools {

Spread spread(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t middle = values.size() / 2;
  const double median = values.size() % 2 == 1 ? values[middle] : 0.5 * (values[middle - 1] + values[middle]);
  return {.median = median, .least = values.front(), .most = values.back()};
}

}  // namespace tandem::tools
