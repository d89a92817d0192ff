#pragma once

/// The inverse of an instance's transform, as the getters of a hit return it on every CPU device.
namespace tandem::cpu {

struct AffineInverse {
  float rows[3][4];  ///< row-major, computed in double precision and rounded; not finite when there is no inverse
  double determinant;
  double sum_of_magnitudes;  ///< of the products whose sum is the determinant, which says how far rounding can shift it
};

/// @param transform row-major 3x4
AffineInverse inverse_of(const float (&transform)[3][4]);

}  // namespace tandem::cpu
