#include "tests/support/statistics/chi_square.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <stdexcept>

#include "base/statistics/distributions.hpp"

namespace tandem::test {
namespace {

/// Below this the statistic of a bin is too far from a squared normal deviate (Cochran 1954).
constexpr double least_expectation = 5.0;

struct Bin {
  double expected = 0;
  double count = 0;
};

/// Ascending; neighbours are merged until each expects enough.
std::vector<Bin> pooled(std::vector<Bin> bins) {
  std::ranges::sort(bins, {}, &Bin::expected);
  std::vector<Bin> result;
  Bin pool;
  for (const Bin& bin : bins) {
    pool.expected += bin.expected;
    pool.count += bin.count;
    if (pool.expected < least_expectation) continue;
    result.push_back(pool);
    pool = {};
  }
  if (!result.empty()) {
    result.back().expected += pool.expected;
    result.back().count += pool.count;
  }
  return result;
}

}  // namespace

ChiSquare chi_square(std::span<const double> counts, std::span<const double> expected) {
  if (counts.size() != expected.size()) throw std::invalid_argument("as many expectations as counts are needed");
  const double total = std::reduce(counts.begin(), counts.end());
  const double mass = std::reduce(expected.begin(), expected.end());
  if (!(mass > 0)) throw std::invalid_argument("nothing is expected anywhere");
  std::vector<Bin> bins;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    if (!(expected[i] >= 0)) throw std::invalid_argument("an expectation is negative or not a number");
    if (expected[i] == 0 && counts[i] > 0) return {.statistic = INFINITY, .freedom = 1, .p_value = 0};
    bins.push_back({.expected = expected[i] * total / mass, .count = counts[i]});
  }
  bins = pooled(std::move(bins));
  if (bins.size() < 2) throw std::invalid_argument("there are too few samples for two bins");
  ChiSquare result;
  for (const Bin& bin : bins)
    result.statistic += (bin.count - bin.expected) * (bin.count - bin.expected) / bin.expected;
  result.freedom = static_cast<double>(bins.size() - 1);
  result.p_value = statistics::chi_square_p_value(result.statistic, result.freedom);
  return result;
}

ChiSquare chi_square_uniform(std::span<const double> counts) {
  return chi_square(counts, std::vector<double>(counts.size(), 1.0));
}

std::size_t unit_interval_bin(double u, std::size_t bins) {
  const double scaled = std::floor(u * static_cast<double>(bins));
  return static_cast<std::size_t>(std::clamp(scaled, 0.0, static_cast<double>(bins - 1)));
}

double SphereBins::solid_angle() const {
  return 2.0 * std::numbers::pi * (1.0 - lowest) / static_cast<double>(count());
}

std::size_t SphereBins::bin(const glm::dvec3& direction) const {
  const double height = (direction.z - lowest) / (1.0 - lowest);
  const double turn = std::atan2(direction.y, direction.x) / (2.0 * std::numbers::pi);
  return unit_interval_bin(height, rows) * columns + unit_interval_bin(turn < 0.0 ? turn + 1.0 : turn, columns);
}

std::vector<glm::dvec3> SphereBins::nodes(std::size_t side) const {
  std::vector<glm::dvec3> result;
  result.reserve(count() * side * side);
  const auto middle = [side](std::size_t bin, std::size_t node, std::size_t bins) {
    return (static_cast<double>(bin) + (static_cast<double>(node) + 0.5) / static_cast<double>(side)) /
           static_cast<double>(bins);
  };
  for (std::size_t index = 0; index < count(); ++index)
    for (std::size_t node = 0; node < side * side; ++node) {
      const double z = lowest + (1.0 - lowest) * middle(index / columns, node / side, rows);
      const double angle = 2.0 * std::numbers::pi * middle(index % columns, node % side, columns);
      const double radius = std::sqrt(std::max(0.0, 1.0 - z * z));
      result.emplace_back(radius * std::cos(angle), radius * std::sin(angle), z);
    }
  return result;
}

std::vector<double> SphereBins::integrals(std::span<const double> densities) const {
  const std::size_t nodes_of_bin = densities.size() / count();
  if (nodes_of_bin * count() != densities.size() || nodes_of_bin == 0)
    throw std::invalid_argument("the densities are not those at the nodes");
  std::vector<double> result;
  for (std::size_t index = 0; index < count(); ++index) {
    const auto first = densities.begin() + static_cast<std::ptrdiff_t>(index * nodes_of_bin);
    const double sum = std::reduce(first, first + static_cast<std::ptrdiff_t>(nodes_of_bin));
    result.push_back(sum * solid_angle() / static_cast<double>(nodes_of_bin));
  }
  return result;
}

}  // namespace tandem::test
