#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "pathtracer/image/image.hpp"

namespace tandem::compare {

/// Two images of the same size, to the last bit if that is small enough.
///
/// A plane holds one byte of the floats of one channel, row by row from the top left; planes go from the highest byte
/// to the lowest, and of each byte from red to blue. Such planes compress well where neighbours are alike, and the
/// exclusive or of two images that hardly differ to nothing.
struct PackedImages {
  std::uint32_t bytes = 4;   ///< of each float, from the highest on, the others are as if 0; 4: exact
  std::string a;             ///< planes, packed
  std::string exclusive_or;  ///< of a and b, likewise
  std::string differs;       ///< for each pixel a byte, 1 where any bit of the floats differs, packed
};

/// What PackedImages may take, in characters of a page.
inline constexpr std::size_t usual_image_budget = 4'400'000;

/// As many bytes of each float as the budget allows, but at least two, which show three digits. Throws as check_pair.
/// @param budget characters
PackedImages pack_images(const pathtracer::Image& a, const pathtracer::Image& b,
                         std::size_t budget = usual_image_budget);

/// The bits of both images at some pixels, six words each: red, green and blue of a, then of b. Packed.
std::string pack_exact_values(const pathtracer::Image& a, const pathtracer::Image& b,
                              std::span<const std::uint32_t> pixel_indices);

}  // namespace tandem::compare
