#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "pathtracer/scene/camera.hpp"

/// How a hand moves a camera. Plain functions of the camera; all angles in radians, all lengths in units of the scene.
/// They compute in double precision and never make a camera that looks nowhere or along its own up vector.
namespace tandem::view {

/// Turns the camera about its target, which keeps its distance and its place in the picture.
/// @param angles to the right about the up vector, and upwards; upwards it stops one degree before the pole
pathtracer::Camera orbit(const pathtracer::Camera& camera, glm::dvec2 angles);

/// Turns the view about the camera, which stays where it is. @param angles as of orbit
pathtracer::Camera look(const pathtracer::Camera& camera, glm::dvec2 angles);

/// Moves the camera towards its target, or an orthographic one closer by showing less.
/// @param factor on the distance, positive; below 1 is closer
pathtracer::Camera dolly(const pathtracer::Camera& camera, double factor);

/// Moves the camera and its target parallel to the picture, so that what is at the target follows the hand.
/// @param drag of the hand to the right and downwards, in heights of the picture
pathtracer::Camera pan(const pathtracer::Camera& camera, glm::dvec2 drag);

/// Moves the camera and its target. @param steps to the right, upwards, and forwards
pathtracer::Camera walk(const pathtracer::Camera& camera, glm::dvec3 steps);

/// The view's axes in world space, of unit length and perpendicular to each other.
struct ViewAxes {
  glm::dvec3 right, up, forward;
};
ViewAxes view_axes(const pathtracer::Camera& camera);

}  // namespace tandem::view
