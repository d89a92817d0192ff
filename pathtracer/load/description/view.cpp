#include "pathtracer/load/description/view.hpp"

#include <limits>

namespace tandem::pathtracer::description {
namespace {

constexpr Range field_of_view{0, 179, true};
constexpr Range length_range{0, largest_length, false};
constexpr std::uint32_t largest_side = 32768;     ///< of a picture, pixels
constexpr std::uint32_t most_samples = 1u << 24;  ///< beyond, a further one no longer counts in a sum of floats
constexpr std::uint32_t most_depth = 1024;

std::vector<std::string> keys_of(CameraKind kind) {
  std::vector<std::string> keys = {"type", "position", "target", "up", "motion"};
  if (kind == CameraKind::perspective) keys.insert(keys.end(), {"fov", "lens_radius", "focus_distance"});
  if (kind == CameraKind::orthographic) keys.emplace_back("view_height");
  return keys;
}

std::vector<Object::OldName> old_names_of(CameraKind kind) {
  if (kind == CameraKind::perspective) return {{"vertical_fov", "fov"}};
  if (kind == CameraKind::orthographic) return {{"height", "view_height"}};
  return {};
}

template <typename T>
void read_choice(const Object& object, const std::string& key, std::optional<T>& target,
                 std::span<const Named<T>> names) {
  if (const std::optional<Value> value = object.get(key)) target = value->choice<T>(names);
}

}  // namespace

Camera read_camera(const Value& value, const glm::dvec3& origin) {
  Camera camera;
  camera.kind = type_of<CameraKind>(value, camera_names(), "type", CameraKind::perspective);
  const Object object(value, keys_of(camera.kind), old_names_of(camera.kind));
  const glm::dvec3 position = object.require("position").double_vector(any_length);
  const glm::dvec3 target = object.require("target").double_vector(any_length);
  camera.position = glm::vec3(position - origin);
  camera.target = glm::vec3(target - origin);
  object.read("up", camera.up, &Value::direction, any_length);
  object.read("motion", camera.motion, &Value::vector, any_length);
  if (camera.kind == CameraKind::perspective) {
    object.read("fov", camera.vertical_fov, &Value::number, field_of_view);
    object.read("lens_radius", camera.lens_radius, &Value::number, length_range);
    object.read("focus_distance", camera.focus_distance, &Value::number, length_range);
  }
  if (camera.kind == CameraKind::orthographic)
    object.read("view_height", camera.height, &Value::number, positive_length);
  try {
    // Where floats are coarse the two may coincide until the scene has its origin.
    Camera centred = camera;
    centred.position = glm::vec3(0);
    centred.target = glm::vec3(target - position);
    RenderConstants constants;
    set_camera(constants, centred, 1, 1);
  } catch (const Error& error) {
    value.fail(fmt::format("cannot be used: {}", error.what()));
  }
  return camera;
}

SceneSettings read_settings(const Value& value) {
  const Object object(value,
                      {"width", "height", "spp", "depth", "seed", "background", "integrator", "sampler", "nee", "mis",
                       "bsdf_sampling", "roulette", "max_diffuse_depth", "max_glossy_depth", "max_specular_depth",
                       "clamp_direct", "clamp_indirect", "occlusion_length", "terminator_offset"},
                      {{"samples", "spp"}, {"max_depth", "depth"}, {"light_sampling", "nee"}});
  SceneSettings settings;
  object.read("width", settings.width, &Value::whole_number, 1u, largest_side);
  object.read("height", settings.height, &Value::whole_number, 1u, largest_side);
  object.read("spp", settings.samples, &Value::whole_number, 1u, most_samples);
  object.read("depth", settings.max_depth, &Value::whole_number, 1u, most_depth);
  object.read("seed", settings.seed, &Value::whole_number, 0u, std::numeric_limits<std::uint32_t>::max());
  object.read("background", settings.background, &Value::color, radiance_range);
  read_choice(object, "integrator", settings.integrator, integrator_names());
  read_choice(object, "sampler", settings.sampler, sampler_names());
  object.read("nee", settings.light_sampling, &Value::boolean);
  read_choice(object, "mis", settings.mis, mis_names());
  read_choice(object, "bsdf_sampling", settings.bsdf_sampling, bsdf_sampling_names());
  object.read("roulette", settings.roulette, &Value::boolean);
  object.read("max_diffuse_depth", settings.max_diffuse_depth, &Value::whole_number, 0u, most_depth);
  object.read("max_glossy_depth", settings.max_glossy_depth, &Value::whole_number, 0u, most_depth);
  object.read("max_specular_depth", settings.max_specular_depth, &Value::whole_number, 0u, most_depth);
  object.read("clamp_direct", settings.clamp_direct, &Value::number, radiance_range);
  object.read("clamp_indirect", settings.clamp_indirect, &Value::number, radiance_range);
  object.read("occlusion_length", settings.occlusion_length, &Value::number, positive_length);
  object.read("terminator_offset", settings.terminator_offset, &Value::boolean);
  return settings;
}

}  // namespace tandem::pathtracer::description
