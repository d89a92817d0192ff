#include "pathtracer/scene/alias_table.hpp"

#include <algorithm>
#include <cstddef>
#include <numeric>

namespace tandem::pathtracer {
namespace {

constexpr double threshold_scale = 4294967296.0;  // 2^32: the draws of 32 random bits

}  // namespace

std::vector<AliasEntry> build_alias_table(std::span<const double> weights) {
  const double average = std::accumulate(weights.begin(), weights.end(), 0.0) / double(weights.size());
  std::vector<AliasEntry> table(weights.size());
  std::vector<double> heights(weights.size());
  // Entries below the average are filled up by one entry above it.
  std::vector<std::uint32_t> small, large;
  for (std::uint32_t i = 0; i < table.size(); ++i) {
    heights[i] = weights[i] / average;
    (heights[i] < 1 ? small : large).push_back(i);
  }
  while (!small.empty() && !large.empty()) {
    const std::uint32_t under = small.back();
    const std::uint32_t over = large.back();
    small.pop_back();
    large.pop_back();
    const auto threshold = static_cast<std::uint32_t>(heights[under] * threshold_scale);
    table[under] = {.threshold = weights[under] > 0 ? std::max(threshold, 1u) : 0, .alias = over};
    heights[over] -= 1 - heights[under];
    (heights[over] < 1 ? small : large).push_back(over);
  }
  // What is left is full, or missed it by rounding.
  for (const std::vector<std::uint32_t>& rest : {small, large})
    for (const std::uint32_t i : rest) table[i].alias = i;
  return table;
}

std::vector<double> alias_probabilities(std::span<const AliasEntry> table) {
  std::vector<double> probabilities(table.size(), 0.0);
  for (std::size_t i = 0; i < table.size(); ++i) {
    const double keep = table[i].alias == i ? 1.0 : double(table[i].threshold) / threshold_scale;
    probabilities[i] += keep / double(table.size());
    probabilities[table[i].alias] += (1 - keep) / double(table.size());
  }
  return probabilities;
}

}  // namespace tandem::pathtracer
