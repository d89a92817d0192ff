#include "compare/image/plane.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace tandem::compare {
namespace {

Plane filtered_along_rows(const Plane& plane, std::span<const double> kernel) {
  const std::size_t width = plane.width;
  const std::size_t radius = kernel.size() / 2;
  Plane result{.width = plane.width, .height = plane.height, .values = {}};
  result.values.resize(plane.values.size());
  std::vector<double> padded(width + 2 * radius);
  for (std::size_t row = 0; row < plane.height; ++row) {
    const double* const source = &plane.values[row * width];
    double* const target = &result.values[row * width];
    std::fill_n(padded.begin(), radius, source[0]);
    std::copy_n(source, width, padded.begin() + static_cast<std::ptrdiff_t>(radius));
    std::fill(padded.end() - static_cast<std::ptrdiff_t>(radius), padded.end(), source[width - 1]);
    for (std::size_t tap = 0; tap < kernel.size(); ++tap) {
      for (std::size_t x = 0; x < width; ++x) target[x] += kernel[tap] * padded[x + tap];
    }
  }
  return result;
}

Plane filtered_along_columns(const Plane& plane, std::span<const double> kernel) {
  const std::size_t width = plane.width;
  const auto last_row = static_cast<std::ptrdiff_t>(plane.height) - 1;
  const auto radius = static_cast<std::ptrdiff_t>(kernel.size() / 2);
  Plane result{.width = plane.width, .height = plane.height, .values = {}};
  result.values.resize(plane.values.size());
  for (std::ptrdiff_t row = 0; row <= last_row; ++row) {
    double* const target = &result.values[static_cast<std::size_t>(row) * width];
    for (std::size_t tap = 0; tap < kernel.size(); ++tap) {
      const std::ptrdiff_t from =
          std::clamp<std::ptrdiff_t>(row + static_cast<std::ptrdiff_t>(tap) - radius, 0, last_row);
      const double* const source = &plane.values[static_cast<std::size_t>(from) * width];
      for (std::size_t x = 0; x < width; ++x) target[x] += kernel[tap] * source[x];
    }
  }
  return result;
}

}  // namespace

Plane filtered(const Plane& plane, std::span<const double> along_rows, std::span<const double> along_columns) {
  return filtered_along_columns(filtered_along_rows(plane, along_rows), along_columns);
}

std::vector<double> gaussian_kernel(double sigma, int radius) {
  std::vector<double> kernel;
  for (int x = -radius; x <= radius; ++x) kernel.push_back(std::exp(-0.5 * (x / sigma) * (x / sigma)));
  const double sum = std::accumulate(kernel.begin(), kernel.end(), 0.0);
  for (double& weight : kernel) weight /= sum;
  return kernel;
}

}  // namespace tandem::compare
