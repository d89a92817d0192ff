#include "pathtracer/load/gltf/document.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <set>

#include <fmt/format.h>

namespace tandem::pathtracer {
namespace {

constexpr std::array supported_extensions = {"KHR_lights_punctual",        "KHR_materials_emissive_strength",
                                             "KHR_materials_ior",          "KHR_materials_specular",
                                             "KHR_materials_transmission", "KHR_materials_unlit",
                                             "KHR_mesh_quantization",      "KHR_texture_transform"};

/// Of objects in objects. tinygltf goes down into them by recursion.
constexpr int deepest_nesting = 256;

bool is_supported(const std::string& extension) {
  return std::ranges::find(supported_extensions, extension) != supported_extensions.end();
}

std::vector<unsigned char> read_bytes(const std::filesystem::path& path) {
  std::error_code status_error;
  if (!std::filesystem::is_regular_file(path, status_error))
    throw Error(fmt::format("cannot read '{}': there is no such file", path.string()));
  std::ifstream file(path, std::ios::binary);
  std::vector<unsigned char> bytes{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  if (!file) throw Error(fmt::format("cannot read '{}'", path.string()));
  if (bytes.empty()) throw Error(fmt::format("'{}' is empty", path.string()));
  if (bytes.size() > 0xffffffffu) throw Error(fmt::format("'{}' is larger than 4 GiB", path.string()));
  return bytes;
}

std::uint64_t word_at(std::span<const unsigned char> bytes, std::size_t offset) {
  return bytes[offset] | std::uint64_t{bytes[offset + 1]} << 8 | std::uint64_t{bytes[offset + 2]} << 16 |
         std::uint64_t{bytes[offset + 3]} << 24;
}

bool is_binary(std::span<const unsigned char> bytes) {
  return bytes.size() >= 4 && std::memcmp(bytes.data(), "glTF", 4) == 0;
}

/// The JSON of a binary file, after its chunks were found to be inside the file (glTF 2.0, section 4.4), which tinygltf
/// does not check to the last byte.
std::span<const unsigned char> binary_json(const std::string& path, std::span<const unsigned char> bytes) {
  const auto fail = [&](std::string_view sentence) { return Error(fmt::format("{}: {}", path, sentence)); };
  constexpr std::size_t header = 12, chunk_header = 8;
  if (bytes.size() < header + chunk_header) throw fail("the binary glTF file is cut off in its header");
  if (word_at(bytes, 4) != 2) throw fail(fmt::format("version {} of binary glTF is not 2", word_at(bytes, 4)));
  if (word_at(bytes, 8) > bytes.size())
    throw fail(fmt::format("the binary glTF file is cut off: {} bytes of {}", bytes.size(), word_at(bytes, 8)));
  const std::uint64_t json_size = word_at(bytes, header);
  const std::uint64_t json_end = header + chunk_header + json_size;
  if (json_end > bytes.size()) throw fail("the JSON of the binary glTF file is cut off");
  if (json_end + chunk_header <= bytes.size() &&
      json_end + chunk_header + word_at(bytes, static_cast<std::size_t>(json_end)) > bytes.size())
    throw fail("the data of the binary glTF file is cut off");
  return bytes.subspan(header + chunk_header, static_cast<std::size_t>(json_size));
}

bool nests_too_deep(std::span<const unsigned char> json) {
  int depth = 0;
  bool in_string = false;
  for (std::size_t i = 0; i < json.size(); ++i) {
    const unsigned char c = json[i];
    if (in_string) {
      if (c == '\\') ++i;
      if (c == '"') in_string = false;
    } else if (c == '"') {
      in_string = true;
    } else if (c == '{' || c == '[') {
      if (++depth > deepest_nesting) return true;
    } else if (c == '}' || c == ']') {
      --depth;
    }
  }
  return false;
}

/// Called for each image: keeps the file as it is. One in a buffer view is read later, after that has been checked.
bool keep_image(tinygltf::Image* image, int, std::string*, std::string*, int, int, const unsigned char* bytes, int size,
                void*) {
  if (image->bufferView < 0 && size > 0) image->image.assign(bytes, bytes + size);
  return true;
}

void parse(GltfDocument& document, const std::filesystem::path& path, std::span<const unsigned char> bytes) {
  tinygltf::TinyGLTF loader;
  loader.SetImageLoader(keep_image, nullptr);
  std::string error, warning;
  bool parsed = false;
  const auto size = static_cast<unsigned int>(bytes.size());
  const std::string folder = path.parent_path().string();
  try {
    parsed = is_binary(bytes)
                 ? loader.LoadBinaryFromMemory(&document.model, &error, &warning, bytes.data(), size, folder)
                 : loader.LoadASCIIFromString(&document.model, &error, &warning,
                                              reinterpret_cast<const char*>(bytes.data()), size, folder);
  } catch (const std::exception& exception) {
    error = exception.what();
  }
  // What it only complains about may be right: it calls some optional properties missing.
  if (parsed) return;
  error = error.substr(0, error.find('\n'));
  throw Error(fmt::format("{}: {}", document.path, error.empty() ? "not a glTF 2.0 file" : error));
}

void add_names(std::set<std::string>& names, const tinygltf::ExtensionMap& extensions) {
  for (const auto& [name, value] : extensions) names.insert(name);
}

void check_extensions(GltfDocument& document) {
  const tinygltf::Model& model = document.model;
  for (const std::string& extension : model.extensionsRequired)
    if (!is_supported(extension))
      throw Error(
          fmt::format("{}: the file requires the extension {}, which is not supported", document.path, extension));
  // Files do not always declare what they use.
  std::set<std::string> used(model.extensionsUsed.begin(), model.extensionsUsed.end());
  add_names(used, model.extensions);
  for (const tinygltf::Node& node : model.nodes) add_names(used, node.extensions);
  for (const tinygltf::Material& material : model.materials) add_names(used, material.extensions);
  for (const tinygltf::Texture& texture : model.textures) add_names(used, texture.extensions);
  for (const tinygltf::Mesh& mesh : model.meshes)
    for (const tinygltf::Primitive& primitive : mesh.primitives) add_names(used, primitive.extensions);
  for (const std::string& extension : used)
    if (!is_supported(extension)) gltf_warn(document, fmt::format("the extension {} has no effect", extension));
}

}  // namespace

GltfDocument read_gltf(const std::filesystem::path& path) {
  GltfDocument document;
  document.path = path.string();
  const std::vector<unsigned char> bytes = read_bytes(path);
  const std::span<const unsigned char> json =
      is_binary(bytes) ? binary_json(document.path, bytes) : std::span<const unsigned char>(bytes);
  if (nests_too_deep(json))
    throw Error(fmt::format("{}: objects are nested deeper than {} times", document.path, deepest_nesting));
  parse(document, path, bytes);
  if (!document.model.asset.version.starts_with("2."))
    throw Error(fmt::format("{}: version '{}' of glTF is not 2.0", document.path, document.model.asset.version));
  check_extensions(document);
  return document;
}

std::string gltf_name(std::string_view kind, std::size_t index, const std::string& name) {
  return name.empty() ? fmt::format("{} {}", kind, index) : fmt::format("{} {} ('{}')", kind, index, name);
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
  if (view.byteOffset > buffer.data.size() || view.byteLength > buffer.data.size() - view.byteOffset)
    throw gltf_error(document, name, fmt::format("ends beyond its buffer of {} bytes", buffer.data.size()));
  return std::span(buffer.data).subspan(view.byteOffset, view.byteLength);
}

}  // namespace tandem::pathtracer
