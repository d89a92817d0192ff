#include "compare/geometry/footprint.hpp"

#include <cmath>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

namespace tandem::compare {

PixelFootprint footprint_of(const pathtracer::Camera& camera, std::uint32_t height) {
  PixelFootprint footprint{.eye = glm::dvec3(camera.position)};
  switch (camera.kind) {
    case pathtracer::CameraKind::perspective:
      footprint.angle = 2 * std::tan(glm::radians(double{camera.vertical_fov}) / 2) / height;
      break;
    case pathtracer::CameraKind::orthographic:
      footprint.width = double{camera.height} / height;
      break;
    case pathtracer::CameraKind::equirectangular:
      footprint.angle = glm::radians(180.0) / height;
      break;
  }
  return footprint;
}

double pixel_width(const PixelFootprint& footprint, const glm::dvec3& point) {
  return footprint.width + footprint.angle * glm::distance(footprint.eye, point);
}

}  // namespace tandem::compare
