#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace tandem::pathtracer {

/// Of a discrete distribution by the alias method: take a uniform index i and 32 random bits; the choice is i when the
/// bits are below `threshold`, else `alias`. An entry that is its own alias is always chosen.
struct AliasEntry {
  std::uint32_t threshold = ~std::uint32_t{0};
  std::uint32_t alias = 0;
};

/// The table (Vose 1991) that gives each entry a probability proportional to its weight, as nearly as 32-bit thresholds
/// can: an entry with a weight above 0 has a probability above 0.
/// @param weights finite, not negative, not all 0
std::vector<AliasEntry> build_alias_table(std::span<const double> weights);

/// The probability of each entry that the thresholds really give, summed over the ways to choose it.
std::vector<double> alias_probabilities(std::span<const AliasEntry> table);

}  // namespace tandem::pathtracer
