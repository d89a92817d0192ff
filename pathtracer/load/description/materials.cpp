#include "pathtracer/load/description/materials.hpp"

#include "pathtracer/scene/conductors.hpp"

namespace tandem::pathtracer::description {
namespace {

constexpr Named<MaterialModel> models[] = {{MaterialModel::diffuse, "diffuse"},
                                           {MaterialModel::mirror, "mirror"},
                                           {MaterialModel::dielectric, "dielectric"},
                                           {MaterialModel::oren_nayar, "oren-nayar"},
                                           {MaterialModel::phong, "phong"},
                                           {MaterialModel::blinn_phong, "blinn-phong"},
                                           {MaterialModel::conductor, "conductor"},
                                           {MaterialModel::rough_dielectric, "rough-dielectric"},
                                           {MaterialModel::thin, "thin"},
                                           {MaterialModel::principled, "principled"},
                                           {MaterialModel::boundary, "boundary"}};
constexpr Range refraction{0, 100, true};
constexpr Range absorption_index{0, 100, false};
constexpr Range exponent_range{0, 1e6, false};
constexpr Range slope_deviation{0, 1.5, false};
constexpr Range normal_scale_range{-1e6, 1e6, false};
constexpr Range anisotropy_range{-0.999, 0.999, false};
constexpr float window_glass = 1.5f;

/// The members that a material has by its model, beside those of every surface.
std::vector<std::string> own_keys_of(MaterialModel model) {
  switch (model) {
    case MaterialModel::diffuse:
      return {"base_color"};
    case MaterialModel::mirror:
      return {"reflectance"};
    case MaterialModel::dielectric:
      return {"ior", "transmittance", "medium"};
    case MaterialModel::oren_nayar:
      return {"base_color", "roughness"};
    case MaterialModel::phong:
    case MaterialModel::blinn_phong:
      return {"base_color", "reflectance", "exponent"};
    case MaterialModel::conductor:
      return {"metal", "eta", "absorption", "reflectance", "roughness"};
    case MaterialModel::rough_dielectric:
      return {"roughness", "ior", "transmittance", "medium"};
    case MaterialModel::thin:
      return {"ior", "transmittance"};
    case MaterialModel::principled:
      return {"base_color", "metallic", "roughness", "ior", "specular", "reflectance", "transmission", "medium"};
    case MaterialModel::boundary:
      return {"medium"};
  }
  return {};
}

std::vector<std::string> keys_of(MaterialModel model) {
  std::vector<std::string> keys = own_keys_of(model);
  keys.insert(keys.begin(), "model");
  if (model == MaterialModel::boundary) return keys;
  keys.insert(keys.end(), {"emission", "opacity", "alpha_cutoff", "normal_map", "bump_map", "normal_scale"});
  return keys;
}

/// Reads those members of a material that its model has, each a constant or the name of a texture.
class Reader {
 public:
  Reader(const Object& object, Textures& textures) : object_(&object), textures_(&textures) {}

  void color(const std::string& key, glm::vec3& factor, std::uint32_t& texture, const Range& each = fraction) {
    const std::optional<Value> value = get(key);
    if (!value) return;
    factor = value->is_string() ? glm::vec3(1) : value->color(each);
    if (value->is_string()) texture = textures_->use(*value, TextureUse::color);
  }

  void number(const std::string& key, float& factor, std::uint32_t& texture, const Range& range = fraction,
              TextureUse use = TextureUse::number) {
    const std::optional<Value> value = get(key);
    if (!value) return;
    factor = value->is_string() ? 1.0f : value->number(range);
    if (value->is_string()) texture = textures_->use(*value, use);
  }

  void constant(const std::string& key, float& number, const Range& range) {
    if (const std::optional<Value> value = get(key)) number = value->number(range);
  }

  void map(const std::string& key, std::uint32_t& texture, TextureUse use) {
    if (const std::optional<Value> value = get(key)) texture = textures_->use(*value, use);
  }

 private:
  std::optional<Value> get(const std::string& key) const {
    return object_->knows(key) ? object_->get(key) : std::nullopt;
  }

  const Object* object_;
  Textures* textures_;
};

/// A conductor is given by its metal, its index of refraction, or its reflectance.
void read_conductor(const Object& object, GpuMaterial& material) {
  const std::optional<Value> metal = object.get("metal");
  const std::optional<Value> eta = object.get("eta");
  const std::optional<Value> absorption = object.get("absorption");
  if (eta.has_value() != absorption.has_value()) object.value().fail("must have both eta and absorption, or neither");
  if (int{metal.has_value()} + int{eta.has_value()} + int{object.get("reflectance").has_value()} > 1)
    object.value().fail("must have one of: metal, eta with absorption, reflectance");
  if (metal) {
    std::vector<Named<const Conductor*>> names;
    // Their names are literals, so they end with a 0.
    for (const Conductor& conductor : conductors()) names.push_back({&conductor, conductor.name.data()});
    const Conductor* const conductor = metal->choice<const Conductor*>(names);
    material.eta = conductor->eta;
    material.absorption = conductor->absorption;
  }
  if (eta) {
    material.eta = eta->color(refraction);
    material.absorption = absorption->color(absorption_index);
  }
}

GpuMaterial read_material(const Value& value, Textures& textures, const NamedIndices& media) {
  GpuMaterial material;
  material.model = type_of<MaterialModel>(value, models, "model");
  const Object object(value, keys_of(material.model));
  if (object.knows("ior")) material.ior = window_glass;
  const bool has_lobe = material.model == MaterialModel::phong || material.model == MaterialModel::blinn_phong;
  if (object.knows("reflectance") && !has_lobe) material.reflectance = glm::vec3(1);
  if (material.model == MaterialModel::principled) material.roughness = 1;
  const bool is_slope = material.model == MaterialModel::oren_nayar;

  Reader reader(object, textures);
  reader.color("base_color", material.base_color, material.base_color_texture);
  reader.color("emission", material.emission, material.emission_texture, radiance_range);
  reader.color("reflectance", material.reflectance, material.reflectance_texture);
  reader.color("transmittance", material.transmittance, material.transmittance_texture);
  reader.number("opacity", material.opacity, material.alpha_texture, fraction, TextureUse::opacity);
  reader.number("roughness", material.roughness, material.roughness_texture, is_slope ? slope_deviation : fraction);
  reader.number("metallic", material.metallic, material.metallic_texture);
  reader.number("transmission", material.transmission, material.transmission_texture);
  reader.number("specular", material.specular, material.specular_texture);
  reader.number("exponent", material.exponent, material.exponent_texture, exponent_range);
  reader.constant("ior", material.ior, refraction);
  reader.constant("alpha_cutoff", material.alpha_cutoff, fraction);
  reader.constant("normal_scale", material.normal_scale, normal_scale_range);
  reader.map("normal_map", material.normal_texture, TextureUse::vector);
  reader.map("bump_map", material.bump_texture, TextureUse::number);

  if (material.normal_texture != no_texture && material.bump_texture != no_texture)
    value.fail("must have a normal_map or a bump_map, not both");
  if (material.model == MaterialModel::conductor) read_conductor(object, material);
  if (material.model == MaterialModel::boundary) object.require("medium");
  if (object.knows("medium"))
    if (const std::optional<Value> medium = object.get("medium")) material.medium = media.find(*medium);
  return material;
}

}  // namespace

std::uint32_t NamedIndices::find(const Value& name) const {
  const auto found = indices_.find(name.text());
  if (found == indices_.end())
    name.fail(fmt::format("names '{}', which is not among the {}", shortened(name.text()), kind_));
  return found->second;
}

NamedIndices read_media(const std::optional<Value>& definitions, Scene& scene) {
  NamedIndices indices("media");
  if (!definitions) return indices;
  for (const auto& [name, value] : definitions->members()) {
    const Object object(value, {"absorption", "scattering", "anisotropy"});
    GpuMedium medium;
    object.read("absorption", medium.absorption, &Value::color, radiance_range);
    object.read("scattering", medium.scattering, &Value::color, radiance_range);
    object.read("anisotropy", medium.anisotropy, &Value::number, anisotropy_range);
    indices.add(name, static_cast<std::uint32_t>(scene.media.size()));
    scene.media.push_back(medium);
  }
  return indices;
}

NamedIndices read_materials(const std::optional<Value>& definitions, Textures& textures, const NamedIndices& media,
                            Scene& scene) {
  NamedIndices indices("materials");
  if (!definitions) return indices;
  for (const auto& [name, value] : definitions->members()) {
    indices.add(name, static_cast<std::uint32_t>(scene.materials.size()));
    scene.materials.push_back(read_material(value, textures, media));
    scene.material_names.push_back(name);
  }
  return indices;
}

}  // namespace tandem::pathtracer::description
