#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <tiny_gltf.h>

#include "base/error.hpp"
#include "pathtracer/load/access/load_options.hpp"
#include "pathtracer/load/gltf/members.hpp"

namespace tandem::pathtracer {

/// A parsed glTF file. The types of its members are checked (schema.hpp); its indices and buffers are as the file gives
/// them.
struct GltfDocument {
  std::string path;  ///< for messages
  LoadOptions options;
  tinygltf::Model model;  ///< without animations; an image with a URI is not read yet
  bool has_animations = false;
  std::vector<std::string> warnings;  ///< each sentence once
};

/// Throws Error for a file that is missing, is no glTF, has a member of a wrong type, lacks one of its buffers or
/// requires an extension that Tandem does not have.
GltfDocument read_gltf(const std::filesystem::path& path, const LoadOptions& options);

/// The bytes that a URI stands for: those of a data URI, or of a file beside the document. Throws Error, naming
/// `owner`, for what is neither, for a file that is not there and for one that the options do not allow (may_read).
std::vector<unsigned char> gltf_resource(const GltfDocument& document, const std::string& uri, std::string_view owner);

/// The file that a URI names. Throws Error likewise, but for one that is not there.
std::filesystem::path gltf_resource_path(const GltfDocument& document, const std::string& uri, std::string_view owner);

/// "vase.gltf: mesh 2 ('vase'): sentence".
Error gltf_error(const GltfDocument& document, std::string_view object, std::string_view sentence);

/// Appends a warning, unless the same sentence is one already.
void gltf_warn(GltfDocument& document, std::string_view sentence);

/// Object `index` of an array of the document. Throws Error, saying that `owner` refers to it, when there is none.
template <class T>
const T& gltf_at(const GltfDocument& document, const std::vector<T>& objects, int index, std::string_view kind,
                 std::string_view owner) {
  if (index < 0 || static_cast<std::size_t>(index) >= objects.size())
    throw gltf_error(document, owner,
                     "refers to " + std::string(kind) + " " + std::to_string(index) + ", but there are " +
                         std::to_string(objects.size()));
  return objects[static_cast<std::size_t>(index)];
}

/// A number that must be finite. Where it is outside of [low, high] it is clamped, with a warning.
float gltf_number(GltfDocument& document, double value, double low, double high, std::string_view owner,
                  std::string_view property);

/// A member of an extension of an object, or nullptr.
const tinygltf::Value* gltf_extension(const tinygltf::ExtensionMap& extensions, const std::string& extension);
const tinygltf::Value* gltf_member(const tinygltf::Value& object, const std::string& member);

/// The bytes of a buffer view. Throws Error when they are not inside its buffer.
std::span<const unsigned char> gltf_view(const GltfDocument& document, int buffer_view, std::string_view owner);

}  // namespace tandem::pathtracer
