#include "pathtracer/load/gltf/schema.hpp"

#include <algorithm>
#include <array>
#include <charconv>

#include <fmt/format.h>

#include "base/error.hpp"
#include "pathtracer/load/gltf/members.hpp"

namespace tandem::pathtracer {
namespace {

constexpr std::array supported_extensions = {"KHR_lights_punctual",        "KHR_materials_emissive_strength",
                                             "KHR_materials_ior",          "KHR_materials_specular",
                                             "KHR_materials_transmission", "KHR_materials_unlit",
                                             "KHR_mesh_quantization",      "KHR_texture_transform"};

/// Of the extensions that an object has, those that `check` knows: called with each of them.
void extensions(GltfMembers& members, std::initializer_list<std::pair<const char*, GltfMembers::Check>> checks) {
  members.object("extensions", Need::optional, [&](GltfMembers& found) {
    for (const auto& [name, check] : checks) found.object(name, Need::optional, check);
  });
}

void texture_info(GltfMembers& info) {
  info.index("index", Need::required);
  info.index("texCoord");
  extensions(info, {{"KHR_texture_transform", [](GltfMembers& transform) {
                       transform.numbers("offset", 2);
                       transform.numbers("scale", 2);
                       transform.number("rotation");
                       transform.index("texCoord");
                     }}});
}

void material(GltfMembers& members) {
  members.object("pbrMetallicRoughness", Need::optional, [](GltfMembers& base) {
    base.numbers("baseColorFactor", 4);
    base.number("metallicFactor");
    base.number("roughnessFactor");
    base.object("baseColorTexture", Need::optional, texture_info);
    base.object("metallicRoughnessTexture", Need::optional, texture_info);
  });
  members.object("normalTexture", Need::optional, [](GltfMembers& info) {
    texture_info(info);
    info.number("scale");
  });
  members.object("occlusionTexture", Need::optional, [](GltfMembers& info) {
    texture_info(info);
    info.number("strength");
  });
  members.object("emissiveTexture", Need::optional, texture_info);
  members.numbers("emissiveFactor", 3);
  members.one_of("alphaMode", Need::optional, {"OPAQUE", "MASK", "BLEND"});
  members.number("alphaCutoff");
  members.flag("doubleSided");
  extensions(members, {{"KHR_materials_emissive_strength", [](GltfMembers& e) { e.number("emissiveStrength"); }},
                       {"KHR_materials_ior", [](GltfMembers& e) { e.number("ior"); }},
                       {"KHR_materials_specular",
                        [](GltfMembers& e) {
                          e.number("specularFactor");
                          e.numbers("specularColorFactor", 3);
                          e.object("specularTexture", Need::optional, texture_info);
                          e.object("specularColorTexture", Need::optional, texture_info);
                        }},
                       {"KHR_materials_transmission",
                        [](GltfMembers& e) {
                          e.number("transmissionFactor");
                          e.object("transmissionTexture", Need::optional, texture_info);
                        }},
                       {"KHR_materials_unlit", [](GltfMembers&) {}}});
}

void accessor(GltfMembers& members) {
  constexpr int byte = 5120, unsigned_byte = 5121, signed_short = 5122, unsigned_short = 5123, unsigned_int = 5125,
                float_type = 5126;
  members.index("bufferView");
  members.whole("byteOffset", Need::optional);
  members.one_of("componentType", Need::required,
                 {byte, unsigned_byte, signed_short, unsigned_short, unsigned_int, float_type});
  members.flag("normalized");
  members.whole("count", Need::required);
  members.one_of("type", Need::required, {"SCALAR", "VEC2", "VEC3", "VEC4", "MAT2", "MAT3", "MAT4"});
  members.numbers("min", 0);
  members.numbers("max", 0);
  members.object("sparse", Need::optional, [](GltfMembers& sparse) {
    sparse.whole("count", Need::required, 1);
    sparse.object("indices", Need::required, [](GltfMembers& indices) {
      indices.index("bufferView", Need::required);
      indices.whole("byteOffset", Need::optional);
      indices.one_of("componentType", Need::required, {unsigned_byte, unsigned_short, unsigned_int});
    });
    sparse.object("values", Need::required, [](GltfMembers& values) {
      values.index("bufferView", Need::required);
      values.whole("byteOffset", Need::optional);
    });
  });
}

void buffer_view(GltfMembers& members) {
  members.index("buffer", Need::required);
  members.whole("byteOffset", Need::optional);
  members.whole("byteLength", Need::required);
  // 0 is not allowed, but exporters write it and mean that there is none.
  members.whole("byteStride", Need::optional, 0, 252, 4);
  members.whole("target", Need::optional);
}

void image(GltfMembers& members) {
  members.text("uri");
  members.text("mimeType");
  members.index("bufferView");
  if (!members.has("uri") && !members.has("bufferView")) members.fail("has neither a uri nor a bufferView");
}

void sampler(GltfMembers& members) {
  constexpr int nearest = 9728, linear = 9729, repeat = 10497, clamp_to_edge = 33071, mirrored_repeat = 33648;
  members.one_of("magFilter", Need::optional, {nearest, linear});
  members.one_of("minFilter", Need::optional, {nearest, linear, 9984, 9985, 9986, 9987});
  for (const char* wrap : {"wrapS", "wrapT"})
    members.one_of(wrap, Need::optional, {clamp_to_edge, mirrored_repeat, repeat});
}

void mesh(GltfMembers& members) {
  members.numbers("weights", 0);
  members.objects("primitives", Need::required, [](GltfMembers& primitive) {
    primitive.index_map("attributes", Need::required);
    primitive.index("indices");
    primitive.index("material");
    primitive.whole("mode", Need::optional, 0, 6);
    primitive.index_maps("targets");
  });
}

void node(GltfMembers& members) {
  for (const char* member : {"mesh", "camera", "skin"}) members.index(member);
  members.indices("children");
  members.numbers("matrix", 16);
  members.numbers("translation", 3);
  members.numbers("rotation", 4);
  members.numbers("scale", 3);
  members.numbers("weights", 0);
  extensions(members, {{"KHR_lights_punctual", [](GltfMembers& e) { e.index("light", Need::required); }}});
}

void camera(GltfMembers& members) {
  members.one_of("type", Need::required, {"perspective", "orthographic"});
  const auto needed = [&](const char* type) { return members.says("type", type) ? Need::required : Need::optional; };
  members.object("perspective", needed("perspective"), [](GltfMembers& perspective) {
    perspective.number("yfov", Need::required);
    perspective.number("znear", Need::required);
    perspective.number("zfar");
    perspective.number("aspectRatio");
  });
  members.object("orthographic", needed("orthographic"), [](GltfMembers& orthographic) {
    for (const char* member : {"xmag", "ymag", "znear", "zfar"}) orthographic.number(member, Need::required);
  });
}

void light(GltfMembers& members) {
  members.one_of("type", Need::required, {"directional", "point", "spot"});
  members.numbers("color", 3);
  members.number("intensity");
  members.number("range");
  members.object("spot", members.says("type", "spot") ? Need::required : Need::optional, [](GltfMembers& spot) {
    spot.number("innerConeAngle");
    spot.number("outerConeAngle");
  });
}

/// Major and minor of "2.0", or nothing.
std::pair<int, int> version_of(GltfMembers& asset, const nlohmann::json& json, const std::string& member) {
  const std::string text = json["asset"][member].get<std::string>();
  int major = -1, minor = -1;
  const char* end = text.data() + text.size();
  const auto [dot, first] = std::from_chars(text.data(), end, major);
  if (first != std::errc() || dot == end || *dot != '.') asset.fail(fmt::format("{} '{}' is none", member, text));
  const auto [last, second] = std::from_chars(dot + 1, end, minor);
  if (second != std::errc() || last != end || major < 0 || minor < 0)
    asset.fail(fmt::format("{} '{}' is none", member, text));
  return {major, minor};
}

}  // namespace

bool is_gltf_extension_supported(const std::string& extension) {
  return std::ranges::find(supported_extensions, extension) != supported_extensions.end();
}

void check_gltf_header(const std::string& file, nlohmann::json& json) {
  GltfMembers root(file, "the file", "", json);
  if (!root.has("asset")) root.fail("has no asset, so it is no glTF file");
  GltfMembers asset(file, "asset", "", json["asset"]);
  asset.text("version", Need::required);
  asset.text("minVersion");
  const auto version = version_of(asset, json, "version");
  if (version.first != 2)
    asset.fail(fmt::format("version '{}' of glTF is not 2.0", json["asset"]["version"].get<std::string>()));
  if (asset.has("minVersion") && version_of(asset, json, "minVersion") > std::pair(2, 0))
    asset.fail(fmt::format("minVersion is '{}', so version 2.0 of glTF does not suffice to read the file",
                           json["asset"]["minVersion"].get<std::string>()));
  root.texts("extensionsUsed");
  root.texts("extensionsRequired");
  if (!root.has("extensionsRequired")) return;
  for (const nlohmann::json& extension : json["extensionsRequired"])
    if (!is_gltf_extension_supported(extension.get<std::string>()))
      throw Error(fmt::format("{}: the file requires the extension {}, which is not supported", file,
                              extension.get<std::string>()));
}

void check_gltf_members(const std::string& file, nlohmann::json& json) {
  GltfMembers root(file, "the file", "", json);
  root.index("scene");
  root.named_objects("buffers", "buffer", [](GltfMembers& members) {
    members.text("uri");
    members.whole("byteLength", Need::required, 1);
  });
  root.named_objects("bufferViews", "buffer view", buffer_view);
  root.named_objects("accessors", "accessor", accessor);
  root.named_objects("images", "image", image);
  root.named_objects("samplers", "sampler", sampler);
  root.named_objects("textures", "texture", [](GltfMembers& members) {
    members.index("source");
    members.index("sampler");
  });
  root.named_objects("materials", "material", material);
  root.named_objects("meshes", "mesh", mesh);
  root.named_objects("cameras", "camera", camera);
  root.named_objects("skins", "skin", [](GltfMembers& members) {
    members.index("inverseBindMatrices");
    members.index("skeleton");
    members.indices("joints", Need::required);
  });
  root.named_objects("nodes", "node", node);
  root.named_objects("scenes", "scene", [](GltfMembers& members) { members.indices("nodes"); });
  root.named_objects("animations", "animation", [](GltfMembers&) {});
  root.object("extensions", Need::optional, [&](GltfMembers& found) {
    found.object("KHR_lights_punctual", Need::optional,
                 [](GltfMembers& lights) { lights.named_objects("lights", "light", light); });
  });
}

}  // namespace tandem::pathtracer
