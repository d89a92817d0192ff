#include "pathtracer/load/gltf/document.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "pathtracer/load/access/file_access.hpp"
#include "pathtracer/load/gltf/container.hpp"
#include "pathtracer/load/gltf/schema.hpp"
#include "pathtracer/load/gltf/uri.hpp"

namespace tandem::pathtracer {
namespace {

/// What tinygltf does not get to see: it reads files by itself, and takes indices without a buffer view for an error.
struct Withheld {
  nlohmann::json buffers, images;
  std::vector<std::vector<int>> indices;  ///< of each primitive of each mesh, -1: none
};

nlohmann::json taken(nlohmann::json& json, const char* member) {
  nlohmann::json result = json.value(member, nlohmann::json::array());
  json.erase(member);
  return result;
}

Withheld withhold(nlohmann::json& json) {
  Withheld withheld{.buffers = taken(json, "buffers"), .images = taken(json, "images"), .indices = {}};
  if (!json.contains("meshes")) return withheld;
  for (nlohmann::json& mesh : json["meshes"]) {
    withheld.indices.emplace_back();
    for (nlohmann::json& primitive : mesh["primitives"]) {
      withheld.indices.back().push_back(primitive.value("indices", -1));
      primitive.erase("indices");
    }
  }
  return withheld;
}

void parse(GltfDocument& document, const nlohmann::json& json) {
  tinygltf::TinyGLTF loader;
  std::string error, warning;
  bool parsed = false;
  const std::string text = json.dump();
  try {
    parsed = loader.LoadASCIIFromString(&document.model, &error, &warning, text.data(),
                                        static_cast<unsigned int>(text.size()), "");
  } catch (const std::exception&) {
    parsed = false;
  }
  // What it only complains about may be right: it calls some optional properties missing.
  if (parsed) return;
  error = error.substr(0, error.find('\n'));
  throw Error(fmt::format("{}: {}", document.path, error.empty() ? "not a glTF 2.0 file" : error));
}

void restore(GltfDocument& document, const Withheld& withheld) {
  tinygltf::Model& model = document.model;
  for (std::size_t i = 0; i < model.meshes.size() && i < withheld.indices.size(); ++i)
    for (std::size_t k = 0; k < model.meshes[i].primitives.size() && k < withheld.indices[i].size(); ++k)
      model.meshes[i].primitives[k].indices = withheld.indices[i][k];
  for (const nlohmann::json& image : withheld.images) {
    model.images.emplace_back();
    model.images.back().name = image.value("name", "");
    model.images.back().uri = image.value("uri", "");
    model.images.back().bufferView = image.value("bufferView", -1);
  }
}

/// The first bytes of a buffer, as many as it says; what follows them is padding (glTF 2.0, section 4.4.3.3). None for
/// a buffer without data, as that of EXT_meshopt_compression for readers without the extension.
void load_buffers(GltfDocument& document, const nlohmann::json& buffers, std::vector<unsigned char>&& data) {
  for (std::size_t i = 0; i < buffers.size(); ++i) {
    tinygltf::Buffer& buffer = document.model.buffers.emplace_back();
    buffer.name = buffers[i].value("name", "");
    const std::string name = gltf_name("buffer", i, buffer.name);
    const auto size = buffers[i]["byteLength"].get<std::uint64_t>();
    if (buffers[i].contains("uri")) {
      buffer.data = gltf_resource(document, buffers[i]["uri"].get<std::string>(), name);
    } else if (i == 0 && !data.empty()) {
      buffer.data = std::move(data);
    } else {
      continue;
    }
    if (buffer.data.size() < size)
      throw gltf_error(document, name,
                       fmt::format("has {} bytes and not the {} that it promises", buffer.data.size(), size));
    buffer.data.resize(static_cast<std::size_t>(size));
  }
}

void add_names(std::set<std::string>& names, const tinygltf::ExtensionMap& extensions) {
  for (const auto& [name, value] : extensions) names.insert(name);
}

void check_extensions(GltfDocument& document) {
  const tinygltf::Model& model = document.model;
  // Files do not always declare what they use.
  std::set<std::string> used(model.extensionsUsed.begin(), model.extensionsUsed.end());
  add_names(used, model.extensions);
  for (const tinygltf::Node& node : model.nodes) add_names(used, node.extensions);
  for (const tinygltf::Material& material : model.materials) add_names(used, material.extensions);
  for (const tinygltf::Texture& texture : model.textures) add_names(used, texture.extensions);
  for (const tinygltf::Mesh& mesh : model.meshes)
    for (const tinygltf::Primitive& primitive : mesh.primitives) add_names(used, primitive.extensions);
  for (const std::string& extension : used)
    if (!is_gltf_extension_supported(extension))
      gltf_warn(document, fmt::format("the extension {} has no effect", extension));
}

}  // namespace

GltfDocument read_gltf(const std::filesystem::path& path, const LoadOptions& options) {
  GltfDocument document;
  document.path = path.string();
  document.options = options_within(path, options);
  GltfContainer container = read_gltf_container(path);
  check_gltf_header(document.path, container.json);
  check_gltf_members(document.path, container.json);
  document.has_animations = !taken(container.json, "animations").empty();
  const Withheld withheld = withhold(container.json);
  parse(document, container.json);
  restore(document, withheld);
  load_buffers(document, withheld.buffers, std::move(container.data));
  check_extensions(document);
  return document;
}

std::vector<unsigned char> gltf_resource(const GltfDocument& document, const std::string& uri, std::string_view owner) {
  try {
    if (auto bytes = data_uri_bytes(uri)) return std::move(*bytes);
  } catch (const Error& error) {
    throw gltf_error(document, owner, error.what());
  }
  const std::filesystem::path path = gltf_resource_path(document, uri, owner);
  try {
    return read_gltf_bytes(path);
  } catch (const Error& error) {
    throw gltf_error(document, owner, error.what());
  }
}

std::filesystem::path gltf_resource_path(const GltfDocument& document, const std::string& uri, std::string_view owner) {
  if (const std::string_view scheme = uri_scheme(uri); !scheme.empty())
    throw gltf_error(document, owner, fmt::format("files by {} are not fetched", scheme));
  const std::string name = percent_decoded(uri);
  if (name.empty() || name.find('\0') != std::string::npos) throw gltf_error(document, owner, "its uri names no file");
  const std::filesystem::path path = std::filesystem::path(document.path).parent_path() / name;
  if (!may_read(path, document.options)) throw gltf_error(document, owner, outside_sentence(name));
  return path;
}

Error gltf_error(const GltfDocument& document, std::string_view object, std::string_view sentence) {
  return Error(fmt::format("{}: {}: {}", document.path, object, sentence));
}

void gltf_warn(GltfDocument& document, std::string_view sentence) {
  const std::string warning = fmt::format("{}: {}", document.path, sentence);
  if (std::ranges::find(document.warnings, warning) == document.warnings.end()) document.warnings.push_back(warning);
}

float gltf_number(GltfDocument& document, double value, double low, double high, std::string_view owner,
                  std::string_view property) {
  if (!std::isfinite(static_cast<float>(value)))
    throw gltf_error(document, owner, fmt::format("{} is not a finite number", property));
  if (value >= low && value <= high) return static_cast<float>(value);
  const double clamped = std::clamp(value, low, high);
  gltf_warn(document,
            fmt::format("{}: {} of {:g} is out of range and counts as {:g}", owner, property, value, clamped));
  return static_cast<float>(clamped);
}

const tinygltf::Value* gltf_extension(const tinygltf::ExtensionMap& extensions, const std::string& extension) {
  const auto entry = extensions.find(extension);
  return entry == extensions.end() || !entry->second.IsObject() ? nullptr : &entry->second;
}

const tinygltf::Value* gltf_member(const tinygltf::Value& object, const std::string& member) {
  return object.Has(member) ? &object.Get(member) : nullptr;
}

std::span<const unsigned char> gltf_view(const GltfDocument& document, int buffer_view, std::string_view owner) {
  const tinygltf::BufferView& view = gltf_at(document, document.model.bufferViews, buffer_view, "buffer view", owner);
  const std::string name = gltf_name("buffer view", static_cast<std::size_t>(buffer_view), view.name);
  const tinygltf::Buffer& buffer = gltf_at(document, document.model.buffers, view.buffer, "buffer", name);
  if (buffer.data.empty()) throw gltf_error(document, name, fmt::format("buffer {} has no data", view.buffer));
  if (view.byteOffset > buffer.data.size() || view.byteLength > buffer.data.size() - view.byteOffset)
    throw gltf_error(document, name, fmt::format("ends beyond its buffer of {} bytes", buffer.data.size()));
  return std::span(buffer.data).subspan(view.byteOffset, view.byteLength);
}

}  // namespace tandem::pathtracer
