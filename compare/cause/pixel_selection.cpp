#include "compare/cause/pixel_selection.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>

namespace tandem::compare {
namespace {

/// About `count` pixels, one at a random place in each cell of a grid; all of them when they are no more than that.
std::vector<glm::uvec2> spread_pixels(std::uint32_t width, std::uint32_t height, std::size_t count) {
  std::vector<glm::uvec2> pixels;
  if (count == 0) return pixels;
  const double cells = std::min(static_cast<double>(count), static_cast<double>(width) * height);
  const double aspect = static_cast<double>(width) / height;
  const std::uint32_t columns =
      std::clamp(static_cast<std::uint32_t>(std::lround(std::sqrt(cells * aspect))), 1u, width);
  const std::uint32_t rows = std::clamp(static_cast<std::uint32_t>(std::lround(cells / columns)), 1u, height);
  std::mt19937 random(1);
  const auto place = [&](std::uint32_t cell, std::uint32_t cell_count, std::uint32_t size) {
    const auto begin = static_cast<std::uint32_t>(std::uint64_t{cell} * size / cell_count);
    const auto end = static_cast<std::uint32_t>((std::uint64_t{cell} + 1) * size / cell_count);
    return begin + static_cast<std::uint32_t>(random()) % (end - begin);
  };
  for (std::uint32_t row = 0; row < rows; ++row)
    for (std::uint32_t column = 0; column < columns; ++column) {
      const std::uint32_t x = place(column, columns, width);
      pixels.emplace_back(x, place(row, rows, height));
    }
  return pixels;
}

}  // namespace

std::uint64_t row_order(const glm::uvec2& pixel) { return (std::uint64_t{pixel.y} << 32u) + pixel.x; }

std::vector<SelectedPixel> select_pixels(std::span<const glm::uvec2> differing, std::uint32_t width,
                                         std::uint32_t height, std::size_t survey_count) {
  std::vector<SelectedPixel> all;
  for (const glm::uvec2& pixel : differing) all.push_back({.pixel = pixel, .differs = true});
  for (const glm::uvec2& pixel : spread_pixels(width, height, survey_count))
    all.push_back({.pixel = pixel, .surveyed = true});
  std::stable_sort(all.begin(), all.end(), [](const SelectedPixel& first, const SelectedPixel& second) {
    return row_order(first.pixel) < row_order(second.pixel);
  });
  std::vector<SelectedPixel> merged;
  for (const SelectedPixel& each : all) {
    if (merged.empty() || merged.back().pixel != each.pixel) {
      merged.push_back(each);
    } else {
      merged.back().differs |= each.differs;
      merged.back().surveyed |= each.surveyed;
    }
  }
  std::mt19937 random(2);
  for (std::size_t i = merged.size(); i > 1; --i) std::swap(merged[i - 1], merged[random() % i]);
  return merged;
}

}  // namespace tandem::compare
