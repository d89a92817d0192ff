#pragma once

#include <span>
#include <vector>

#include "compare/image/plane.hpp"

/// What FLIP makes of a picture before it compares: as it looks from where the viewer sits, and its features.
namespace tandem::compare {

/// One Gaussian of a contrast sensitivity function in the domain of space: weight * sqrt(pi / b) exp(-pi^2 x^2 / b), x
/// in degrees ([LDR] section 4.1).
struct SensitivityTerm {
  double weight;
  double b;  ///< square degrees
};

/// The fits of [LDR] section 4.1.
std::span<const SensitivityTerm> achromatic_sensitivity();
std::span<const SensitivityTerm> red_green_sensitivity();
std::span<const SensitivityTerm> blue_yellow_sensitivity();

/// The plane as an eye sees it that is sensitive in that way: filtered with the two-dimensional kernel, cut at three
/// standard deviations of the widest Gaussian of all channels and scaled to a sum of 1.
Plane seen(const Plane& plane, std::span<const SensitivityTerm> sensitivity, double pixels_per_degree);

/// How much edge, and how much point or thin line, there is at each pixel of an achromatic plane in [0, 1]: lengths of
/// gradients by first and by second derivatives of a Gaussian of the width that an eye detects ([LDR] section 4.2).
struct Features {
  Plane edges;
  Plane points;
};

Features features(const Plane& achromatic, double pixels_per_degree);

}  // namespace tandem::compare
