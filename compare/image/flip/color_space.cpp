#include "compare/image/flip/color_space.hpp"

#include <cmath>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

namespace tandem::compare {
namespace {

/// CIE XYZ of the chromaticity (x, y) at Y = 1.
glm::dvec3 xyz_of_chromaticity(double x, double y) { return {x / y, 1.0, (1.0 - x - y) / y}; }

/// D65 as IEC 61966-2-1 has it.
glm::dvec3 white() { return xyz_of_chromaticity(0.3127, 0.3290); }

/// Linear RGB with the primaries of IEC 61966-2-1 (those of ITU-R BT.709) to CIE XYZ: each primary as bright as it has
/// to be for their sum to be white.
const glm::dmat3& xyz_of_rgb() {
  static const glm::dmat3 matrix = [] {
    const glm::dmat3 primaries(xyz_of_chromaticity(0.64, 0.33), xyz_of_chromaticity(0.30, 0.60),
                               xyz_of_chromaticity(0.15, 0.06));
    const glm::dvec3 brightness = glm::inverse(primaries) * white();
    return glm::dmat3(primaries[0] * brightness.x, primaries[1] * brightness.y, primaries[2] * brightness.z);
  }();
  return matrix;
}

/// Linear RGB to X / Xn, Y / Yn, Z / Zn.
const glm::dmat3& relative_xyz_of_rgb() {
  static const glm::dmat3 matrix = [] {
    const glm::dmat3& xyz = xyz_of_rgb();
    return glm::dmat3(xyz[0] / white(), xyz[1] / white(), xyz[2] / white());
  }();
  return matrix;
}

const glm::dmat3& rgb_of_relative_xyz() {
  static const glm::dmat3 matrix = glm::inverse(relative_xyz_of_rgb());
  return matrix;
}

/// The cube root with a straight line for dark colours.
double lab_curve(double value) {
  constexpr double delta = 6.0 / 29.0;
  return value > delta * delta * delta ? std::cbrt(value) : value / (3.0 * delta * delta) + 4.0 / 29.0;
}

/// L*, a* and b* of the three values, which CIELAB takes of a curve and YCxCz as they are.
glm::dvec3 opponents(const glm::dvec3& xyz) {
  return {116.0 * xyz.y - 16.0, 500.0 * (xyz.x - xyz.y), 200.0 * (xyz.y - xyz.z)};
}

}  // namespace

glm::dvec3 ycxcz_of_linear_rgb(const glm::dvec3& rgb) { return opponents(relative_xyz_of_rgb() * rgb); }

glm::dvec3 linear_rgb_of_ycxcz(const glm::dvec3& ycxcz) {
  const double y = (ycxcz.x + 16.0) / 116.0;
  return rgb_of_relative_xyz() * glm::dvec3(y + ycxcz.y / 500.0, y, y - ycxcz.z / 200.0);
}

glm::dvec3 lab_of_linear_rgb(const glm::dvec3& rgb) {
  const glm::dvec3 xyz = relative_xyz_of_rgb() * rgb;
  return opponents({lab_curve(xyz.x), lab_curve(xyz.y), lab_curve(xyz.z)});
}

glm::dvec3 hunt_lab_of_linear_rgb(const glm::dvec3& rgb) {
  const glm::dvec3 lab = lab_of_linear_rgb(rgb);
  return {lab.x, 0.01 * lab.x * lab.y, 0.01 * lab.x * lab.z};
}

double hyab_distance(const glm::dvec3& a, const glm::dvec3& b) {
  return std::abs(a.x - b.x) + std::hypot(a.y - b.y, a.z - b.z);
}

}  // namespace tandem::compare
