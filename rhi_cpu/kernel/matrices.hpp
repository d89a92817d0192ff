#pragma once

#include <glm/matrix.hpp>

#include "rhi_cpu/kernel/geometry.hpp"
#include "rhi_cpu/kernel/types.hpp"

/// Products and functions of matrices. Mesa sums matrix * vector from the last column to the first; GLM does not.
namespace tandem::kernel {

template <int columns, int rows, typename T>
constexpr glm::vec<rows, T> multiply(const glm::mat<columns, rows, T>& m, const glm::vec<columns, T>& v) {
  glm::vec<rows, T> sum = m[columns - 1] * v[columns - 1];
  for (int i = columns - 2; i >= 0; --i) sum = m[i] * v[i] + sum;
  return sum;
}

template <int columns, int rows, typename T>
constexpr glm::vec<columns, T> multiply(const glm::vec<rows, T>& v, const glm::mat<columns, rows, T>& m) {
  glm::vec<columns, T> result(T{0});
  for (int i = 0; i < columns; ++i) result[i] = kernel::dot(v, m[i]);
  return result;
}

template <int columns, int inner, int rows, typename T>
constexpr glm::mat<columns, rows, T> multiply(const glm::mat<inner, rows, T>& a, const glm::mat<columns, inner, T>& b) {
  glm::mat<columns, rows, T> result(T{0});
  for (int i = 0; i < columns; ++i) result[i] = kernel::multiply(a, b[i]);
  return result;
}

template <int columns, int rows, typename T>
constexpr glm::mat<columns, rows, T> outer_product(const glm::vec<rows, T>& a, const glm::vec<columns, T>& b) {
  glm::mat<columns, rows, T> result(T{0});
  for (int i = 0; i < columns; ++i) result[i] = a * b[i];
  return result;
}

template <int columns, int rows, typename T>
constexpr glm::mat<rows, columns, T> transpose(const glm::mat<columns, rows, T>& m) {
  glm::mat<rows, columns, T> result(T{0});
  for (int i = 0; i < columns; ++i)
    for (int j = 0; j < rows; ++j) result[j][i] = m[i][j];
  return result;
}

template <int size, typename T>
inline T determinant(const glm::mat<size, size, T>& m) {
  return glm::determinant(m);
}

template <int size, typename T>
inline glm::mat<size, size, T> inverse(const glm::mat<size, size, T>& m) {
  return glm::inverse(m);
}

}  // namespace tandem::kernel
