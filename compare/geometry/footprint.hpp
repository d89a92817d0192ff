#pragma once

#include <cstdint>

#include <glm/vec3.hpp>

#include "pathtracer/scene/camera.hpp"

namespace tandem::compare {

/// What a pixel covers in the scene.
struct PixelFootprint {
  glm::dvec3 eye{0};
  double angle = 0;  ///< between neighbouring pixels, in radians; orthographic: 0
  double width = 0;  ///< orthographic: of a pixel, in units of the scene; else 0
};

/// @param height of the picture in pixels, above 0
PixelFootprint footprint_of(const pathtracer::Camera& camera, std::uint32_t height);

/// The width of a pixel at a point of the scene, in units of the scene. A path that bounces on its way there is at
/// least as long as the straight line, so a cone of the pixel's angle around it (Amanatides, Ray Tracing with Cones,
/// 1984) is at least as wide.
double pixel_width(const PixelFootprint& footprint, const glm::dvec3& point);

}  // namespace tandem::compare
