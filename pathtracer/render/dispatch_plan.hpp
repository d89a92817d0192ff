#pragma once

#include <cstdint>

#include <glm/vec2.hpp>

namespace tandem::pathtracer {

/// Pixels of one dispatch.
struct Tile {
  glm::uvec2 offset;
  glm::uvec2 size;
};

/// Cuts a picture into tiles, row by row from the top left, each as large as the moment allows.
class TileCursor {
 public:
  /// @param maximum_side of a tile; 0 for no bound
  TileCursor(glm::uvec2 resolution, std::uint32_t maximum_side);

  bool at_end() const noexcept { return row_ >= resolution_.y; }
  /// The next tile, of about `pixels` pixels, its sides multiples of the workgroup's where the picture does not end.
  Tile next(double pixels);

 private:
  glm::uvec2 resolution_;
  std::uint32_t maximum_side_;
  std::uint32_t row_ = 0;
  std::uint32_t column_ = 0;
  std::uint32_t row_height_ = 0;
};

/// Learns how fast a device renders, to give each submission about the same time.
class Pace {
 public:
  explicit Pace(double submission_seconds) : submission_seconds_(submission_seconds) {}

  /// Samples, over all pixels of a submission, that take about the time wanted.
  double budget() const noexcept;
  void measured(double samples, double seconds);

 private:
  double submission_seconds_;
  double samples_per_second_ = 0;  ///< 0: not known yet
};

}  // namespace tandem::pathtracer
