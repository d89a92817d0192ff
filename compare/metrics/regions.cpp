#include "compare/metrics/regions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>

#include "compare/image/image_pair.hpp"

namespace tandem::compare {
namespace {

/// First pixel of a part, of `parts` of `size` pixels.
std::uint32_t start(std::uint32_t part, std::uint32_t parts, std::uint32_t size) {
  return static_cast<std::uint32_t>(std::uint64_t{part} * size / parts);
}

pathtracer::Image crop(const pathtracer::Image& image, const Region& region) {
  pathtracer::Image result{.width = region.width, .height = region.height, .pixels = {}};
  for (std::uint32_t y = region.y; y < region.y + region.height; ++y) {
    const auto row = image.pixels.begin() + static_cast<std::ptrdiff_t>(std::size_t{y} * image.width + region.x);
    result.pixels.insert(result.pixels.end(), row, row + region.width);
  }
  return result;
}

double mean_error(const FlipErrors& errors, const Region& region) {
  double sum = 0.0;
  for (std::uint32_t y = region.y; y < region.y + region.height; ++y) {
    for (std::uint32_t x = region.x; x < region.x + region.width; ++x) {
      sum += errors.errors[std::size_t{y} * errors.width + x];
    }
  }
  return sum / (static_cast<double>(region.width) * region.height);
}

}  // namespace

std::vector<Region> regions(const pathtracer::Image& a, const pathtracer::Image& b, const FlipErrors* flip,
                            std::uint32_t rows, std::uint32_t columns) {
  check_pair(a, b);
  rows = std::clamp(rows, 1U, a.height);
  columns = std::clamp(columns, 1U, a.width);
  std::vector<Region> result;
  for (std::uint32_t row = 0; row < rows; ++row) {
    for (std::uint32_t column = 0; column < columns; ++column) {
      Region region;
      region.row = row;
      region.column = column;
      region.x = start(column, columns, a.width);
      region.y = start(row, rows, a.height);
      region.width = start(column + 1, columns, a.width) - region.x;
      region.height = start(row + 1, rows, a.height) - region.y;
      region.metrics = measure(crop(a, region), crop(b, region));
      if (flip != nullptr) region.flip = mean_error(*flip, region);
      result.push_back(region);
    }
  }
  return result;
}

std::optional<std::size_t> worst_region(std::span<const Region> regions) {
  const auto badness = [](const Region& region) {
    const Metrics& metrics = region.metrics;
    return std::make_tuple(metrics.non_finite_a + metrics.non_finite_b, metrics.rmse, 1.0 - metrics.bit_equal);
  };
  const auto worst = std::max_element(regions.begin(), regions.end(), [&](const Region& left, const Region& right) {
    return badness(left) < badness(right);
  });
  if (worst == regions.end() || worst->metrics.bit_equal == 1.0) return std::nullopt;
  return static_cast<std::size_t>(worst - regions.begin());
}

std::string name(const Region& region) {
  return fmt::format("row {}, column {} (pixels {},{} to {},{})", region.row + 1, region.column + 1, region.x, region.y,
                     region.x + region.width - 1, region.y + region.height - 1);
}

}  // namespace tandem::compare
