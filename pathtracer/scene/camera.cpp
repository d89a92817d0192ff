#include "pathtracer/scene/camera.hpp"

#include <cmath>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "base/error.hpp"

namespace tandem::pathtracer {
namespace {

/// Orthonormal, in world space.
struct View {
  glm::dvec3 right, up, forward;
  double distance;  ///< of the target
};

View view_of(const Camera& camera) {
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
  return {.right = right, .up = glm::cross(right, forward), .forward = forward, .distance = distance};
}

/// Half of the height that the picture has in the units of RenderConstants::camera_up.
double half_height(const Camera& camera) {
  if (camera.kind == CameraKind::orthographic) {
    if (!(camera.height > 0) || !std::isfinite(camera.height))
      throw Error(fmt::format("camera: a height of {} is not finite and above 0", camera.height));
    return double{camera.height} / 2;
  }
  if (!(camera.vertical_fov > 0 && camera.vertical_fov < 180))
    throw Error(
        fmt::format("camera: a vertical field of view of {} degrees is not between 0 and 180", camera.vertical_fov));
  return std::tan(glm::radians(double{camera.vertical_fov}) / 2);
}

void check_lens(const Camera& camera) {
  if (!(camera.lens_radius >= 0) || !std::isfinite(camera.lens_radius))
    throw Error(fmt::format("camera: a lens radius of {} is not finite and at least 0", camera.lens_radius));
  if (!(camera.focus_distance >= 0) || !std::isfinite(camera.focus_distance))
    throw Error(fmt::format("camera: a focus distance of {} is not finite and at least 0", camera.focus_distance));
  if (camera.lens_radius > 0 && camera.kind != CameraKind::perspective)
    throw Error(fmt::format("camera: a lens radius of {} is for perspective cameras only", camera.lens_radius));
}

}  // namespace

void set_camera(RenderConstants& constants, const Camera& camera, std::uint32_t width, std::uint32_t height) {
  check_lens(camera);
  if (!std::isfinite(glm::length(glm::dvec3(camera.motion)))) throw Error("camera: the motion must be finite");
  const View view = view_of(camera);
  double vertical = 1;
  double horizontal = 1;
  if (camera.kind != CameraKind::equirectangular) {
    vertical = half_height(camera);
    horizontal = vertical * double(width) / double(height);
  }
  constants.camera_kind = camera.kind;
  constants.camera_position = camera.position;
  constants.camera_right = glm::vec3(view.right * horizontal);
  constants.camera_up = glm::vec3(view.up * vertical);
  constants.camera_forward = glm::vec3(view.forward);
  constants.camera_motion = camera.motion;
  constants.lens_radius = camera.lens_radius;
  constants.focus_distance = camera.focus_distance > 0 ? camera.focus_distance : static_cast<float>(view.distance);
  constants.shutter = camera.motion != glm::vec3(0) ? 1.0f : 0.0f;
}

}  // namespace tandem::pathtracer
