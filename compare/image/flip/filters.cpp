#include "compare/image/flip/filters.hpp"

#include <array>
#include <cmath>
#include <numbers>

namespace tandem::compare {
namespace {

constexpr double pi = std::numbers::pi;
constexpr std::array<SensitivityTerm, 1> achromatic = {{{1.0, 0.0047}}};
constexpr std::array<SensitivityTerm, 1> red_green = {{{1.0, 0.0053}}};
constexpr std::array<SensitivityTerm, 2> blue_yellow = {{{34.1, 0.04}, {13.5, 0.025}}};
constexpr double widest_b = 0.04;

/// Standard deviation of exp(-pi^2 x^2 / b).
double deviation(double b) { return std::sqrt(b / (2.0 * pi * pi)); }

/// Width of a feature that an eye detects, degrees.
constexpr double feature_width = 0.082;

/// Positive weights scaled to a sum of 1, negative ones to a sum of -1.
std::vector<double> balanced(std::vector<double> kernel) {
  double positive = 0.0;
  double negative = 0.0;
  for (const double weight : kernel) (weight > 0.0 ? positive : negative) += weight;
  for (double& weight : kernel) weight /= weight > 0.0 ? positive : -negative;
  return kernel;
}

Plane lengths(const Plane& x, const Plane& y) {
  Plane result = x;
  for (std::size_t index = 0; index < result.values.size(); ++index) {
    result.values[index] = std::hypot(x.values[index], y.values[index]);
  }
  return result;
}

}  // namespace

std::span<const SensitivityTerm> achromatic_sensitivity() { return achromatic; }
std::span<const SensitivityTerm> red_green_sensitivity() { return red_green; }
std::span<const SensitivityTerm> blue_yellow_sensitivity() { return blue_yellow; }

Plane seen(const Plane& plane, std::span<const SensitivityTerm> sensitivity, double pixels_per_degree) {
  const int radius = static_cast<int>(std::ceil(3.0 * deviation(widest_b) * pixels_per_degree));
  Plane result{.width = plane.width, .height = plane.height, .values = std::vector<double>(plane.values.size())};
  double total = 0.0;
  for (const SensitivityTerm& term : sensitivity) {
    // Each Gaussian of the sum is a product of one along rows and one along columns.
    const std::vector<double> kernel = gaussian_kernel(deviation(term.b) * pixels_per_degree, radius);
    const double middle = kernel[static_cast<std::size_t>(radius)];
    const double weight =
        term.weight * std::sqrt(pi / term.b) / (middle * middle);  // the kernel's sum is 1, its peak is not
    const Plane part = filtered(plane, kernel, kernel);
    for (std::size_t index = 0; index < result.values.size(); ++index)
      result.values[index] += weight * part.values[index];
    total += weight;
  }
  for (double& value : result.values) value /= total;
  return result;
}

Features features(const Plane& achromatic_plane, double pixels_per_degree) {
  const double sigma = 0.5 * feature_width * pixels_per_degree;
  const int radius = static_cast<int>(std::ceil(3.0 * sigma));
  const std::vector<double> smooth = gaussian_kernel(sigma, radius);
  std::vector<double> first;
  std::vector<double> second;
  for (int x = -radius; x <= radius; ++x) {
    const double weight = smooth[static_cast<std::size_t>(x + radius)];
    first.push_back(-x * weight);
    second.push_back((x * x / (sigma * sigma) - 1.0) * weight);
  }
  first = balanced(std::move(first));
  second = balanced(std::move(second));
  return {.edges = lengths(filtered(achromatic_plane, first, smooth), filtered(achromatic_plane, smooth, first)),
          .points = lengths(filtered(achromatic_plane, second, smooth), filtered(achromatic_plane, smooth, second))};
}

}  // namespace tandem::compare
