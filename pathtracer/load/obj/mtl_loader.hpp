#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "pathtracer/scene/buffers.hpp"

namespace tandem::pathtracer {

/// How the numbers of a texture are to be read from its file.
enum class MapKind {
  color,   ///< TextureEncoding::color
  data,    ///< TextureEncoding::data
  opacity  ///< load_alpha_texture
};

/// A texture that a material is to have.
struct MaterialMap {
  std::uint32_t GpuMaterial::*member = nullptr;  ///< which index it is
  std::filesystem::path file;                    ///< as the MTL file names it
  MapKind kind = MapKind::color;
  GpuTexture texture;  ///< how it is read
};

struct NamedMaterial {
  std::string name;
  GpuMaterial material;  ///< without its textures
  std::vector<MaterialMap> maps;
  std::optional<std::string> error = {};  ///< why nothing can have this material, with file and line
};

/// Reads a Wavefront MTL file; docs/guide/scenes.md says how its materials are understood. A value that its material
/// needs and that cannot be used is an error of this material alone, since nothing may use it. Throws Error, naming
/// file and line; what is ignored is appended to `warnings`, one sentence each.
std::vector<NamedMaterial> load_mtl(const std::filesystem::path& path, std::vector<std::string>& warnings);

}  // namespace tandem::pathtracer
