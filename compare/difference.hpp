#pragma once

#include "pathtracer/image.hpp"

/// Pictures of a difference. Both throw rhi::Error(invalid_argument) when the images differ in size.
namespace tandem::compare {

/// a - b in each channel, signed, in linear radiance: for an EXR.
pathtracer::Image signed_difference(const pathtracer::Image& a, const pathtracer::Image& b);

/// Where, and by how much, the images differ: a colour for the largest |a - b| of a pixel's channels, for a PNG.
/// Black: no difference. From there on a logarithmic scale of one colour a decade: dark blue up to 1e-6, blue 1e-5,
/// cyan 1e-4, green 1e-3, yellow 1e-2, red 1e-1, white from 1 on. Magenta: a NaN or an infinity in either image.
/// The colours are linear.
pathtracer::Image heat_map(const pathtracer::Image& a, const pathtracer::Image& b);

}  // namespace tandem::compare
