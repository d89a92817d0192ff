#pragma once

#include "pathtracer/image/image.hpp"
#include "pathtracer/render/scene_on_device.hpp"

namespace tandem::view {

/// What the camera sees, lit by a lamp at the camera: one ray a pixel. Rays that leave the scene show the background.
/// Throws rhi::Error.
pathtracer::Image preview(pathtracer::SceneOnDevice& scene);

/// The light that a surface sends back to a lamp at the camera: its albedo times the cosine, and a little from all
/// around, so that surfaces seen edge on keep a colour.
/// @param normal of unit length  @param direction of the ray, of unit length
glm::vec3 headlight(const glm::vec3& albedo, const glm::vec3& normal, const glm::vec3& direction);

}  // namespace tandem::view
