#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include <glm/vec2.hpp>

#include "compare/cause/classification.hpp"
#include "pathtracer/image/image.hpp"

namespace tandem::compare {

/// A pixel worth looking at.
struct RankedPixel {
  glm::uvec2 pixel{0};
  std::optional<DifferenceClass> difference_class;  ///< none: it was not classed
  double difference = 0;                            ///< largest |a - b| of a channel; infinite where it is no number
};

struct Ranking {
  std::uint64_t differing_pixels = 0;  ///< that are not bit-equal
  std::vector<RankedPixel> pixels;     ///< in the order in which to look at them
};

/// Pixels that differ, and those whose paths were found to be wrong all the same: by class, the worst first and those
/// without one last, then by difference, then row by row. Throws as check_pair.
/// @param classification of the images, or null  @param limit pixels at most
Ranking rank_pixels(const pathtracer::Image& a, const pathtracer::Image& b, const Classification* classification,
                    std::size_t limit);

/// Of the ranked pixels `count` whose paths to record: from the worst class at most half of them, the first in rank,
/// and all that is left spread evenly. In the order of rank.
std::vector<RankedPixel> pixels_to_record(const Ranking& ranking, std::size_t count);

}  // namespace tandem::compare
