#include "pathtracer/load/scene_loader.hpp"

#include <algorithm>
#include <string>

#include <fmt/format.h>

#include "base/error.hpp"
#include "base/printable.hpp"
#include "pathtracer/load/description/description.hpp"
#include "pathtracer/load/gltf/loader.hpp"

namespace tandem::pathtracer {

namespace {

Scene load(const std::filesystem::path& path, const ObjOptions& options) {
  std::string extension = path.extension().string();
  std::ranges::transform(extension, extension.begin(), [](char c) { return c >= 'A' && c <= 'Z' ? char(c + 32) : c; });
  if (extension == ".obj") return load_obj(path, options);
  if (extension == ".json")
    return load_description(path, [&](const std::filesystem::path& model) { return load(model, options); });
  if (extension == ".gltf" || extension == ".glb") return load_gltf(path);
  throw Error(fmt::format("cannot read '{}': the name of a scene ends in .obj, .json, .gltf or .glb", path.string()));
}

}  // namespace

Scene load_scene(const std::filesystem::path& path, const ObjOptions& options) {
  Scene scene = load(path, options);
  // Names are shown in tables, pages and sentences; whoever made the file is not to write on the terminal by them.
  scene.name = printable(scene.name);
  for (std::string& name : scene.material_names) name = printable(name);
  for (TextureImage& image : scene.images) image.name = printable(image.name);
  return scene;
}

}  // namespace tandem::pathtracer
