#pragma once

#include <cstdint>
#include <vector>

/// What FLIP depends on and what it gives; compare/image/flip/flip.hpp says what it is.
namespace tandem::compare {

/// The error of each pixel, from 0 (no difference is seen) to 1, row by row from the top left.
struct FlipErrors {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::vector<float> errors;  ///< width * height
  double mean = 0.0;
  double largest = 0.0;
};

/// Where the viewer sits: pixels per degree of the visual angle. The default is that of [LDR]: 0.7 m away from a screen
/// 0.7 m wide with 3840 pixels in a row, 67.02.
struct ViewingConditions {
  double pixels_per_degree = pixels_per_degree_at(0.7, 0.7, 3840.0);

  /// @param distance and `width` of the screen in metres
  static constexpr double pixels_per_degree_at(double distance, double width, double pixels) {
    return distance * (pixels / width) * (3.14159265358979323846 / 180.0);
  }
};

}  // namespace tandem::compare
