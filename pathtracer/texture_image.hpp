#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>

#include "pathtracer/scene.hpp"

namespace tandem::pathtracer {

/// What the numbers of an image mean. Where they are floats (half or 32 bits) they are linear either way.
enum class TextureEncoding {
  color,  ///< integers are sRGB-encoded, alpha apart
  data    ///< linear: roughness, normals, opacity, ...
};

/// Reads an image file in the nearest format that holds it without loss. One or two channels become grey, or grey with
/// alpha. Any format that decode_image reads. Throws Error, naming the file.
TextureImage load_texture_image(const std::filesystem::path& path, TextureEncoding encoding);

/// The same for the bytes of an image file. @param name for messages
TextureImage decode_texture_image(std::span<const std::byte> file, const std::string& name, TextureEncoding encoding);

}  // namespace tandem::pathtracer
