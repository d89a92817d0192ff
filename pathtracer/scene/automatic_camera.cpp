#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "pathtracer/scene/camera.hpp"
#include "pathtracer/scene/shape.hpp"

namespace tandem::pathtracer {
namespace {

constexpr float outside_fov = 40;  // degrees; the published camera of the Cornell box has 39.3
constexpr float inside_fov = 65;   // a room seen from within needs a wide angle
constexpr float margin = 1.04f;    // of empty picture around what is to be seen

/// One of the six sides of the bounds.
struct Side {
  int axis;
  bool upper;
  glm::vec3 outward() const {
    glm::vec3 direction(0);
    direction[axis] = upper ? 1.0f : -1.0f;
    return direction;
  }
};

constexpr std::array<Side, 6> sides = {Side{2, true},  Side{2, false}, Side{0, true},
                                       Side{0, false}, Side{1, true},  Side{1, false}};

/// Nearly all lines meet the wall: some pass through a gap between a window and its frame.
constexpr float wall_fraction = 0.9f;

glm::vec3 up_for(const Side& side) { return side.axis == 1 ? glm::vec3(0, 0, -1) : glm::vec3(0, 1, 0); }

/// Whether five sides are walls; then `open` is the sixth when it is none.
bool is_shell(const SceneProbe& probe, std::optional<Side>& open) {
  int walls = 0;
  for (const Side& side : sides) {
    if (probe.closed_fraction(side.axis, side.upper) >= wall_fraction)
      ++walls;
    else
      open = side;
  }
  return walls >= 5;
}

/// Whether most of the long gaps of all lines are faced by what bounds them: a room, and no solid.
bool is_hollow(const SceneProbe& probe) {
  std::size_t faced = 0, all = 0;
  for (int axis = 0; axis < 3; ++axis)
    for (std::size_t v = 0; v < probe.resolution(); ++v)
      for (std::size_t u = 0; u < probe.resolution(); ++u)
        if (const std::optional<Gap> gap = longest_gap(probe.line(axis, u, v), false)) {
          ++all;
          faced += gap->is_faced();
        }
  return 2 * faced > all;
}

bool has_light_inside(const Scene& scene, const Bounds& box) {
  const glm::vec3 inset = 0.01f * box.extent();
  for (const GpuTriangle& triangle : scene.triangles) {
    if (scene.materials[triangle.material & ~triangle_smooth].emission == glm::vec3(0)) continue;
    for (const std::uint32_t vertex : triangle.vertices) {
      const glm::vec3& p = scene.positions[vertex];
      bool inside = true;
      for (int axis = 0; axis < 3; ++axis)
        inside = inside && p[axis] > box.minimum[axis] + inset[axis] && p[axis] < box.maximum[axis] - inset[axis];
      if (inside) return true;
    }
  }
  return false;
}

/// Before the open side, so far off that the opening just fits into the picture.
Camera through_opening(const Bounds& box, const Side& side, float aspect) {
  const glm::vec3 up = up_for(side);
  const glm::vec3 across = glm::abs(glm::cross(up, side.outward()));
  const float slope = std::tan(glm::radians(outside_fov) / 2);
  const glm::vec3 half = 0.5f * box.extent();
  const float distance =
      margin * std::max(glm::dot(half, glm::abs(up)) / slope, glm::dot(half, across) / (slope * aspect));
  return {.position = box.centre() + side.outward() * (half[side.axis] + distance),
          .target = box.centre(),
          .up = up,
          .vertical_fov = outside_fov};
}

/// With the back to one wall, at the end of a long free horizontal line not far from the middle of the room.
Camera inside_room(const SceneProbe& probe, bool hollow) {
  const glm::vec3 centre = probe.bounds().centre();
  Camera camera{.position = centre, .target = centre, .up = {0, 1, 0}, .vertical_fov = inside_fov};
  float best = 0;
  for (const int axis : {2, 0})
    for (std::size_t v = 0; v < probe.resolution(); ++v)
      for (std::size_t u = 0; u < probe.resolution(); ++u) {
        const std::optional<Gap> gap = longest_gap(probe.line(axis, u, v), hollow);
        if (!gap) continue;
        const glm::vec3 point = probe.line_point(axis, u, v);
        // 0 in the middle, 1 at the walls, where a view is half as good.
        const glm::vec3 offset = glm::abs(point - centre) / (0.5f * probe.bounds().extent());
        const float score = gap->length() * (1 - 0.5f * std::max({offset.x, offset.y, offset.z}));
        if (score <= best) continue;
        best = score;
        camera.position = point;
        camera.position[axis] = gap->upper.coordinate - 0.02f * gap->length();
      }
  if (glm::distance(camera.position, camera.target) < 1e-3f * glm::length(probe.bounds().extent()))
    camera.target = camera.position + glm::vec3(0, 0, -1);
  return camera;
}

/// From the front, a little from the right and from above, so near that all vertices and spheres just fit into the
/// picture.
Camera three_quarter(const Scene& scene, const Bounds& box, float aspect) {
  const glm::vec3 forward = -glm::normalize(glm::vec3(0.5f, 0.4f, 1));
  const glm::vec3 right = glm::normalize(glm::cross(forward, glm::vec3(0, 1, 0)));
  const glm::vec3 up = glm::cross(right, forward);
  const float slope = std::tan(glm::radians(outside_fov) / 2);
  float distance = 0;
  // How far off a ball has to be to touch no side of the field of view; a vertex is one without radius.
  const auto fit = [&](const glm::vec3& position, float radius) {
    const glm::vec3 p = position - box.centre();
    const float depth = glm::dot(p, forward);
    const auto fit_between = [&](float across, float tangent) {
      const float room = margin * (std::abs(across) + radius * std::sqrt(1 + tangent * tangent));
      distance = std::max(distance, room / tangent - depth);
    };
    fit_between(glm::dot(p, right), slope * aspect);
    fit_between(glm::dot(p, up), slope);
  };
  for (const GpuTriangle& triangle : scene.triangles)
    for (const std::uint32_t vertex : triangle.vertices) fit(scene.positions[vertex], 0);
  for (const GpuSphere& sphere : scene.spheres)
    for (const glm::vec3& centre : {sphere.centre, sphere.centre + sphere.motion}) fit(centre, sphere.radius);
  if (!(distance > 0)) distance = 1;  // all vertices are in one point
  return {.position = box.centre() - forward * distance,
          .target = box.centre(),
          .up = {0, 1, 0},
          .vertical_fov = outside_fov};
}

}  // namespace

Camera automatic_camera(const Scene& scene, float aspect) {
  const SceneProbe probe(scene);
  std::optional<Side> open;
  if (is_shell(probe, open)) {
    if (open) return through_opening(probe.bounds(), *open, aspect);
    const bool hollow = is_hollow(probe);
    if (hollow || has_light_inside(scene, probe.bounds())) return inside_room(probe, hollow);
  }
  return three_quarter(scene, probe.bounds(), aspect);
}

}  // namespace tandem::pathtracer
