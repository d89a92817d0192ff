#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "pathtracer/scene_buffers.hpp"

namespace tandem::pathtracer {

struct NamedMaterial {
  std::string name;
  GpuMaterial material;             ///< without its texture
  std::filesystem::path alpha_map;  ///< the file of the texture for its opacity (map_d); empty: none
};

/// Reads a Wavefront MTL file; docs/scenes.md says how its materials are understood. Throws Error, naming file and
/// line; what is ignored is appended to `warnings`, one sentence each.
std::vector<NamedMaterial> load_mtl(const std::filesystem::path& path, std::vector<std::string>& warnings);

}  // namespace tandem::pathtracer
