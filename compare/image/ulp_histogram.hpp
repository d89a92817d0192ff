#pragma once

#include <cstdint>
#include <vector>

#include "pathtracer/image/image.hpp"

namespace tandem::compare {

/// How many values are from `least` to `most` units in the last place apart, both included.
struct UlpBin {
  std::uint64_t least = 0;
  std::uint64_t most = 0;
  std::uint64_t values = 0;
};

/// Distances between the values of two images, three values for each pixel that is finite in both (see ulp.hpp).
struct UlpHistogram {
  std::vector<UlpBin> bins;  ///< 0, 1, 2, 3-4, 5-8, 9-16, ... up to the last that holds a value; empty without values
  std::uint64_t values = 0;
  std::uint64_t largest = 0;  ///< distance; that of the largest positive to the largest negative float is near 2^32
};

/// Throws as check_pair.
UlpHistogram ulp_histogram(const pathtracer::Image& a, const pathtracer::Image& b);

}  // namespace tandem::compare
