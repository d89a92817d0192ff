#pragma once

#include <cstdint>

#include <fmt/format.h>

#include "base/error.hpp"
#include "pathtracer/image/image_codec.hpp"

namespace tandem::pathtracer {

/// Bytes of a file that is read at most.
inline constexpr std::uint64_t most_image_file_bytes = std::uint64_t{1} << 32;

/// What a few bytes may become: pictures of one colour are packed well, and small. Beyond, a file must have a byte for
/// each 256 values; real pictures have a byte for ten at most.
inline constexpr std::uint64_t modest_image_values = std::uint64_t{1} << 26;
inline constexpr std::uint64_t most_values_per_byte = 256;

/// Throws Error with the reason alone unless a picture of this size is one that is read. To be called before memory is
/// taken for it. @param file_bytes of the whole file
inline void check_image_size(std::uint64_t width, std::uint64_t height, std::uint64_t channels,
                             std::uint64_t file_bytes) {
  if (width < 1 || height < 1 || channels < 1 || width > most_image_values || height > most_image_values / width ||
      width * height > most_image_values / channels)
    throw Error(
        fmt::format("its size of {}x{} with {} channels is not between 1 and 2^30 values", width, height, channels));
  const std::uint64_t values = width * height * channels;
  if (values > modest_image_values && values / most_values_per_byte > file_bytes)
    throw Error(fmt::format("its {}x{} pixels cannot be the picture of a file of {} bytes", width, height, file_bytes));
}

}  // namespace tandem::pathtracer
