#pragma once

#include <cstdint>

#include <glm/vec3.hpp>

#include "pathtracer/scene.hpp"

namespace tandem::pathtracer {

/// A pinhole at `position`, in the units of the scene.
struct Camera {
  glm::vec3 position{0, 0, 1};
  glm::vec3 target{0, 0, 0};  ///< appears in the centre of the picture
  glm::vec3 up{0, 1, 0};      ///< appears upwards; any length, not parallel to the view
  float vertical_fov = 40;    ///< degrees between the lower and the upper edge, in (0, 180)
};

/// Sets the four camera vectors. Throws Error for a camera that looks nowhere or a field of view out of range.
void set_camera(RenderConstants& constants, const Camera& camera, std::uint32_t width, std::uint32_t height);

/// A view of the whole scene, y upwards: through the open side of a room that has one, centred; from inside a closed
/// room; else a slightly raised three-quarter view from the front (+z).
/// @param aspect width / height of the picture
Camera automatic_camera(const Scene& scene, float aspect);

}  // namespace tandem::pathtracer
