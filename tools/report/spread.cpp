#include "tools/report/spread.hpp"

#include <algorithm>
#include <functional>
#include <nlohmann/json.hpp>
#include <utility>

namespace tandem::tools {

Spread spread(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t middle = values.size() / 2;
  const double median = values.size() % 2 == 1 ? values[middle] : 0.5 * (values[middle - 1] + values[middle]);
  return {.median = median, .least = values.front(), .most = values.back()};
}

Spread speed_ratio(const std::vector<double>& first_milliseconds, const std::vector<double>& milliseconds) {
  std::vector<double> ratios(milliseconds.size());
  std::transform(first_milliseconds.begin(), first_milliseconds.end(), milliseconds.begin(), ratios.begin(),
                 std::divides<>());
  return spread(std::move(ratios));
}

nlohmann::ordered_json to_json(const Spread& values) {
  return {{"median", values.median}, {"min", values.least}, {"max", values.most}};
}

}  // namespace tandem::tools
