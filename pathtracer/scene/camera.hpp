#pragma once

#include <cstdint>

#include <glm/vec3.hpp>

#include "pathtracer/scene/buffers.hpp"

namespace tandem::pathtracer {

struct Scene;

/// Where a picture is taken from, in the units of the scene.
struct Camera {
  CameraKind kind = CameraKind::perspective;
  glm::vec3 position{0, 0, 1};
  glm::vec3 target{0, 0, 0};  ///< appears in the centre of the picture
  glm::vec3 up{0, 1, 0};      ///< appears upwards; any length, not parallel to the view
  float vertical_fov = 40;    ///< perspective: degrees between the lower and the upper edge, in (0, 180)
  float height = 2;           ///< orthographic: of what it sees
  float lens_radius = 0;      ///< perspective: 0 is a pinhole
  float focus_distance = 0;   ///< along the view, to what is sharp; 0: that of the target
  glm::vec3 motion{0};        ///< of the position while the shutter is open; the view keeps its direction

  bool operator==(const Camera&) const = default;
};

/// Sets the members of a camera, and `shutter` to whether it moves. Throws Error for one that looks nowhere or a number
/// out of range.
void set_camera(RenderConstants& constants, const Camera& camera, std::uint32_t width, std::uint32_t height);

/// A view of the whole scene, y upwards: through the open side of a room that has one, centred; from inside a closed
/// room; else a slightly raised three-quarter view from the front (+z).
/// @param aspect width / height of the picture
Camera automatic_camera(const Scene& scene, float aspect);

}  // namespace tandem::pathtracer
