#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec2.hpp>

/// Which pixels a classification looks at, and in which order.
namespace tandem::compare {

struct SelectedPixel {
  glm::uvec2 pixel{0};
  bool differs = false;   ///< it has other bits on the two devices
  bool surveyed = false;  ///< it is one of the survey's
};

/// The pixels that differ, and besides about `survey_count` pixels of the picture, one at a random place in each cell
/// of a grid (all of them when they are no more than that). Each pixel once, in an order that spreads evenly over the
/// picture from the beginning on. The same for the same arguments.
std::vector<SelectedPixel> select_pixels(std::span<const glm::uvec2> differing, std::uint32_t width,
                                         std::uint32_t height, std::size_t survey_count);

/// Orders pixels row by row from the upper left corner.
std::uint64_t row_order(const glm::uvec2& pixel);

}  // namespace tandem::compare
