#pragma once

#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "pathtracer/load/gltf/document.hpp"

namespace tandem::pathtracer {

/// Moves the vectors of an attribute by those of the morph targets of a primitive, by their weights (glTF 2.0, section
/// 3.7.2.2). Throws Error where numbers of elements differ.
/// @param attribute "POSITION", "NORMAL" or "TANGENT"  @param owner the primitive
void apply_gltf_morphs(const GltfDocument& document, const tinygltf::Primitive& source,
                       const std::vector<double>& weights, const std::string& attribute, std::string_view owner,
                       std::vector<glm::vec3>& vectors);

}  // namespace tandem::pathtracer
