#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <utility>

#include "pathtracer/load/access/load_options.hpp"
#include "pathtracer/load/obj/mtl_loader.hpp"
#include "pathtracer/scene/scene.hpp"

namespace tandem::pathtracer {

/// The file that an MTL file in `folder` means by a texture's name: the name as it stands, or else its last part, in
/// the folder, in the folder "textures" there or in the one beside it. Nothing where there is none that
/// `options` allow to be read.
std::optional<std::filesystem::path> find_texture(const std::filesystem::path& folder,
                                                  const std::filesystem::path& name, const LoadOptions& options);

/// The images of a scene by their files, so that each is read once, and its textures by what they read and how.
struct TextureFiles {
  using Use = std::pair<std::uint32_t, std::array<std::byte, sizeof(GpuTexture)>>;

  std::map<std::pair<std::filesystem::path, MapKind>, std::uint32_t> images;
  std::map<Use, std::uint32_t> textures;
};

/// The index of the texture of a scene that reads `file` as `map` says; added where there is none yet. Throws Error,
/// naming the file.
std::uint32_t texture_of(Scene& scene, TextureFiles& files, const std::filesystem::path& file, const MaterialMap& map);

}  // namespace tandem::pathtracer
