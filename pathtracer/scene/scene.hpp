#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "pathtracer/scene/buffers.hpp"
#include "pathtracer/scene/camera.hpp"
#include "pathtracer/scene/settings.hpp"

namespace tandem::pathtracer {

/// An axis-aligned box in world space.
struct Bounds {
  glm::vec3 minimum{0};
  glm::vec3 maximum{0};

  glm::vec3 centre() const { return 0.5f * (minimum + maximum); }
  glm::vec3 extent() const { return maximum - minimum; }
};

/// The texels of an image as the shader stores them (TEXEL_* of shaders/scene.glsl), rows from the top.
struct TextureImage {
  std::string name;  ///< of the file, for messages
  TexelFormat format = TexelFormat::unorm8;
  std::uint32_t width = 1;
  std::uint32_t height = 1;
  std::vector<std::byte> texels;  ///< whole; not padded to words
};

/// A use of an image, or a procedural pigment.
struct Texture {
  GpuTexture gpu;           ///< `first_word`, `format`, `width` and `height` of an image are set by DeviceScene
  std::uint32_t image = 0;  ///< index into Scene::images; TextureKind::image only
};

/// A light without extent: point, spot or directional.
struct PunctualLight {
  LightKind kind = LightKind::point;
  glm::vec3 position{0};
  glm::vec3 direction{0, 0, -1};  ///< in which it shines, any length but 0
  glm::vec3 radiance{0};          ///< intensity per steradian, or the irradiance of a directional light
  float inner_angle = 0;          ///< degrees from the direction, at which a spot light begins to fade
  float outer_angle = 45;         ///< at which it has faded, greater than the inner angle, at most 90
};

/// Radiance from all around.
struct Environment {
  std::uint32_t texture = no_texture;  ///< equirectangular, index into Scene::textures; none: constant
  glm::vec3 radiance{1};               ///< factor on the texture
  float rotation = 0;                  ///< degrees about the y axis, counter-clockwise seen from above
};

/// Triangles, spheres, lights and materials in world space, in the form in which the shader reads them. Units are those
/// of the file. Instances are resolved by the loaders (docs/decisions).
struct Scene {
  std::string name;                  ///< file name without its folder
  glm::dvec3 origin{0};              ///< where the file has the point that is 0,0,0 here (scene/local_origin.hpp)
  std::vector<glm::vec3> positions;  ///< finite
  std::vector<glm::vec3> normals;    ///< one for each position, unit length; meaningful in smooth triangles only
  std::vector<glm::vec2> texture_coordinates;   ///< one for each position, v upwards; none where nothing has a texture
  std::vector<GpuVertexAttributes> attributes;  ///< one for each position; none where no material uses them
  std::vector<GpuTriangle> triangles;           ///< indices in range; at least one, or a sphere
  std::vector<GpuSphere> spheres;
  std::vector<GpuMaterial> materials;       ///< at least one; texture and medium indices in range
  std::vector<std::string> material_names;  ///< one for each material
  std::vector<TextureImage> images;
  std::vector<Texture> textures;
  std::vector<PunctualLight> lights;  ///< beside emissive triangles and spheres, and the environment
  std::optional<Environment> environment;
  std::vector<GpuMedium> media;
  std::uint32_t medium = no_medium;   ///< around everything
  std::optional<Camera> camera;       ///< that the file gives
  SceneSettings settings;             ///< likewise
  std::vector<std::string> warnings;  ///< what the file asked for and did not get, one sentence each
};

/// The box around all spheres, wherever they move, and all vertices that a triangle uses.
Bounds bounds(const Scene& scene);

/// Square units of the file; 0 for a degenerate triangle. Computed in double precision.
double triangle_area(const Scene& scene, const GpuTriangle& triangle);

/// Whether a ray may pass through points of it: it has an opacity below 1, an alpha texture, or opacities of its
/// vertices.
bool is_transparent(const GpuMaterial& material);
bool is_transparent(const Scene& scene, const GpuTriangle& triangle);

/// Whether any of its members has a texture, its opacity included.
bool has_texture(const GpuMaterial& material);

/// A material that reflects `albedo` and does nothing else.
GpuMaterial diffuse_material(glm::vec3 albedo, glm::vec3 emission = glm::vec3(0));

/// Adds a texture that reads all of an image with repetition. Returns its index.
std::uint32_t add_texture(Scene& scene, TextureImage image);

}  // namespace tandem::pathtracer
