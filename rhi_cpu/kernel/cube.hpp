#pragma once

#include <array>

#include "rhi_cpu/kernel/math.hpp"
#include "rhi_cpu/kernel/types.hpp"

/// Faces of a cube: Vulkan's "Cube Map Face Selection and Transformations", and what lies beyond the edge of a face.
namespace tandem::kernel {

/// Which coordinates of a direction, with which signs, are s and t on a face.
struct FaceAxes {
  int s_axis, s_sign;
  int t_axis, t_sign;
};

/// +x, -x, +y, -y, +z, -z.
inline constexpr FaceAxes faces[6] = {{2, -1, 1, -1}, {2, 1, 1, -1}, {0, 1, 2, 1},
                                      {0, 1, 2, -1},  {0, 1, 1, -1}, {0, -1, 1, -1}};

constexpr int major_axis(int face) { return face / 2; }
constexpr int major_sign(int face) { return face % 2 == 0 ? 1 : -1; }

/// The face that a direction meets; on an edge z wins over y, and y over x.
inline int face_of(const vec3& direction) {
  const vec3 size = kernel::abs(direction);
  const int axis = size.z >= size.x && size.z >= size.y ? 2 : size.y >= size.x ? 1 : 0;
  return 2 * axis + (direction[axis] < 0.0f ? 1 : 0);
}

/// Where on its face, between 0 and 1.
inline vec2 place_on_face(int face, const vec3& direction) {
  const FaceAxes& axes = faces[face];
  const float major = std::fabs(direction[major_axis(face)]);
  const vec2 place(static_cast<float>(axes.s_sign) * direction[axes.s_axis],
                   static_cast<float>(axes.t_sign) * direction[axes.t_axis]);
  return 0.5f * (place / major) + 0.5f;
}

/// How that changes when the direction changes by `change`: "Cube Map Derivative Transformation".
inline vec2 change_on_face(int face, const vec3& direction, const vec3& change) {
  const FaceAxes& axes = faces[face];
  const auto s_sign = static_cast<float>(axes.s_sign), t_sign = static_cast<float>(axes.t_sign);
  const int axis = major_axis(face);
  const float major = std::fabs(direction[axis]);
  const float major_change = static_cast<float>(major_sign(face)) * change[axis];
  const vec2 place(s_sign * direction[axes.s_axis], t_sign * direction[axes.t_axis]);
  const vec2 place_change(s_sign * change[axes.s_axis], t_sign * change[axes.t_axis]);
  return 0.5f * (major * place_change - place * major_change) / (major * major);
}

/// The texel (x, y, face) that lies at (x, y) of a face, of which one may be -1 or `size`: then it is the one on the
/// other side of that edge.
inline ivec3 texel_of_cube(int face, int x, int y, int size) {
  const bool beyond_x = x < 0 || x >= size;
  if (!beyond_x && y >= 0 && y < size) return {x, y, face};
  // Centres of texels, in halves of a texel from the middle of the cube, whose faces are `size` away from it. One step
  // beyond an edge is one step down the other face.
  const FaceAxes& axes = faces[face];
  ivec3 centre(0);
  centre[major_axis(face)] = major_sign(face) * (size - 1);
  centre[axes.s_axis] = axes.s_sign * (2 * x + 1 - size);
  centre[axes.t_axis] = axes.t_sign * (2 * y + 1 - size);
  const int axis = beyond_x ? axes.s_axis : axes.t_axis;
  const int other = 2 * axis + (centre[axis] < 0 ? 1 : 0);
  const FaceAxes& other_axes = faces[other];
  return {(other_axes.s_sign * centre[other_axes.s_axis] + size - 1) / 2,
          (other_axes.t_sign * centre[other_axes.t_axis] + size - 1) / 2, other};
}

/// The values of the texels (x, y), (x + 1, y), (x, y + 1) and (x + 1, y + 1) of a face, x and y from -1 to size - 1.
/// Where three faces meet there are three texels; the fourth value is their mean.
/// @param read the value of the texel (x, y, face)
template <typename Read>
inline auto square_of_cube(int face, int x, int y, int size, const Read& read) {
  using Value = decltype(read(ivec3(0)));
  std::array<Value, 4> values = {};
  int corner = -1;
  Value sum(0);
  for (int i = 0; i < 4; ++i) {
    const int at_x = x + i % 2, at_y = y + i / 2;
    if ((at_x < 0 || at_x >= size) && (at_y < 0 || at_y >= size)) {
      corner = i;
      continue;
    }
    values[static_cast<std::size_t>(i)] = read(texel_of_cube(face, at_x, at_y, size));
    sum = sum + values[static_cast<std::size_t>(i)];
  }
  if (corner >= 0) values[static_cast<std::size_t>(corner)] = sum / static_cast<component_t<Value>>(3);
  return values;
}

}  // namespace tandem::kernel
