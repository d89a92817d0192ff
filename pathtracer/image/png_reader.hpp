#pragma once

#include <cstddef>
#include <span>

#include "pathtracer/image/image_codec.hpp"

/// PNG files by libpng itself, for both libraries of pictures: OpenImageIO lets libpng print its complaints.
namespace tandem::pathtracer {

bool is_png(std::span<const std::byte> file);

/// Throws Error with the reason alone.
DecodedImage decode_png(std::span<const std::byte> file);

}  // namespace tandem::pathtracer
