#include "rhi_cpu/trace/embree/ray_box.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tandem::cpu {
namespace {

/// Of the sum of magnitudes that a coordinate is computed from: the roundings of a matrix element, of its product and
/// of the sums, in single precision.
constexpr double relative_error = 4 * 0x1p-24;

/// A coordinate of the ray in object space, origin + t * direction, and how far off it may be.
struct Coordinate {
  double origin;
  double direction;
  double origin_error;
  double direction_error;
};

Coordinate in_object_space(const float (&row)[4], const kernel::Ray& ray) {
  Coordinate result{double{row[3]}, 0, std::abs(double{row[3]}), 0};
  for (int i = 0; i < 3; ++i) {
    const double of_origin = double{row[i]} * double{ray.origin[i]};
    const double of_direction = double{row[i]} * double{ray.direction[i]};
    result.origin += of_origin;
    result.direction += of_direction;
    result.origin_error += std::abs(of_origin);
    result.direction_error += std::abs(of_direction);
  }
  result.origin_error *= relative_error;
  result.direction_error *= relative_error;
  return result;
}

float rounded_down(double value) {
  const float rounded = static_cast<float>(value);
  return double{rounded} > value ? std::nextafter(rounded, -std::numeric_limits<float>::infinity()) : rounded;
}

}  // namespace

bool meets_box(const kernel::Ray& ray, const kernel::Instance& instance, const Box& box, float& t) {
  Coordinate coordinates[3];
  double distance = 0;
  double length = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Coordinate c = coordinates[axis] = in_object_space(instance.world_to_object[axis], ray);
    distance = std::max({distance, double{box.minimum[axis]} - c.origin, c.origin - double{box.maximum[axis]}});
    length = std::max(length, std::abs(c.direction));
  }
  if (!(length > 0)) return false;
  // About where the box begins: the error of the direction counts as often as the ray has gone along it.
  const double t_nearby = 2 * distance / length;

  double first = double{ray.t_min};
  double last = double{ray.t_max};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Coordinate& c = coordinates[axis];
    const double margin = c.origin_error + c.direction_error * t_nearby;
    const double lower = double{box.minimum[axis]} - margin - c.origin;
    const double upper = double{box.maximum[axis]} + margin - c.origin;
    if (c.direction == 0) {
      if (lower > 0 || upper < 0) return false;
      continue;
    }
    first = std::max(first, std::min(lower / c.direction, upper / c.direction));
    last = std::min(last, std::max(lower / c.direction, upper / c.direction));
  }
  if (!(first <= last) || first > double{std::numeric_limits<float>::max()}) return false;
  t = std::max(rounded_down(first), ray.t_min);
  return true;
}

}  // namespace tandem::cpu
