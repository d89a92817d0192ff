#include "pathtracer/camera.hpp"

#include <cmath>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "pathtracer/error.hpp"

namespace tandem::pathtracer {

void set_camera(RenderConstants& constants, const Camera& camera, std::uint32_t width, std::uint32_t height) {
  if (!(camera.vertical_fov > 0 && camera.vertical_fov < 180))
    throw Error(
        fmt::format("camera: a vertical field of view of {} degrees is not between 0 and 180", camera.vertical_fov));
  const glm::dvec3 view = glm::dvec3(camera.target) - glm::dvec3(camera.position);
  const double distance = glm::length(view);
  if (!(distance > 0) || !std::isfinite(distance)) throw Error("camera: position and target must be finite and differ");
  const glm::dvec3 forward = view / distance;
  const glm::dvec3 side = glm::cross(forward, glm::dvec3(camera.up));
  // Below this sine the direction of `side` is rounding error of float input.
  constexpr double smallest_sine = 1e-6;
  if (!(glm::length(side) > smallest_sine * glm::length(glm::dvec3(camera.up))))
    throw Error("camera: up must be finite, not zero and not parallel to the view");
  const glm::dvec3 right = glm::normalize(side);
  const glm::dvec3 up = glm::cross(right, forward);

  const double half_height = std::tan(glm::radians(double{camera.vertical_fov}) / 2);
  const double half_width = half_height * double(width) / double(height);
  constants.camera_position = camera.position;
  constants.camera_right = glm::vec3(right * half_width);
  constants.camera_up = glm::vec3(up * half_height);
  constants.camera_forward = glm::vec3(forward);
}

}  // namespace tandem::pathtracer
