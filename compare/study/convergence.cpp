#include "compare/study/convergence.hpp"

#include <cmath>
#include <numeric>
#include <stdexcept>
#include <vector>

namespace tandem::study {

Line fit_line(std::span<const double> x, std::span<const double> y) {
  if (x.size() != y.size() || x.size() < 2) throw std::invalid_argument("a line needs two points");
  const double count = static_cast<double>(x.size());
  const double mean_x = std::reduce(x.begin(), x.end()) / count;
  const double mean_y = std::reduce(y.begin(), y.end()) / count;
  double xx = 0, xy = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    xx += (x[i] - mean_x) * (x[i] - mean_x);
    xy += (x[i] - mean_x) * (y[i] - mean_y);
  }
  Line line;
  line.slope = xy / xx;
  line.intercept = mean_y - line.slope * mean_x;
  double residual = 0;
  for (std::size_t i = 0; i < x.size(); ++i) residual += std::pow(y[i] - line.intercept - line.slope * x[i], 2);
  if (x.size() > 2) line.slope_error = std::sqrt(residual / (count - 2) / xx);
  return line;
}

Line convergence(std::span<const double> counts, std::span<const double> errors) {
  std::vector<double> x, y;
  for (const double count : counts) x.push_back(std::log(count));
  for (const double error : errors) y.push_back(std::log(error));
  return fit_line(x, y);
}

}  // namespace tandem::study
