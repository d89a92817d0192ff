#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <glm/vec4.hpp>

#include "pathtracer/load/gltf/document.hpp"
#include "pathtracer/scene/scene.hpp"

namespace tandem::pathtracer {

/// A material of a document.
struct GltfMaterial {
  GpuMaterial material;
  std::string name;
  /// The sets of texture coordinates (TEXCOORD_n) that its textures use: GpuTexture::coordinates 0 and 1; -1: none.
  std::array<int, 2> coordinates = {-1, -1};
  bool emits_color = false;  ///< KHR_materials_unlit
  bool has_alpha = false;    ///< its alpha mode is not OPAQUE
};

/// Reads all materials, and their textures into the scene, and appends the one of primitives that have none.
std::vector<GltfMaterial> read_gltf_materials(GltfDocument& document, Scene& scene);

/// The material of a primitive whose vertices all have one colour, which multiplies its base colour. A cut-out that
/// covers everything or nothing is no cut-out any more. @param attributes what its vertices have of their own
GpuMaterial colored_material(const GltfMaterial& material, glm::vec4 color, std::uint32_t attributes = 0);

}  // namespace tandem::pathtracer
