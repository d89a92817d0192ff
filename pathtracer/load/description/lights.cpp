#include "pathtracer/load/description/lights.hpp"

#include <fmt/format.h>

#include "pathtracer/load/description/geometry.hpp"

namespace tandem::pathtracer::description {
namespace {

enum class Kind { point, spot, directional, rectangle, sphere };

constexpr Named<Kind> kinds[] = {{Kind::point, "point"},
                                 {Kind::spot, "spot"},
                                 {Kind::directional, "directional"},
                                 {Kind::rectangle, "rectangle"},
                                 {Kind::sphere, "sphere"}};
constexpr Range outer_angle{0, 90, true};
constexpr Range inner_angle{0, 90, false};

std::vector<std::string> keys_of(Kind kind) {
  switch (kind) {
    case Kind::point:
      return {"type", "position", "intensity"};
    case Kind::spot:
      return {"type", "position", "direction", "intensity", "inner_angle", "outer_angle"};
    case Kind::directional:
      return {"type", "direction", "irradiance"};
    case Kind::rectangle:
      return {"type", "corner", "u", "v", "radiance"};
    case Kind::sphere:
      return {"type", "centre", "radius", "radiance"};
  }
  return {};
}

/// A material that emits and reflects nothing.
std::uint32_t add_light_material(const Object& light, std::size_t number, Scene& scene) {
  scene.materials.push_back(diffuse_material(glm::vec3(0), light.require("radiance").color(radiance_range)));
  scene.material_names.push_back(fmt::format("lights[{}]", number));
  return static_cast<std::uint32_t>(scene.materials.size() - 1);
}

PunctualLight read_punctual_light(Kind kind, const Object& object, const Scene& scene) {
  PunctualLight light;
  if (kind == Kind::directional) {
    light.kind = LightKind::directional;
    light.direction = object.require("direction").direction(any_length);
    light.radiance = object.require("irradiance").color(radiance_range);
    return light;
  }
  light.kind = kind == Kind::spot ? LightKind::spot : LightKind::point;
  light.position = read_point(object.require("position"), scene);
  light.radiance = object.require("intensity").color(radiance_range);
  if (kind == Kind::point) return light;
  light.direction = object.require("direction").direction(any_length);
  object.read("outer_angle", light.outer_angle, &Value::number, outer_angle);
  object.read("inner_angle", light.inner_angle, &Value::number, inner_angle);
  if (!(light.inner_angle < light.outer_angle)) object.value().fail("must have an inner_angle below its outer_angle");
  return light;
}

}  // namespace

void add_lights(const std::optional<Value>& list, Scene& scene) {
  if (!list) return;
  std::size_t number = 0;
  for (const Value& value : list->elements()) {
    const Kind kind = type_of<Kind>(value, kinds);
    const Object object(value, keys_of(kind));
    if (kind == Kind::rectangle) {
      const glm::vec3 corner = read_point(object.require("corner"), scene);
      const glm::vec3 u = object.require("u").vector(any_length);
      const glm::vec3 v = object.require("v").vector(any_length);
      add_parallelogram(value, corner, u, v, add_light_material(object, number, scene), scene);
    } else if (kind == Kind::sphere) {
      const glm::vec3 centre = read_point(object.require("centre"), scene);
      const float radius = object.require("radius").number(positive_length);
      scene.spheres.push_back(
          {.centre = centre, .radius = radius, .material = add_light_material(object, number, scene)});
    } else {
      scene.lights.push_back(read_punctual_light(kind, object, scene));
    }
    ++number;
  }
}

Environment read_environment(const Value& value, Textures& textures) {
  const Object object(value, {"file", "radiance", "rotation"});
  Environment environment;
  if (const std::optional<Value> file = object.get("file")) environment.texture = textures.use_environment(*file);
  object.read("radiance", environment.radiance, &Value::color, radiance_range);
  object.read("rotation", environment.rotation, &Value::number, any_length);
  return environment;
}

}  // namespace tandem::pathtracer::description
