#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>

#include "pathtracer/scene/scene.hpp"

namespace tandem::pathtracer {

/// What the numbers of an image mean. Where they are floats (half or 32 bits) they are linear either way.
enum class TextureEncoding {
  color,  ///< integers are sRGB-encoded, alpha apart
  data    ///< linear: roughness, normals, opacity, ...
};

/// Reads an image file in the nearest format that holds it without loss. One or two channels become grey, or grey with
/// alpha; of more than four the first three count. What is not a finite number or less
/// than 1e-20 becomes 0, and so do colours below 0. Any format that decode_image reads. Throws Error, naming the file.
TextureImage load_texture_image(const std::filesystem::path& path, TextureEncoding encoding);

/// The same for the bytes of an image file. @param name for messages
TextureImage decode_texture_image(std::span<const std::byte> file, const std::string& name, TextureEncoding encoding);

/// Reads an image as opacities: its alpha channel, or without one the luminance of its values as they are stored, in 8
/// bits (TexelFormat::single_unorm8). Throws Error, naming the file.
TextureImage load_alpha_texture(const std::filesystem::path& path);

}  // namespace tandem::pathtracer
