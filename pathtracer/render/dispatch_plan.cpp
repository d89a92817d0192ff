#include "pathtracer/render/dispatch_plan.hpp"

#include <algorithm>

namespace tandem::pathtracer {
namespace {

constexpr std::uint32_t workgroup_side = 8;  // local_size of shaders/path_trace.comp

/// Small enough for the slowest device, large enough to occupy a fast one for a measurement.
constexpr double first_budget = 64 * 64;
/// An optimistic measurement (an empty part of the picture) does not make the next submission endless.
constexpr double largest_growth = 4;

/// `wanted` rounded to whole workgroups, at least one, at most `remaining`.
std::uint32_t side(double wanted, std::uint32_t remaining) {
  const double groups = std::max(1.0, wanted / workgroup_side);
  if (groups * workgroup_side >= double(remaining)) return remaining;
  return std::min(remaining, static_cast<std::uint32_t>(groups) * workgroup_side);
}

}  // namespace

TileCursor::TileCursor(glm::uvec2 resolution, std::uint32_t maximum_side)
    : resolution_(resolution), maximum_side_(maximum_side == 0 ? ~std::uint32_t{0} : maximum_side) {}

Tile TileCursor::next(double pixels) {
  if (column_ == 0) row_height_ = side(std::min(pixels / resolution_.x, double(maximum_side_)), resolution_.y - row_);
  const std::uint32_t width = side(std::min(pixels / row_height_, double(maximum_side_)), resolution_.x - column_);
  const Tile tile{{column_, row_}, {width, row_height_}};
  column_ += width;
  if (column_ == resolution_.x) {
    column_ = 0;
    row_ += row_height_;
  }
  return tile;
}

double Pace::budget() const noexcept {
  return samples_per_second_ == 0 ? first_budget : std::max(1.0, samples_per_second_ * submission_seconds_);
}

void Pace::measured(double samples, double seconds) {
  constexpr double shortest = 1e-6;  // below, a clock says little
  const double now = samples / std::max(seconds, shortest);
  samples_per_second_ = samples_per_second_ == 0 ? now : std::min(now, largest_growth * samples_per_second_);
}

}  // namespace tandem::pathtracer
