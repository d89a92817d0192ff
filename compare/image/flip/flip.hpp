#pragma once

#include <cstdint>

#include "compare/image/flip/flip_errors.hpp"
#include "pathtracer/image/image.hpp"

/// FLIP: how much an eye sees of a difference when two pictures alternate on a screen. Own implementations of
///  [LDR] Andersson, Nilsson, Akenine-Moller, Oskarsson, Astrom and Fairchild, FLIP: A Difference Evaluator for
///        Alternating Images, Proceedings of the ACM on Computer Graphics and Interactive Techniques 3(2), 2020;
///  [HDR] Andersson, Nilsson, Shirley and Akenine-Moller, Visualizing Errors in Rendered High Dynamic Range Images,
///        Eurographics Short Papers, 2021.
/// Both evaluate linear RGB with the primaries of sRGB and throw as check_pair. A pixel with a NaN or an infinity in
/// either image has the error 1 and is black in both while its neighbours are evaluated.
namespace tandem::compare {

/// [LDR] of the pictures that the images show without tone mapping: channels are clamped to [0, 1]. Symmetric.
FlipErrors flip(const pathtracer::Image& a, const pathtracer::Image& b, const ViewingConditions& viewing = {});

struct HdrFlipErrors {
  FlipErrors errors;
  double first_exposure = 0.0;  ///< stops
  double last_exposure = 0.0;
  std::uint32_t exposures = 0;
};

/// [HDR]: the largest error of each pixel over exposures, evenly spread from the one at which the brightest pixel of
/// the reference a is shown well to the one at which its median pixel is, each tone-mapped by an ACES curve. Negative
/// values count as 0. The median is that of the pixels which are not black; a black reference has the exposure 0 only.
HdrFlipErrors hdr_flip(const pathtracer::Image& a, const pathtracer::Image& b, const ViewingConditions& viewing = {});

/// The errors as colours for a PNG, linear: black for 0 by violet, red and orange to pale yellow for 1, near
/// matplotlib's "magma".
pathtracer::Image error_map(const FlipErrors& errors);

}  // namespace tandem::compare
