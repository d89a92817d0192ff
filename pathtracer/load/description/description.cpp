#include "pathtracer/load/description/description.hpp"

#include <string>

#include <nlohmann/json.hpp>

#include "base/json_value.hpp"
#include "pathtracer/load/description/geometry.hpp"
#include "pathtracer/load/description/lights.hpp"
#include "pathtracer/load/description/materials.hpp"
#include "pathtracer/load/description/textures.hpp"
#include "pathtracer/load/description/view.hpp"

namespace tandem::pathtracer {

Scene load_description(const std::filesystem::path& path, const LoadOptions& options,
                       const description::ModelLoader& load_model, const glm::dvec3& origin) {
  using namespace description;
  const nlohmann::json document = json::parse(path);
  const std::filesystem::path folder = path.parent_path();
  const Object root(Value(document, path.string(), ""),
                    {"$schema", "title", "models", "spheres", "boxes", "quads", "materials", "textures", "media",
                     "lights", "environment", "medium", "camera", "settings"});
  for (const char* key : {"$schema", "title"})
    if (const std::optional<Value> text = root.get(key)) text->text();

  Scene scene;
  scene.origin = origin;
  scene.name = path.filename().string();
  Textures textures(root.get("textures"), folder, options, scene);
  const NamedIndices media = read_media(root.get("media"), scene);
  const NamedIndices materials = read_materials(root.get("materials"), textures, media, scene);
  // What the description says itself comes before what a model of it says.
  if (const std::optional<Value> camera = root.get("camera")) scene.camera = read_camera(*camera, origin);
  if (const std::optional<Value> settings = root.get("settings")) scene.settings = read_settings(*settings);
  if (const std::optional<Value> environment = root.get("environment"))
    scene.environment = read_environment(*environment, textures);
  if (const std::optional<Value> medium = root.get("medium")) scene.medium = media.find(*medium);
  add_models(root.get("models"), folder, options, load_model, materials, scene);
  add_spheres(root.get("spheres"), materials, scene);
  add_boxes(root.get("boxes"), materials, scene);
  add_quads(root.get("quads"), materials, scene);
  add_lights(root.get("lights"), scene);
  if (scene.triangles.empty() && scene.spheres.empty())
    root.value().fail("must have something to see: models, spheres, boxes or quads");
  if (scene.textures.empty()) scene.texture_coordinates.clear();
  return scene;
}

}  // namespace tandem::pathtracer
