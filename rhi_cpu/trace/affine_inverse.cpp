#include "rhi_cpu/trace/affine_inverse.hpp"

#include <cmath>

namespace tandem::cpu {

AffineInverse inverse_of(const float (&m)[3][4]) {
  AffineInverse result{.rows = {}, .determinant = 0, .sum_of_magnitudes = 0};
  double cofactors[3][3];
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      const int r1 = (row + 1) % 3, r2 = (row + 2) % 3;
      const int c1 = (column + 1) % 3, c2 = (column + 2) % 3;
      const double positive = double{m[r1][c1]} * double{m[r2][c2]};
      const double negative = double{m[r1][c2]} * double{m[r2][c1]};
      cofactors[row][column] = positive - negative;
      if (row > 0) continue;
      result.determinant += double{m[0][column]} * cofactors[0][column];
      result.sum_of_magnitudes += std::abs(double{m[0][column]}) * (std::abs(positive) + std::abs(negative));
    }
  }
  for (int row = 0; row < 3; ++row) {
    double translation = 0;
    for (int column = 0; column < 3; ++column) {
      const double value = cofactors[column][row] / result.determinant;
      translation -= value * double{m[column][3]};
      result.rows[row][column] = static_cast<float>(value);
    }
    result.rows[row][3] = static_cast<float>(translation);
  }
  return result;
}

}  // namespace tandem::cpu
