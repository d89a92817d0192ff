#include "pathtracer/load/gltf/materials.hpp"

#include <algorithm>
#include <limits>
#include <optional>
#include <string_view>

#include <fmt/format.h>

#include "pathtracer/load/gltf/textures.hpp"

namespace tandem::pathtracer {
namespace {

/// What the members of one material are read from.
struct Reading {
  GltfDocument& document;
  Scene& scene;
  GltfTextures& textures;
  std::string owner;
  GltfMaterial& result;
};

constexpr double largest = std::numeric_limits<float>::max();
constexpr double unbounded = 1e30;
/// glTF 2.0, appendix B: of dielectrics that do not give one.
constexpr float default_ior = 1.5f;
/// So large that (ior - 1) / (ior + 1) is 1 in float.
constexpr float infinite_ior = 1e8f;

float number(Reading& reading, double value, double high, std::string_view property) {
  return gltf_number(reading.document, value, 0, high, reading.owner, property);
}

/// A number of an extension, in [0, high].
float member(Reading& reading, const tinygltf::Value& extension, const std::string& property, double absent,
             double high) {
  const tinygltf::Value* value = gltf_member(extension, property);
  if (value == nullptr) return static_cast<float>(absent);
  if (!value->IsNumber())
    throw gltf_error(reading.document, reading.owner, fmt::format("{} is not a number", property));
  return number(reading, value->GetNumberAsDouble(), high, property);
}

glm::vec3 color(Reading& reading, std::span<const double> values, std::string_view property) {
  if (values.size() < 3)
    throw gltf_error(reading.document, reading.owner, fmt::format("{} has {} numbers", property, values.size()));
  return {number(reading, values[0], unbounded, property), number(reading, values[1], unbounded, property),
          number(reading, values[2], unbounded, property)};
}

std::vector<double> numbers(const tinygltf::Value& array) {
  std::vector<double> result;
  for (int i = 0; i < static_cast<int>(array.ArrayLen()); ++i)
    result.push_back(array.Get(i).IsNumber() ? array.Get(i).GetNumberAsDouble()
                                             : std::numeric_limits<double>::quiet_NaN());
  return result;
}

/// Which of the material's two sets of texture coordinates this is; nothing for a third one.
std::optional<std::uint32_t> coordinates_of(Reading& reading, int set, std::string_view what) {
  std::array<int, 2>& known = reading.result.coordinates;
  for (std::uint32_t i = 0; i < known.size(); ++i) {
    if (known[i] < 0) known[i] = std::max(set, 0);
    if (known[i] == set) return i;
  }
  gltf_warn(reading.document,
            fmt::format("{}: {} has no effect, because it uses TEXCOORD_{} and other textures use TEXCOORD_{} and _{}",
                        reading.owner, what, set, known[0], known[1]));
  return std::nullopt;
}

std::uint32_t texture(Reading& reading, int index, int set, const tinygltf::ExtensionMap& extensions,
                      TextureEncoding encoding, std::uint32_t channel, std::string_view what) {
  if (index < 0) return no_texture;
  if (const tinygltf::Value* transform = gltf_extension(extensions, "KHR_texture_transform"))
    if (const tinygltf::Value* other = gltf_member(*transform, "texCoord"); other != nullptr && other->IsInt())
      set = other->GetNumberAsInt();
  const std::optional<std::uint32_t> coordinates = coordinates_of(reading, set, what);
  if (!coordinates) return no_texture;
  return add_gltf_texture(reading.document, reading.scene, reading.textures, index, extensions, encoding, channel,
                          *coordinates, reading.owner);
}

/// A textureInfo, as tinygltf has it for each use that it knows.
template <class Info>
std::uint32_t texture(Reading& reading, const Info& info, TextureEncoding encoding, std::uint32_t channel,
                      std::string_view what) {
  return texture(reading, info.index, info.texCoord, info.extensions, encoding, channel, what);
}

/// A textureInfo inside an extension.
std::uint32_t texture(Reading& reading, const tinygltf::Value& extension, const std::string& property,
                      TextureEncoding encoding, std::uint32_t channel) {
  const tinygltf::Value* info = gltf_member(extension, property);
  if (info == nullptr) return no_texture;
  const tinygltf::Value* index = gltf_member(*info, "index");
  if (index == nullptr || !index->IsInt())
    throw gltf_error(reading.document, reading.owner, fmt::format("{} names no texture", property));
  const tinygltf::Value* set = gltf_member(*info, "texCoord");
  tinygltf::ExtensionMap extensions;
  if (const tinygltf::Value* own = gltf_member(*info, "extensions"); own != nullptr && own->IsObject())
    extensions = own->Get<tinygltf::Value::Object>();
  return texture(reading, index->GetNumberAsInt(), set == nullptr ? 0 : set->GetNumberAsInt(), extensions, encoding,
                 channel, property);
}

void read_base(Reading& reading, const tinygltf::Material& source) {
  GpuMaterial& material = reading.result.material;
  const tinygltf::PbrMetallicRoughness& base = source.pbrMetallicRoughness;
  if (base.baseColorFactor.size() != 4)
    throw gltf_error(reading.document, reading.owner,
                     fmt::format("baseColorFactor has {} numbers", base.baseColorFactor.size()));
  for (int i = 0; i < 3; ++i)
    material.base_color[i] = number(reading, base.baseColorFactor[static_cast<std::size_t>(i)], 1, "baseColorFactor");
  material.base_color_texture =
      texture(reading, base.baseColorTexture, TextureEncoding::color, 0, "the base colour texture");
  material.metallic = number(reading, base.metallicFactor, 1, "metallicFactor");
  material.roughness = number(reading, base.roughnessFactor, 1, "roughnessFactor");
  constexpr std::string_view what = "the metallic-roughness texture";
  material.roughness_texture = texture(reading, base.metallicRoughnessTexture, TextureEncoding::data, 1, what);
  material.metallic_texture = texture(reading, base.metallicRoughnessTexture, TextureEncoding::data, 2, what);

  if (source.alphaMode == "OPAQUE" || source.alphaMode.empty()) return;
  if (source.alphaMode != "MASK" && source.alphaMode != "BLEND")
    throw gltf_error(reading.document, reading.owner,
                     fmt::format("the alpha mode '{}' is not OPAQUE, MASK or BLEND", source.alphaMode));
  reading.result.has_alpha = true;
  material.opacity = number(reading, base.baseColorFactor[3], 1, "baseColorFactor");
  if (material.base_color_texture != no_texture)
    material.alpha_texture =
        texture(reading, base.baseColorTexture, TextureEncoding::color, 3, "the base colour texture");
  if (source.alphaMode == "MASK") {
    material.alpha_cutoff = number(reading, source.alphaCutoff, largest, "alphaCutoff");
    if (material.alpha_cutoff == 0) {  // covers everything; a cutoff of 0 means none to the shader
      reading.result.has_alpha = false;
      material.opacity = 1;
      material.alpha_texture = no_texture;
    }
  }
}

void read_emission(Reading& reading, const tinygltf::Material& source) {
  GpuMaterial& material = reading.result.material;
  if (!source.emissiveFactor.empty()) material.emission = color(reading, source.emissiveFactor, "emissiveFactor");
  if (const tinygltf::Value* extension = gltf_extension(source.extensions, "KHR_materials_emissive_strength"))
    material.emission *= member(reading, *extension, "emissiveStrength", 1, 1e6);
  if (material.emission != glm::vec3(0))
    material.emission_texture =
        texture(reading, source.emissiveTexture, TextureEncoding::color, 0, "the emissive texture");
  // The factor alone would make a lamp of what only glows in places.
  if (source.emissiveTexture.index >= 0 && material.emission_texture == no_texture) material.emission = glm::vec3(0);
}

void read_dielectric(Reading& reading, const tinygltf::Material& source) {
  GpuMaterial& material = reading.result.material;
  if (const tinygltf::Value* extension = gltf_extension(source.extensions, "KHR_materials_ior")) {
    material.ior = member(reading, *extension, "ior", double{default_ior}, 1e3);
    // The extension's way to say that the index is infinite: then the specular colour alone is the reflectance.
    if (material.ior == 0) material.ior = infinite_ior;
    if (material.ior < 1) {
      gltf_warn(reading.document,
                fmt::format("{}: an index of refraction of {} counts as {}", reading.owner, material.ior, default_ior));
      material.ior = default_ior;
    }
  }
  if (const tinygltf::Value* extension = gltf_extension(source.extensions, "KHR_materials_specular")) {
    material.specular = member(reading, *extension, "specularFactor", 1, 1);
    material.specular_texture = texture(reading, *extension, "specularTexture", TextureEncoding::data, 3);
    if (const tinygltf::Value* factor = gltf_member(*extension, "specularColorFactor"))
      material.reflectance = color(reading, numbers(*factor), "specularColorFactor");
    material.reflectance_texture = texture(reading, *extension, "specularColorTexture", TextureEncoding::color, 0);
  }
  if (const tinygltf::Value* extension = gltf_extension(source.extensions, "KHR_materials_transmission")) {
    material.transmission = member(reading, *extension, "transmissionFactor", 0, 1);
    if (material.transmission > 0)
      material.transmission_texture = texture(reading, *extension, "transmissionTexture", TextureEncoding::data, 0);
  }
}

/// Nothing lights it: its colour is what it emits.
void make_unlit(GltfMaterial& result) {
  GpuMaterial unlit = diffuse_material(glm::vec3(0), result.material.base_color);
  unlit.emission_texture = result.material.base_color_texture;
  unlit.opacity = result.material.opacity;
  unlit.alpha_texture = result.material.alpha_texture;
  unlit.alpha_cutoff = result.material.alpha_cutoff;
  result.material = unlit;
  result.emits_color = true;
}

/// glTF 2.0, section 3.9: what holds where a material says nothing.
GpuMaterial default_material() {
  GpuMaterial material;
  material.model = MaterialModel::principled;
  material.base_color = glm::vec3(1);
  material.reflectance = glm::vec3(1);
  material.metallic = 1;
  material.roughness = 1;
  material.ior = default_ior;
  return material;
}

void read_material(Reading& reading, const tinygltf::Material& source) {
  reading.result.material = default_material();
  read_base(reading, source);
  if (gltf_extension(source.extensions, "KHR_materials_unlit") != nullptr) return make_unlit(reading.result);
  read_emission(reading, source);
  read_dielectric(reading, source);
  reading.result.material.normal_texture =
      texture(reading, source.normalTexture, TextureEncoding::data, 0, "the normal texture");
  reading.result.material.normal_scale = gltf_number(reading.document, source.normalTexture.scale, -unbounded,
                                                     unbounded, reading.owner, "the scale of the normal texture");
}

}  // namespace

std::vector<GltfMaterial> read_gltf_materials(GltfDocument& document, Scene& scene) {
  std::vector<GltfMaterial> materials;
  GltfTextures textures;
  for (std::size_t i = 0; i < document.model.materials.size(); ++i) {
    const tinygltf::Material& source = document.model.materials[i];
    GltfMaterial material;
    material.name = source.name.empty() ? fmt::format("material {}", i) : source.name;
    Reading reading{document, scene, textures, gltf_name("material", i, source.name), material};
    read_material(reading, source);
    materials.push_back(std::move(material));
  }
  materials.push_back({.material = default_material(), .name = "default"});
  return materials;
}

GpuMaterial colored_material(const GltfMaterial& source, glm::vec4 color, std::uint32_t attributes) {
  GpuMaterial material = source.material;
  material.attributes = attributes;
  (source.emits_color ? material.emission : material.base_color) *= glm::vec3(color);
  if (source.has_alpha) material.opacity *= color.a;
  if (material.alpha_cutoff > 0 && material.alpha_texture == no_texture &&
      (attributes & vertex_attribute::opacity) == 0) {
    material.opacity = material.opacity >= material.alpha_cutoff ? 1.0f : 0.0f;
    material.alpha_cutoff = 0;
  }
  return material;
}

}  // namespace tandem::pathtracer
