#include "pathtracer/load/scene_loader.hpp"

#include <algorithm>
#include <string>

#include <fmt/format.h>

#include "base/error.hpp"
#include "base/printable.hpp"
#include "pathtracer/load/access/file_access.hpp"
#include "pathtracer/load/description/description.hpp"
#include "pathtracer/load/gltf/loader.hpp"
#include "pathtracer/scene/local_origin.hpp"

namespace tandem::pathtracer {
namespace {

Scene load(const std::filesystem::path& path, const LoadOptions& options);

Scene load_at(const std::filesystem::path& path, const LoadOptions& options, const glm::dvec3& origin) {
  std::string extension = path.extension().string();
  std::ranges::transform(extension, extension.begin(), [](char c) { return c >= 'A' && c <= 'Z' ? char(c + 32) : c; });
  if (extension == ".obj") return load_obj(path, options, origin);
  if (extension == ".json") {
    const LoadOptions within = options_within(path, options);
    return load_description(
        path, within, [&](const std::filesystem::path& model) { return load(model, within); }, origin);
  }
  if (extension == ".gltf" || extension == ".glb") return load_gltf(path, options, origin);
  throw Error(fmt::format("cannot read '{}': the name of a scene ends in .obj, .json, .gltf or .glb", path.string()));
}

Scene load(const std::filesystem::path& path, const LoadOptions& options) {
  Scene scene = load_at(path, options, glm::dvec3(0));
  const glm::dvec3 origin = local_origin(scene);
  if (origin == glm::dvec3(0)) return scene;
  // What was rounded to floats is read once more, relative to the origin.
  scene = {};
  return load_at(path, options, origin);
}

}  // namespace

Scene load_scene(const std::filesystem::path& path, const LoadOptions& options) {
  Scene scene = load(path, options);
  // Names are shown in tables, pages and sentences; whoever made the file is not to write on the terminal by them.
  scene.name = printable(scene.name);
  for (std::string& name : scene.material_names) name = printable(name);
  for (TextureImage& image : scene.images) image.name = printable(image.name);
  return scene;
}

}  // namespace tandem::pathtracer
