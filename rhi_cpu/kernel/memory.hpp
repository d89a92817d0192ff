#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>

#include "rhi_cpu/kernel/types.hpp"

/// Loads and stores of buffers at byte addresses that the translator computes from the Offset, ArrayStride and
/// MatrixStride decorations. Buffers are bytes: every access goes through memcpy, so that it is defined whatever the
/// alignment or the type that wrote the bytes; compilers make plain moves of it.
namespace tandem::kernel {

template <typename T>
inline T load(const std::byte* address) {
  T value;
  std::memcpy(&value, address, sizeof(T));
  return value;
}

template <typename T>
inline void store(std::byte* address, const T& value) {
  std::memcpy(address, &value, sizeof(T));
}

/// A vector whose components lie `stride` bytes apart: a column of a row-major matrix.
template <typename Vector, std::size_t stride>
inline Vector load_strided(const std::byte* address) {
  Vector value;
  for (int i = 0; i < Vector::length(); ++i)
    value[i] = load<typename Vector::value_type>(address + static_cast<std::size_t>(i) * stride);
  return value;
}

template <typename Vector, std::size_t stride>
inline void store_strided(std::byte* address, const Vector& value) {
  for (int i = 0; i < Vector::length(); ++i) store(address + static_cast<std::size_t>(i) * stride, value[i]);
}

/// A matrix whose columns (row_major: rows) lie `stride` bytes apart.
template <typename Matrix, std::size_t stride, bool row_major>
inline Matrix load_matrix(const std::byte* address) {
  using Column = typename Matrix::col_type;
  Matrix value;
  for (int column = 0; column < Matrix::length(); ++column) {
    const auto i = static_cast<std::size_t>(column);
    if constexpr (row_major)
      value[column] = load_strided<Column, stride>(address + i * sizeof(typename Matrix::value_type));
    else
      value[column] = load<Column>(address + i * stride);
  }
  return value;
}

template <typename Matrix, std::size_t stride, bool row_major>
inline void store_matrix(std::byte* address, const Matrix& value) {
  using Column = typename Matrix::col_type;
  for (int column = 0; column < Matrix::length(); ++column) {
    const auto i = static_cast<std::size_t>(column);
    if constexpr (row_major)
      store_strided<Column, stride>(address + i * sizeof(typename Matrix::value_type), value[column]);
    else
      store<Column>(address + i * stride, value[column]);
  }
}

/// A whole array, element by element.
template <typename T, std::size_t stride, typename LoadElement>
inline T load_array(const std::byte* address, const LoadElement& load_element) {
  T value;
  for (std::size_t i = 0; i < value.size(); ++i) value[i] = load_element(address + i * stride);
  return value;
}

template <typename T, std::size_t stride, typename StoreElement>
inline void store_array(std::byte* address, const T& value, const StoreElement& store_element) {
  for (std::size_t i = 0; i < value.size(); ++i) store_element(address + i * stride, value[i]);
}

/// Elements of a runtime array that starts at `offset` of a buffer of `size` bytes.
inline std::uint32_t runtime_array_length(std::uint64_t size, std::uint64_t offset, std::uint64_t stride) {
  return size < offset ? 0u : static_cast<std::uint32_t>((size - offset) / stride);
}

}  // namespace tandem::kernel
