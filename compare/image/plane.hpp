#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace tandem::compare {

/// One number for each pixel, row by row from the top left.
struct Plane {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::vector<double> values;  ///< width * height
};

/// Filters the rows of the plane by one kernel and then its columns by another. A kernel has an odd number of weights,
/// of which the middle one is for the pixel itself and the last one for the rightmost or lowest neighbour (a
/// correlation, in the language of signals). Beyond its edges the plane goes on with the values at the edge.
Plane filtered(const Plane& plane, std::span<const double> along_rows, std::span<const double> along_columns);

/// exp(-(x / sigma)^2 / 2) at the whole numbers from -radius to radius, scaled to a sum of 1.
std::vector<double> gaussian_kernel(double sigma, int radius);

}  // namespace tandem::compare
