#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "pathtracer/scene/scene.hpp"

namespace tandem::pathtracer {

/// Where a line parallel to an axis meets a triangle.
struct LineHit {
  float coordinate;    ///< along the axis
  bool faces_upwards;  ///< the triangle's own normal points towards larger coordinates
};

/// What lines through the scene meet: for each axis a square grid of lines parallel to it, over the whole bounds. It
/// answers questions about the shape of a scene without an acceleration structure, in one pass over the triangles.
class SceneProbe {
 public:
  static constexpr std::size_t finest_resolution = 24;
  /// Triangles and lines that may meet: beyond, there are fewer lines, so that a scene of many large triangles takes no
  /// more memory and time than one of many small ones.
  static constexpr std::uint64_t usual_meetings = std::uint64_t{1} << 24;

  explicit SceneProbe(const Scene& scene, std::uint64_t most_meetings = usual_meetings);

  /// Lines along a side of the grid: 24, or 12, 6 or 3 where most triangles are as large as the scene.
  std::size_t resolution() const noexcept { return resolution_; }

  const Bounds& bounds() const noexcept { return bounds_; }
  /// The hits of one line by ascending coordinate. `u` and `v` count along the axes after `axis`, cyclically.
  const std::vector<LineHit>& line(int axis, std::size_t u, std::size_t v) const;
  /// A point of that line; its coordinate along `axis` is that of the centre.
  glm::vec3 line_point(int axis, std::size_t u, std::size_t v) const;
  /// The fraction of lines along `axis` that meet something within 5 % of the extent from that side.
  float closed_fraction(int axis, bool upper_side) const;

 private:
  struct Extent;
  Extent extent_of(const Scene& scene, const GpuTriangle& triangle, int axis) const;
  std::uint64_t meetings(const Scene& scene) const;
  void add(const Scene& scene, const GpuTriangle& triangle, int axis);

  Bounds bounds_;
  std::size_t resolution_ = finest_resolution;
  std::array<std::vector<std::vector<LineHit>>, 3> lines_;
};

/// A stretch of a line with nothing on it.
struct Gap {
  LineHit lower;
  LineHit upper;
  float length() const { return upper.coordinate - lower.coordinate; }
  /// Whether both ends look into it, as the walls of a room do.
  bool is_faced() const { return lower.faces_upwards && !upper.faces_upwards; }
};

/// The longest gap between two neighbouring hits of a line, among all or among those that are faced; nothing when there
/// is none.
std::optional<Gap> longest_gap(const std::vector<LineHit>& hits, bool only_faced);

}  // namespace tandem::pathtracer
