#pragma once

#include <vector>

#include <glm/mat4x4.hpp>

#include "pathtracer/load/gltf/meshes.hpp"
#include "pathtracer/load/gltf/nodes.hpp"

namespace tandem::pathtracer {

/// The matrices of the joints of a skin (glTF 2.0, section 3.7.3.3), in the pose in which the nodes are stored: from
/// the space of a mesh to world space. Nothing, with a warning, where a joint is not in the scene. Throws Error for a
/// skin that is not there or whose inverse bind matrices do not fit its joints.
/// @param nodes all of the scene  @param owner what refers to the skin
std::vector<glm::dmat4> gltf_joint_matrices(GltfDocument& document, const std::vector<GltfNode>& nodes, int skin,
                                            std::string_view owner);

/// The transform of each vertex of a primitive to world space: the mean of those of its joints by their weights. Throws
/// Error for a joint that is not there.
std::vector<glm::dmat4> gltf_vertex_transforms(const GltfDocument& document, const GltfPrimitive& primitive,
                                               const std::vector<glm::dmat4>& joints);

}  // namespace tandem::pathtracer
