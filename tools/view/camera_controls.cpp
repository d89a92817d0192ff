#include "tools/view/camera_controls.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

namespace tandem::view {
namespace {

using pathtracer::Camera;

constexpr double pole_margin = std::numbers::pi / 180;

/// Rodrigues' formula. @param axis of unit length
glm::dvec3 rotated(const glm::dvec3& v, const glm::dvec3& axis, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return v * c + glm::cross(axis, v) * s + axis * (glm::dot(axis, v) * (1 - c));
}

/// The view of another direction, of the same length: yaw counter-clockwise about the up vector, then pitch upwards.
glm::dvec3 turned(const Camera& camera, double yaw, double pitch) {
  const glm::dvec3 up = glm::normalize(glm::dvec3(camera.up));
  const glm::dvec3 view = rotated(glm::dvec3(camera.target) - glm::dvec3(camera.position), up, yaw);
  const double from_up = std::acos(std::clamp(glm::dot(glm::normalize(view), up), -1.0, 1.0));
  // A camera that is nearer to the pole than a hand could bring it there may stay, but goes no nearer.
  const double least = std::min(pole_margin, from_up), most = std::max(std::numbers::pi - pole_margin, from_up);
  const double wanted = std::clamp(from_up - pitch, least, most);
  return rotated(view, glm::normalize(glm::cross(view, up)), from_up - wanted);
}

}  // namespace

ViewAxes view_axes(const Camera& camera) {
  ViewAxes axes{};
  axes.forward = glm::normalize(glm::dvec3(camera.target) - glm::dvec3(camera.position));
  axes.right = glm::normalize(glm::cross(axes.forward, glm::dvec3(camera.up)));
  axes.up = glm::cross(axes.right, axes.forward);
  return axes;
}

Camera orbit(const Camera& camera, glm::dvec2 angles) {
  Camera moved = camera;
  // To the right about the target is the view turning to the left, and a higher camera looks down.
  moved.position = glm::vec3(glm::dvec3(camera.target) - turned(camera, angles.x, -angles.y));
  return moved;
}

Camera look(const Camera& camera, glm::dvec2 angles) {
  Camera turned_camera = camera;
  turned_camera.target = glm::vec3(glm::dvec3(camera.position) + turned(camera, -angles.x, angles.y));
  return turned_camera;
}

Camera dolly(const Camera& camera, double factor) {
  Camera moved = camera;
  const glm::dvec3 target(camera.target);
  moved.position = glm::vec3(target + (glm::dvec3(camera.position) - target) * factor);
  moved.height = static_cast<float>(double{camera.height} * factor);
  // So near that floats no longer tell the two apart.
  return moved.position == moved.target || !(moved.height > 0) ? camera : moved;
}

Camera pan(const Camera& camera, glm::dvec2 drag) {
  const double distance = glm::distance(glm::dvec3(camera.position), glm::dvec3(camera.target));
  const double height = camera.kind == pathtracer::CameraKind::orthographic
                            ? double{camera.height}
                            : 2 * distance * std::tan(glm::radians(std::min(double{camera.vertical_fov}, 170.0)) / 2);
  return walk(camera, glm::dvec3(-drag.x * height, drag.y * height, 0));
}

Camera walk(const Camera& camera, glm::dvec3 steps) {
  const ViewAxes axes = view_axes(camera);
  const glm::dvec3 way = axes.right * steps.x + axes.up * steps.y + axes.forward * steps.z;
  Camera moved = camera;
  moved.position = glm::vec3(glm::dvec3(camera.position) + way);
  moved.target = glm::vec3(glm::dvec3(camera.target) + way);
  return moved.position == moved.target ? camera : moved;
}

}  // namespace tandem::view
