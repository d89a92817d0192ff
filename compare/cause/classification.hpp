#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <glm/vec2.hpp>

#include "base/progress.hpp"
#include "compare/cause/difference_class.hpp"
#include "compare/cause/divergence.hpp"
#include "compare/cause/path_classifier.hpp"
#include "pathtracer/image/image.hpp"

/// Why two devices differ: paths are recorded on both, and every event in which they part is classed.
///
/// Device b runs each segment of a path from the state that a had at its beginning. Both then have the same inputs, bit
/// by bit, so each segment is classified by itself, however often they part on a path, and no error builds up. Two
/// answers to a ray are arbitrated by an exact tracer. Values are held to a tolerance; where that is not enough they
/// are compared, as decisions are, with what either device makes of the same state moved by rounding
/// (perturbation.hpp).
namespace tandem::compare {

/// A pixel and the worst that was found in its paths.
struct ClassifiedPixel {
  glm::uvec2 pixel{0};
  DifferenceClass difference_class = DifferenceClass::mismatch;
  /// A picture that is not the sum of the paths that its own device records: 'a', 'b', or 0. A mismatch.
  char wrong_sum = 0;
};

struct ClassificationOptions {
  std::size_t pixel_limit = 10000;  ///< of the pixels that differ, at most so many are classed, spread evenly
  std::size_t survey_pixels = 256;  ///< besides, so many pixels all over the picture, sample 0, observed fields too
  /// No more pixels are looked at once so many paths have been recorded whole, or have mismatches: it bounds time.
  /// Pixels are looked at in an order that spreads evenly, too.
  std::size_t path_limit = 100000;
  std::size_t mismatch_limit = 1000;
};

struct Classification {
  std::uint64_t differing_pixels = 0;  ///< that are not bit-equal
  std::uint64_t classed_pixels = 0;    ///< of them
  std::uint64_t surveyed_pixels = 0;
  std::uint64_t traced_paths = 0;       ///< all samples of all these pixels, on each of the devices
  std::uint64_t differing_paths = 0;    ///< of them: in any bit of any event but observed fields
  ClassCounts pixel_counts{};           ///< classed pixels by their worst class
  ClassCounts divergence_counts{};      ///< all divergences, those of the survey included
  std::vector<ClassifiedPixel> pixels;  ///< classed ones, and surveyed ones with a mismatch, row by row
  std::vector<ClassifiedPath> paths;    ///< those with divergences, in the order of pixels, then samples
  std::uint64_t mismatches() const;     ///< paths with a mismatch, and pixels with a wrong sum
};

/// Classes the difference of two pictures. @param samples behind each pixel of both
/// @param progress of the work at most; cancelling it gives what is known so far
Classification classify(Devices devices, const pathtracer::Image& image_a, const pathtracer::Image& image_b,
                        std::uint32_t samples, const ClassificationOptions& options = {},
                        const Progress& progress = {});

}  // namespace tandem::compare
