#pragma once

#include "pathtracer/image/image_codec.hpp"

/// The OpenImageIO codec is a shared library of its own, which a program opens when it reads or writes its first
/// picture: OpenImageIO comes with hundreds of libraries, and most commands need none of them.
namespace tandem::pathtracer {

/// The functions of image_codec.hpp, as the module has them. They throw Error, too: libstdc++ knows a type by its name,
/// so the program catches what the module throws.
struct ImageCodecModule {
  const char*
      version;  ///< of the Tandem that it was built with; what another one has behind it may be laid out differently
  decltype(&pathtracer::encode_exr) encode_exr;
  decltype(&pathtracer::encode_png) encode_png;
  DecodedImage (*decode_path)(const std::filesystem::path& path);
  DecodedImage (*decode_bytes)(std::span<const std::byte> file);
};

/// The function that the module exports under the name `image_codec_entry`.
using ImageCodecEntry = const ImageCodecModule* (*)();
inline constexpr const char* image_codec_entry = "tandem_image_codec";

}  // namespace tandem::pathtracer
