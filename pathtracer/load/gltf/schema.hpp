#pragma once

#include <string>

#include <nlohmann/json.hpp>

namespace tandem::pathtracer {

/// Checks what a glTF file says of itself, before anything else of it is looked at: its version, and that Tandem has
/// the extensions that it requires. Throws Error.
void check_gltf_header(const std::string& file, nlohmann::json& json);

/// Whether Tandem reads this extension.
bool is_gltf_extension_supported(const std::string& extension);

/// Checks the types, ranges and presence of all members that Tandem reads (glTF 2.0, chapter 5, and the specifications
/// of the extensions that it supports). Factors of materials, which gltf_number clamps, need only be numbers. Throws
/// Error, naming file, object and member. Whether indices refer to something is checked where they are followed.
void check_gltf_members(const std::string& file, nlohmann::json& json);

}  // namespace tandem::pathtracer
