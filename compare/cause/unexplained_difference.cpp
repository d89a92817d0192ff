#include "compare/cause/unexplained_difference.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstddef>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

namespace tandem::compare {
namespace {

using pathtracer::Image;

/// "10000 of 69713 differing pixels were classed (9990 coincident geometry, 10 rounding), none of them as a mismatch."
std::string sentence_of(const Classification& classification) {
  std::vector<std::string> counts;
  for (std::size_t i = difference_class_count; i-- > 0;)
    if (classification.pixel_counts[i] > 0)
      counts.push_back(fmt::format("{} {}", classification.pixel_counts[i], name(static_cast<DifferenceClass>(i))));
  return fmt::format("{} of {} differing pixels were classed ({}).", classification.classed_pixels,
                     classification.differing_pixels,
                     counts.empty() ? "none" : fmt::format("{}", fmt::join(counts, ", ")));
}

}  // namespace

UnexplainedDifference leave_out_explained(const Classification& classification, const Image& image_a,
                                          const Image& image_b) {
  const bool classed_all = classification.classed_pixels == classification.differing_pixels;
  const bool takes_rest = !classed_all && classification.mismatches() == 0 && classification.classed_pixels > 0;
  // Either begins with what stays of it.
  Image left = takes_rest ? image_a : image_b, left_for_mean = left;
  for (const ClassifiedPixel& classified : classification.pixels) {
    const std::size_t index = std::size_t{classified.pixel.y} * image_a.width + classified.pixel.x;
    const bool is_mismatch = classified.difference_class == DifferenceClass::mismatch;
    const bool is_rounding = classified.difference_class == DifferenceClass::rounding;
    left.pixels[index] = is_mismatch ? image_b.pixels[index] : image_a.pixels[index];
    left_for_mean.pixels[index] = is_mismatch || is_rounding ? image_b.pixels[index] : image_a.pixels[index];
  }
  UnexplainedDifference unexplained{.metrics = measure(image_a, left), .sentence = sentence_of(classification)};
  const Metrics for_mean = measure(image_a, left_for_mean);
  unexplained.metrics.mean_b = for_mean.mean_b;
  unexplained.metrics.mean_noise = for_mean.mean_noise;
  return unexplained;
}

}  // namespace tandem::compare
