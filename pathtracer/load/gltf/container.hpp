#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace tandem::pathtracer {

/// A glTF file of either form, taken apart.
struct GltfContainer {
  nlohmann::json json;
  std::vector<unsigned char> data;  ///< the binary chunk of a .glb file, padding included; empty where it has none
};

/// Reads a .gltf or .glb file (glTF 2.0, section 4.4), told apart by its first bytes. Throws Error for a file that is
/// missing, empty, cut off, larger than 4 GiB, or holds no JSON.
GltfContainer read_gltf_container(const std::filesystem::path& path);

/// The bytes of a file. Throws Error likewise, and for what is no plain file.
std::vector<unsigned char> read_gltf_bytes(const std::filesystem::path& path);

}  // namespace tandem::pathtracer
