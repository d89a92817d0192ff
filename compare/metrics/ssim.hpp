#pragma once

#include "pathtracer/image/image.hpp"

namespace tandem::compare {

/// Structural similarity (Wang, Bovik, Sheikh and Simoncelli, Image Quality Assessment: From Error Visibility to
/// Structural Similarity, 2004, equation 13) of the pictures that the images show: 1 for equal pictures, near 0 for
/// unrelated ones, down to -1 for inverted structure.
///
/// Both images are clamped to [0, 1] and encoded by the sRGB curve (NaN is black, infinity white); compared is the
/// luma 0.2126 R + 0.7152 G + 0.0722 B. Windows are 11 x 11 Gaussians with a sigma of 1.5 pixels, K1 = 0.01 and
/// K2 = 0.03, as in the paper. The mean is over the windows that lie within the image; where none does, over all, the
/// image going on beyond its edges with the values there. Symmetric in a and b. Throws as check_pair.
double ssim(const pathtracer::Image& a, const pathtracer::Image& b);

}  // namespace tandem::compare
