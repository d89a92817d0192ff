#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

/// Whether samples have the density that they should (Pearson's chi-square test).
namespace tandem::test {

struct ChiSquare {
  double statistic = 0;
  double freedom = 0;  ///< bins - 1, after pooling
  double p_value = 1;
};

/// Counts against expectations, bin by bin. Bins with expectations below 5 are pooled, the smallest first. The
/// expectations are scaled to the number of counts, so anything proportional to a density will do; whether a density
/// integrates to 1 is another question. A count where nothing is expected has the p-value 0.
/// @param expected not negative, as many as there are counts; not all 0
ChiSquare chi_square(std::span<const double> counts, std::span<const double> expected);

/// The same for all bins equally likely.
ChiSquare chi_square_uniform(std::span<const double> counts);

/// The bin of u in [0, 1) among `bins` equal ones.
std::size_t unit_interval_bin(double u, std::size_t bins);

/// Bins of equal solid angle over the unit sphere, or its part above a height: rows of equal height in z, each split
/// into equal angles around z.
struct SphereBins {
  std::size_t rows = 16;
  std::size_t columns = 32;
  double lowest = -1.0;  ///< z where the bins begin; 0 for the hemisphere

  std::size_t count() const { return rows * columns; }
  double solid_angle() const;  ///< of one bin
  /// Of a unit vector. What lies below `lowest` counts for the lowest row.
  std::size_t bin(const glm::dvec3& direction) const;
  /// side^2 directions in each bin, bin by bin: where a density is evaluated to be integrated.
  std::vector<glm::dvec3> nodes(std::size_t side) const;
  /// The integral over each bin (by the midpoint rule) of a density that was evaluated at the nodes. Their sum is that
  /// over all bins.
  std::vector<double> integrals(std::span<const double> densities) const;
};

}  // namespace tandem::test
