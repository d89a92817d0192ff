#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "pathtracer/image/image.hpp"

/// The formats of picture files. By OpenImageIO, or, for programs that are carried to other machines (OpenImageIO comes
/// with hundreds of libraries), by tinyexr and libpng: the CMake variable TANDEM_IMAGE_LIBRARY chooses. OpenImageIO is
/// loaded by the first of these functions that is called (docs/decisions/0018-image-library-on-demand.md).
namespace tandem::pathtracer {

/// Loads OpenImageIO now, so that a program learns before long work whether its images can be written. Throws Error
/// when it is not there, as all functions here then do.
void require_image_codec();

/// Strings that a file holds beside its pixels.
using ImageAttributes = std::map<std::string, std::string>;

/// An OpenEXR file of 32-bit floats or whole numbers. @param channels each of width * height words, row by row from the
/// top. Throws Error with the reason alone.
std::vector<std::byte> encode_exr(std::uint32_t width, std::uint32_t height, std::span<const ImageChannel> channels,
                                  const ImageAttributes& attributes);

/// A PNG file of 8 bits, tagged sRGB. @param rgb 3 * width * height bytes. Throws Error with the reason alone.
std::vector<std::byte> encode_png(std::uint32_t width, std::uint32_t height, std::span<const std::uint8_t> rgb,
                                  const ImageAttributes& attributes);

/// How a file stores its values; float32 stands for the types that are not named.
enum class StoredType { unorm8, unorm16, half, float32 };

struct DecodedImage {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::uint32_t channels = 0;  ///< 1 grey, 2 grey and alpha, 3 RGB, 4 RGB and alpha; others as the file has them
  std::vector<float> values;   ///< channels of a pixel side by side, row by row from the top; integers become [0, 1]
  StoredType type = StoredType::float32;
  bool is_png = false;  ///< then colours are sRGB-encoded
  ImageAttributes attributes;
};

/// Values that a picture has at most, 4 GiB of them: a file that claims more is broken, or of no use here.
inline constexpr std::uint64_t most_image_values = 1ull << 30;

/// Reads a file. Colours are not multiplied by alpha unless the file's are (OpenEXR). Throws Error with the reason
/// alone when it cannot be read.
DecodedImage decode_image(const std::filesystem::path& path);

/// The same for the bytes of a file: PNG, JPEG, OpenEXR and Radiance by OpenImageIO, else PNG and OpenEXR.
DecodedImage decode_image(std::span<const std::byte> file);

}  // namespace tandem::pathtracer
