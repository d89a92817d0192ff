#pragma once

#include "compare/cause/classification.hpp"
#include "compare/verdict/verdict.hpp"
#include "pathtracer/image/image.hpp"

namespace tandem::compare {

/// What is left of a difference once the pixels that were classed, and not as a mismatch, are left out. Their part in
/// the rule for means stays where they differ by rounding alone: many roundings in one direction are a bias.
///
/// Where more pixels differ than were classed, the rest counts as explained if no mismatch was found: pixels are chosen
/// evenly (pixel_selection.hpp), so of 10,000 classed ones without a mismatch at most 3 in 10,000 of the rest are one
/// (at 95 %; the rule of three). It counts as unexplained if any was.
UnexplainedDifference leave_out_explained(const Classification& classification, const pathtracer::Image& image_a,
                                          const pathtracer::Image& image_b);

}  // namespace tandem::compare
