#pragma once

#include <filesystem>

#include "pathtracer/scene.hpp"

namespace tandem::pathtracer {

/// Reads an image as opacities: its alpha channel, or without one the luminance of its values as they are stored, in 8
/// bits (TexelFormat::single_unorm8). Any format that decode_image reads. Throws Error, naming the file.
TextureImage load_alpha_texture(const std::filesystem::path& path);

}  // namespace tandem::pathtracer
