#pragma once

#include "compare/cause/classification.hpp"
#include "pathtracer/image/image.hpp"

namespace tandem::compare {

/// Why pixels differ: a picture in the colours of the classes (color), linear. Black: the same bits; grey: they differ,
/// but were not classed. A surveyed pixel with a mismatch has its colour, too.
/// @param a,b the pictures that were compared, of one size
pathtracer::Image class_map(const Classification& classification, const pathtracer::Image& a,
                            const pathtracer::Image& b);

}  // namespace tandem::compare
