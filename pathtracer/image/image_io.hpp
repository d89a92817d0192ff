#pragma once

#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "pathtracer/image/image.hpp"
#include "pathtracer/image/tone_map.hpp"

namespace tandem::pathtracer {

/// What a picture says of itself: "scene", "device", "samples", ... and their values. Stored in the file as strings
/// named "tandem:<key>".
using ImageMetadata = std::map<std::string, std::string>;

/// The colours of a picture as the channels R, G and B.
std::vector<ImageChannel> color_channels(const Image& image);

/// Throws Error, naming the file, unless write_image could write there now: the extension must be .exr or .png, the
/// folder must exist and take a new file, the path must not be a folder, and the image library must be installed. To be
/// called before a long rendering.
void check_image_path(const std::filesystem::path& path);

/// Writes 32-bit float OpenEXR, or PNG of 8 bits through the tone curve (NaN becomes black). The file appears whole,
/// replacing an older one, or not at all. Throws Error.
/// @param layers further channels of an OpenEXR file
void write_image(const std::filesystem::path& path, const Image& image, const ImageMetadata& metadata,
                 const Tone& tone = {}, std::span<const ImageChannel> layers = {});

/// The pixels, PNG decoded to linear as if its curve were that of sRGB, and the metadata that write_image stored when
/// `metadata` is given. Throws Error.
Image read_image(const std::filesystem::path& path, ImageMetadata* metadata = nullptr);

}  // namespace tandem::pathtracer
