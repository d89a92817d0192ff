#include "tools/view/scene_file.hpp"

#include <algorithm>
#include <string>

#include <fmt/format.h>

#include "base/error.hpp"
#include "base/text_file.hpp"

namespace tandem::view {
namespace {

using Json = nlohmann::ordered_json;
using pathtracer::CameraKind;
using pathtracer::LightKind;

/// Doubles keep every float.
Json vector_json(const glm::dvec3& v) { return Json::array({v.x, v.y, v.z}); }

bool same(const pathtracer::PunctualLight& a, const pathtracer::PunctualLight& b) {
  return a.kind == b.kind && a.position == b.position && a.direction == b.direction && a.radiance == b.radiance &&
         a.inner_angle == b.inner_angle && a.outer_angle == b.outer_angle;
}

Json camera_json(const pathtracer::Camera& camera, const glm::dvec3& origin) {
  Json json;
  json["type"] = name_of(pathtracer::camera_names(), camera.kind);
  json["position"] = vector_json(glm::dvec3(camera.position) + origin);
  json["target"] = vector_json(glm::dvec3(camera.target) + origin);
  json["up"] = vector_json(camera.up);
  json["motion"] = vector_json(camera.motion);
  if (camera.kind == CameraKind::orthographic) json["view_height"] = double{camera.height};
  if (camera.kind == CameraKind::perspective) {
    json["fov"] = double{camera.vertical_fov};
    json["lens_radius"] = double{camera.lens_radius};
    json["focus_distance"] = double{camera.focus_distance};
  }
  return json;
}

Json settings_json(const View& view, std::uint32_t samples) {
  const pathtracer::RenderSettings& settings = view.settings;
  Json json;
  json["width"] = settings.width;
  json["height"] = settings.height;
  using pathtracer::SamplerKind;
  const bool planned = settings.sampler == SamplerKind::stratified || settings.sampler == SamplerKind::hammersley;
  json["spp"] = planned ? settings.planned_samples : std::max(samples, 1u);
  json["depth"] = settings.max_depth;
  json["seed"] = settings.seed;
  if (settings.background) json["background"] = vector_json(*settings.background);
  json["integrator"] = name_of(pathtracer::integrator_names(), settings.integrator);
  json["sampler"] = name_of(pathtracer::sampler_names(), settings.sampler);
  json["nee"] = settings.light_sampling;
  json["mis"] = name_of(pathtracer::mis_names(), settings.mis);
  json["bsdf_sampling"] = name_of(pathtracer::bsdf_sampling_names(), settings.bsdf_sampling);
  json["roulette"] = settings.roulette;
  if (settings.max_diffuse_depth) json["max_diffuse_depth"] = *settings.max_diffuse_depth;
  if (settings.max_glossy_depth) json["max_glossy_depth"] = *settings.max_glossy_depth;
  if (settings.max_specular_depth) json["max_specular_depth"] = *settings.max_specular_depth;
  json["clamp_direct"] = double{settings.clamp_direct};
  json["clamp_indirect"] = double{settings.clamp_indirect};
  // Without a bound by default, which is more than a description may say.
  if (settings.occlusion_length != pathtracer::RenderSettings{}.occlusion_length)
    json["occlusion_length"] = double{settings.occlusion_length};
  json["terminator_offset"] = settings.terminator_offset;
  return json;
}

Json light_json(const pathtracer::PunctualLight& light, const glm::dvec3& origin) {
  Json json;
  const bool directional = light.kind == LightKind::directional;
  json["type"] = directional ? "directional" : light.kind == LightKind::spot ? "spot" : "point";
  if (!directional) json["position"] = vector_json(glm::dvec3(light.position) + origin);
  if (light.kind != LightKind::point) json["direction"] = vector_json(light.direction);
  json[directional ? "irradiance" : "intensity"] = vector_json(light.radiance);
  if (light.kind == LightKind::spot) {
    json["inner_angle"] = double{light.inner_angle};
    json["outer_angle"] = double{light.outer_angle};
  }
  return json;
}

bool has_extent(const Json& light) {
  const std::string type = light.value("type", "");
  return type == "rectangle" || type == "sphere";
}

/// The environment was added because the scene has no light of its own; it would not be with a light.
bool has_studio(const pathtracer::Scene& scene) {
  if (!scene.environment || scene.environment->texture >= scene.textures.size()) return false;
  const pathtracer::Texture& texture = scene.textures[scene.environment->texture];
  return texture.image < scene.images.size() && scene.images[texture.image].name == "studio";
}

std::string relative_name(const std::filesystem::path& file, const std::filesystem::path& folder) {
  const std::filesystem::path name =
      std::filesystem::proximate(std::filesystem::weakly_canonical(file), std::filesystem::weakly_canonical(folder));
  return name.generic_string();
}

/// Names of files in a description, by their place in it.
void move_files(Json& document, const std::filesystem::path& from, const std::filesystem::path& to) {
  const auto move = [&](Json& object) {
    if (object.is_object() && object.contains("file"))
      object["file"] = relative_name(from / object["file"].get<std::string>(), to);
  };
  for (const char* list : {"models", "textures"})
    if (document.contains(list))
      for (Json& entry : document[list]) move(entry);
  if (document.contains("environment")) move(document["environment"]);
}

}  // namespace

nlohmann::ordered_json scene_description(const SavedView& saved, const std::filesystem::path& folder) {
  const pathtracer::Scene& scene = saved.scene;
  const View& view = saved.view;
  Json document;
  std::size_t described_lights = 0;
  if (saved.scene_file.extension() == ".json") {
    document = Json::parse(read_text(saved.scene_file));
    move_files(document, saved.scene_file.parent_path(), folder);
    if (document.contains("lights"))
      described_lights = static_cast<std::size_t>(
          std::ranges::count_if(document["lights"], [](const Json& light) { return !has_extent(light); }));
  } else {
    document["models"] = Json::array({Json::object({{"file", relative_name(saved.scene_file, folder)}})});
  }
  if (!std::ranges::equal(view.lights, scene.lights, same)) {
    if (described_lights != scene.lights.size())
      throw Error(fmt::format("{}: its lights come from a model, so a scene description cannot say how they changed",
                              scene.name));
    if (has_studio(scene) && !view.lights.empty())
      throw Error(
          fmt::format("{}: a scene description cannot have both the studio light and other lights; "
                      "give --background",
                      scene.name));
    Json lights = Json::array();
    if (document.contains("lights"))
      for (const Json& light : document["lights"])
        if (has_extent(light)) lights.push_back(light);
    for (const pathtracer::PunctualLight& light : view.lights) lights.push_back(light_json(light, scene.origin));
    document["lights"] = lights;
  }
  document["camera"] = camera_json(*view.settings.camera, scene.origin);
  document["settings"] = settings_json(view, saved.samples);
  return document;
}

}  // namespace tandem::view
