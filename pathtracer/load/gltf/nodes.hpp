#pragma once

#include <string>
#include <vector>

#include <glm/mat4x4.hpp>

#include "pathtracer/load/gltf/document.hpp"
#include "pathtracer/scene/camera.hpp"
#include "pathtracer/scene/scene.hpp"

namespace tandem::pathtracer {

/// A node of the default scene.
struct GltfNode {
  const tinygltf::Node* source;
  std::string name;       ///< for messages
  glm::dmat4 transform;   ///< to world space
  std::size_t index = 0;  ///< among the nodes of the document
};

/// All nodes of the default scene, parents before children. A file without scenes shows all its nodes. Throws Error for
/// a node that has two parents or is its own ancestor, and for a transform that is none.
std::vector<GltfNode> place_gltf_nodes(const GltfDocument& document);

/// Whether the node, or one above it, is scaled to nothing, as exporters do with what is not to be seen (glTF 2.0,
/// section 3.5.3).
bool is_hidden(const GltfNode& node);

/// The camera of a node, in world space. Throws Error for one that sees nothing.
Camera read_gltf_camera(const GltfDocument& document, const GltfNode& node);

/// The light `index` of KHR_lights_punctual at a node. Candela and lux count as radiometric units with factor 1, or
/// 1/683 in a file that Blender has written. Throws Error also where the transform of the node squashes the direction
/// of the light to nothing.
PunctualLight read_gltf_light(GltfDocument& document, int index, const GltfNode& node);

}  // namespace tandem::pathtracer
