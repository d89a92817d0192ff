#include "pathtracer/load/scene_loader.hpp"

#include <algorithm>
#include <string>

#include <fmt/format.h>

#include "base/error.hpp"
#include "pathtracer/load/description/description.hpp"
#include "pathtracer/load/gltf/loader.hpp"

namespace tandem::pathtracer {

Scene load_scene(const std::filesystem::path& path, const ObjOptions& options) {
  std::string extension = path.extension().string();
  std::ranges::transform(extension, extension.begin(), [](char c) { return c >= 'A' && c <= 'Z' ? char(c + 32) : c; });
  if (extension == ".obj") return load_obj(path, options);
  if (extension == ".json")
    return load_description(path, [&](const std::filesystem::path& model) { return load_scene(model, options); });
  if (extension == ".gltf" || extension == ".glb") return load_gltf(path);
  throw Error(fmt::format("cannot read '{}': the name of a scene ends in .obj, .json, .gltf or .glb", path.string()));
}

}  // namespace tandem::pathtracer
