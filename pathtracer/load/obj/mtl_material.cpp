#include "pathtracer/load/obj/mtl_material.hpp"

#include <algorithm>
#include <string_view>

#include "base/error.hpp"
#include "pathtracer/scene/scene.hpp"

namespace tandem::pathtracer {
namespace {

/// Of a dielectric that gives none (exporters write Ni 0): window glass.
constexpr float default_ior = 1.5f;
/// Of a glossy material that gives none: what MTL files usually have.
constexpr float default_exponent = 10;

/// Throws Error where a value that is needed cannot be used.
void require_usable(const MtlStatements& statements, std::string_view name) {
  const auto entry = statements.unusable.find(name);
  if (entry != statements.unusable.end()) throw Error(entry->second);
}

float number(const MtlStatements& statements, std::string_view name, float fallback) {
  require_usable(statements, name);
  const auto entry = statements.numbers.find(name);
  return entry == statements.numbers.end() ? fallback : entry->second;
}

bool has_map(const MtlStatements& statements, std::string_view name) { return statements.maps.contains(name); }

/// A factor that is not given is 1 where there is a map, so that the map is the value.
glm::vec3 color(const MtlStatements& statements, std::string_view name, glm::vec3 fallback) {
  require_usable(statements, name);
  const auto entry = statements.colors.find(name);
  if (entry != statements.colors.end()) return entry->second;
  return has_map(statements, name) ? glm::vec3(1) : fallback;
}

float physical(const MtlStatements& statements, std::string_view name, float fallback) {
  return number(statements, name, has_map(statements, name) ? 1 : fallback);
}

bool is_given(const MtlStatements& statements, std::string_view name) {
  return statements.numbers.contains(name) || has_map(statements, name) || statements.unusable.contains(name);
}

float opacity(const MtlStatements& statements) {
  const bool is_opacity = statements.numbers.contains("d") || statements.unusable.contains("d");
  return is_opacity ? number(statements, "d", 1) : 1 - number(statements, "Tr", 0);
}

MaterialModel model_of(const MtlStatements& statements) {
  require_usable(statements, "illum");
  switch (statements.illum) {
    case 4:
    case 9: {
      // "Glass", which dissolves. Where there is an index of refraction, it refracts too.
      const float ior = number(statements, "Ni", 0);
      if ((ior == 0 || ior == 1) && opacity(statements) < 1) break;
      [[fallthrough]];
    }
    case 6:
    case 7:
      return is_given(statements, "Pr") ? MaterialModel::rough_dielectric : MaterialModel::dielectric;
    default:
      break;
  }
  if (is_given(statements, "Pr") || is_given(statements, "Pm")) return MaterialModel::principled;
  const bool is_mirror = statements.illum == 3 || statements.illum == 5 || statements.illum == 8;
  if (is_mirror) return MaterialModel::mirror;
  const bool is_glossy = statements.illum == 2 && color(statements, "Ks", glm::vec3(0)) != glm::vec3(0);
  return is_glossy ? MaterialModel::blinn_phong : MaterialModel::diffuse;
}

/// What of a material may have a texture, and which models look at it.
struct MapMember {
  std::string_view name;
  std::uint32_t GpuMaterial::*member;
  MapKind kind;
  std::initializer_list<MaterialModel> models;  ///< empty: all
};

const MapMember map_members[] = {
    {"Kd",
     &GpuMaterial::base_color_texture,
     MapKind::color,
     {MaterialModel::diffuse, MaterialModel::blinn_phong, MaterialModel::principled}},
    {"Ks", &GpuMaterial::reflectance_texture, MapKind::color, {MaterialModel::mirror, MaterialModel::blinn_phong}},
    {"Ke", &GpuMaterial::emission_texture, MapKind::color, {}},
    {"Tf",
     &GpuMaterial::transmittance_texture,
     MapKind::color,
     {MaterialModel::dielectric, MaterialModel::rough_dielectric}},
    {"Ns", &GpuMaterial::exponent_texture, MapKind::data, {MaterialModel::blinn_phong}},
    {"Pr",
     &GpuMaterial::roughness_texture,
     MapKind::data,
     {MaterialModel::principled, MaterialModel::rough_dielectric}},
    {"Pm", &GpuMaterial::metallic_texture, MapKind::data, {MaterialModel::principled}},
    {"d", &GpuMaterial::alpha_texture, MapKind::opacity, {}},
    {"bump", &GpuMaterial::bump_texture, MapKind::data, {}},
    {"norm", &GpuMaterial::normal_texture, MapKind::data, {}},
};

void add_maps(NamedMaterial& result, const MtlStatements& statements) {
  for (const MapMember& entry : map_members) {
    const auto found = statements.maps.find(entry.name);
    if (found == statements.maps.end()) continue;
    const bool is_used =
        entry.models.size() == 0 || std::ranges::find(entry.models, result.material.model) != entry.models.end();
    if (!is_used) continue;
    const MtlMap& map = found->second;
    MaterialMap use{.member = entry.member, .file = map.file, .kind = entry.kind, .texture = map.texture};
    use.texture.channel = map.channel.value_or(entry.kind == MapKind::opacity ? 0 : luminance_channel);
    if (entry.kind == MapKind::opacity) {
      // The edges of what is cut out stay as sharp as the file has them.
      use.texture.filter = TextureFilter::nearest;
      if (map.channel) use.kind = MapKind::data;
    }
    if (entry.name == "bump" || entry.name == "norm") result.material.normal_scale = map.multiplier;
    result.maps.push_back(use);
  }
}

float largest(glm::vec3 color) { return std::max({color.x, color.y, color.z}); }

/// Light that a surface sends back must not be more than what arrives.
void keep_energy(GpuMaterial& material, const std::string& name, MtlRemarks& remarks) {
  if (material.model != MaterialModel::blinn_phong) {
    const bool gains = material.model == MaterialModel::diffuse || material.model == MaterialModel::principled
                           ? largest(material.base_color) > 1
                       : material.model == MaterialModel::mirror ? largest(material.reflectance) > 1
                                                                 : largest(material.transmittance) > 1;
    if (gains) remarks.bright.insert(name);
    return;
  }
  const float sum = largest(material.base_color + material.reflectance);
  if (!(sum > 1)) return;
  material.base_color /= sum;
  material.reflectance /= sum;
  remarks.scaled.insert(name);
}

}  // namespace

NamedMaterial material_of(const MtlStatements& statements, MtlRemarks& remarks) {
  NamedMaterial result{.name = statements.name, .material = {}, .maps = {}};
  GpuMaterial& material = result.material;
  material.model = model_of(statements);
  const bool is_glass =
      material.model == MaterialModel::dielectric || material.model == MaterialModel::rough_dielectric;
  const bool has_ior = is_glass || material.model == MaterialModel::principled;
  // What the model does not look at may be wrong.
  const auto color_of = [&](std::string_view name, glm::vec3 fallback, bool is_needed) {
    return is_needed || !statements.unusable.contains(name) ? color(statements, name, fallback) : fallback;
  };
  material.base_color = color_of("Kd", glm::vec3(0.5f), !is_glass && material.model != MaterialModel::mirror);
  material.emission = color(statements, "Ke", glm::vec3(0));
  material.reflectance = color_of(
      "Ks", glm::vec3(0), material.model == MaterialModel::mirror || material.model == MaterialModel::blinn_phong);
  // A filter that lets nothing pass is no glass; exporters write it all the same.
  const glm::vec3 filter = color_of("Tf", glm::vec3(1), is_glass);
  if (filter != glm::vec3(0)) material.transmittance = filter;
  const float ior = has_ior ? number(statements, "Ni", 0) : 0;
  // Exporters give glass a d below 1 to say that it is glass, which its model says already.
  if (!is_glass) material.opacity = opacity(statements);
  if (is_glass) material.ior = ior == 0 ? default_ior : ior;
  if (is_glass && ior == 0) remarks.without_ior.insert(statements.name);
  if (material.model == MaterialModel::rough_dielectric) material.roughness = physical(statements, "Pr", 0);
  if (material.model == MaterialModel::blinn_phong) material.exponent = number(statements, "Ns", default_exponent);
  if (material.model == MaterialModel::principled) {
    material.roughness = physical(statements, "Pr", 0.5f);
    material.metallic = physical(statements, "Pm", 0);
    material.ior = ior > 1 ? ior : default_ior;
    material.reflectance = glm::vec3(1);
  }
  keep_energy(material, statements.name, remarks);
  if (material.opacity == 0) remarks.invisible.insert(statements.name);
  add_maps(result, statements);
  // Whatever was needed has been looked at.
  for (const auto& [name, why] : statements.unusable) remarks.unneeded.insert(name + " of " + statements.name);
  return result;
}

}  // namespace tandem::pathtracer
