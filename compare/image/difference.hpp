#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <glm/vec2.hpp>

#include "pathtracer/image/image.hpp"

/// Where pictures differ, and pictures of it. All throw Error when the images differ in size.
namespace tandem::compare {

/// a - b in each channel, signed, in linear radiance: for an EXR.
pathtracer::Image signed_difference(const pathtracer::Image& a, const pathtracer::Image& b);

/// Where, and by how much, the images differ: a colour for the largest |a - b| of a pixel's channels, for a PNG.
/// Black: no difference. From there on a logarithmic scale of one colour a decade: dark blue up to 1e-6, blue 1e-5,
/// cyan 1e-4, green 1e-3, yellow 1e-2, red 1e-1, white from 1 on. Magenta: a NaN or an infinity in either image.
/// The colours are linear.
pathtracer::Image heat_map(const pathtracer::Image& a, const pathtracer::Image& b);

/// Pixels of which any channel has different bits, row by row; at most `limit` of them, spread evenly over the picture.
/// @param differing_count receives how many there are in all
std::vector<glm::uvec2> differing_pixels(const pathtracer::Image& a, const pathtracer::Image& b, std::size_t limit,
                                         std::uint64_t& differing_count);

}  // namespace tandem::compare
