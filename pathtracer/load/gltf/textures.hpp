#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string_view>
#include <tuple>
#include <utility>

#include "pathtracer/image/texture_image.hpp"
#include "pathtracer/load/gltf/document.hpp"
#include "pathtracer/scene/scene.hpp"

namespace tandem::pathtracer {

/// The images and textures of a document that are in the scene already.
struct GltfTextures {
  using View =
      std::tuple<std::uint32_t, std::uint32_t, std::uint32_t, std::uint32_t, TextureFilter, std::array<float, 6>>;

  std::map<std::pair<int, TextureEncoding>, std::uint32_t> images;  ///< index into Scene::images
  std::map<View, std::uint32_t> views;  ///< of image, channel, coordinates, address, filter and transform
};

/// Adds a use of a texture to the scene, where it is not there yet, with its sampler and KHR_texture_transform, for
/// texture coordinates whose v points upwards. Returns its index, or no_texture with a warning for a texture without an
/// image in a known format. Throws Error for an image that is missing or cannot be decoded.
/// @param extensions of the textureInfo @param channel, coordinates of GpuTexture @param owner the material
std::uint32_t add_gltf_texture(GltfDocument& document, Scene& scene, GltfTextures& textures, int texture,
                               const tinygltf::ExtensionMap& extensions, TextureEncoding encoding,
                               std::uint32_t channel, std::uint32_t coordinates, std::string_view owner);

}  // namespace tandem::pathtracer
