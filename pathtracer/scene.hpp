#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "pathtracer/scene_buffers.hpp"

namespace tandem::pathtracer {

/// An axis-aligned box in world space.
struct Bounds {
  glm::vec3 minimum{0};
  glm::vec3 maximum{0};

  glm::vec3 centre() const { return 0.5f * (minimum + maximum); }
  glm::vec3 extent() const { return maximum - minimum; }
};

/// Opacities of 8 bits, 255 for 1, row by row from the top.
struct AlphaTexture {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::vector<std::uint8_t> texels;
};

/// Triangles and materials in world space, in the form in which the shader reads them. Units are those of the file.
struct Scene {
  std::string name;                  ///< file name without its folder
  std::vector<glm::vec3> positions;  ///< finite
  std::vector<glm::vec3> normals;    ///< one for each position, unit length; meaningful in smooth triangles only
  std::vector<glm::vec2> texture_coordinates;  ///< one for each position, v upwards; none where nothing has a texture
  std::vector<AlphaTexture> alpha_textures;
  std::vector<GpuTriangle> triangles;       ///< at least one, indices in range
  std::vector<GpuMaterial> materials;       ///< at least one
  std::vector<std::string> material_names;  ///< one for each material
  std::vector<std::string> warnings;        ///< what the file asked for and did not get, one sentence each
};

/// The box around all vertices that a triangle uses.
Bounds bounds(const Scene& scene);

/// Square units of the file; 0 for a degenerate triangle. Computed in double precision.
double triangle_area(const Scene& scene, const GpuTriangle& triangle);

/// Whether a ray may pass through points of it: it has an opacity below 1 or an alpha texture.
bool is_transparent(const GpuMaterial& material);
bool is_transparent(const Scene& scene, const GpuTriangle& triangle);

/// A material that reflects `albedo` and does nothing else.
GpuMaterial diffuse_material(glm::vec3 albedo, glm::vec3 emission = glm::vec3(0));

}  // namespace tandem::pathtracer
