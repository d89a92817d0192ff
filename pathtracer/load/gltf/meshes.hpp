#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "pathtracer/load/gltf/document.hpp"
#include "pathtracer/load/gltf/materials.hpp"

namespace tandem::pathtracer {

/// Triangles of one material, in the space of their mesh.
struct GltfPrimitive {
  std::string name;  ///< for messages
  std::vector<glm::vec3> positions;
  std::vector<glm::vec3> normals;  ///< one for each position, of any length; or none
  /// Likewise, v upwards; of the sets that the material's textures use.
  std::array<std::vector<glm::vec2>, 2> texture_coordinates;
  std::vector<glm::vec4> tangents;  ///< likewise; w: the sign of the bitangent
  std::vector<glm::vec4> colors;    ///< likewise, where they vary; factors on the base colour and on the opacity
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< into the arrays above, all of them in range
  std::vector<std::uint32_t> joints;  ///< of a skin: the same number of them for each position, or none
  std::vector<float> weights;         ///< likewise
  std::size_t material = 0;           ///< index into the materials of the document
  glm::vec4 color{1};                 ///< that all vertices have
  std::uint32_t attributes = 0;       ///< GpuMaterial::attributes
};

/// Reads the triangles of a mesh. Points and lines are warnings. Throws Error for attributes that do
/// not fit each other.
/// @param weights of morph targets; empty: those of the mesh
std::vector<GltfPrimitive> read_gltf_mesh(GltfDocument& document, const std::vector<GltfMaterial>& materials, int mesh,
                                          const std::vector<double>& weights, std::string_view owner);

}  // namespace tandem::pathtracer
