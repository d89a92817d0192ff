#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "compare/image/flip/flip.hpp"
#include "compare/metrics/metrics.hpp"

namespace tandem::compare {

/// A rectangle of the images and how they differ within it.
struct Region {
  std::uint32_t row = 0;  ///< of the grid, from the top
  std::uint32_t column = 0;
  std::uint32_t x = 0;  ///< first pixel
  std::uint32_t y = 0;
  std::uint32_t width = 0;  ///< pixels
  std::uint32_t height = 0;
  Metrics metrics;
  std::optional<double> flip;  ///< mean of the errors given
};

/// The images in a grid of regions as equal in size as whole pixels allow, row by row from the top left; fewer rows or
/// columns where the images have fewer pixels. Throws as check_pair.
/// @param flip errors of the same images, or none
std::vector<Region> regions(const pathtracer::Image& a, const pathtracer::Image& b, const FlipErrors* flip = nullptr,
                            std::uint32_t rows = 4, std::uint32_t columns = 4);

/// Where to look first: the index of the region with the most pixels that are not finite; then the largest RMSE; then
/// the fewest bit-equal pixels. None when all pixels are bit-equal.
std::optional<std::size_t> worst_region(std::span<const Region> regions);

/// "row 1, column 3 (pixels 256,0 to 383,127)", counted from 1 for people, pixels from 0.
std::string name(const Region& region);

}  // namespace tandem::compare
