#include "pathtracer/scene_loader.hpp"

#include <algorithm>
#include <string>

#include <fmt/format.h>

#include "pathtracer/description/description.hpp"
#include "pathtracer/error.hpp"
#include "pathtracer/gltf_loader.hpp"

namespace tandem::pathtracer {

Scene load_scene(const std::filesystem::path& path, const ObjOptions& options) {
  std::string extension = path.extension().string();
  std::ranges::transform(extension, extension.begin(), [](char c) { return c >= 'A' && c <= 'Z' ? char(c + 32) : c; });
  if (extension == ".obj") return load_obj(path, options);
  if (extension == ".json") return load_description(path, options);
  if (extension == ".gltf" || extension == ".glb") return load_gltf(path);
  throw Error(fmt::format("cannot read '{}': the name of a scene ends in .obj, .json, .gltf or .glb", path.string()));
}

}  // namespace tandem::pathtracer
