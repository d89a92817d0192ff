#pragma once

#include <glm/mat4x4.hpp>

#include "pathtracer/scene/scene.hpp"

namespace tandem::pathtracer {

/// Adds everything of `model` to the scene: triangles, materials, textures, media and lights; its camera, environment
/// and surrounding medium where the scene has none yet; its warnings. Names are kept, also where they repeat.
/// @param transform affine and invertible, from the coordinates of the model's file to those of the scene's: the
/// origins of both count, and that of the scene stays. Normals go by its inverse transpose; where it mirrors, triangles
/// are wound the other way, so that their outside stays outside. Radiances stay as they are. Throws Error when the
/// model has spheres and the transform is no similarity, or when a position is no float any more.
void append(Scene& scene, Scene model, const glm::dmat4& transform);

}  // namespace tandem::pathtracer
