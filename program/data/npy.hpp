#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "program/job/value_type.hpp"

/// NumPy's .npy files (numpy.lib.format, version 1.0; later versions are read too).
namespace tandem::program {

/// Numbers in C order, little-endian.
struct NpyArray {
  ScalarType scalar = ScalarType::float32;
  std::vector<std::uint64_t> shape;  ///< none: one number
  std::vector<std::byte> bytes;
};

/// Throws Error, naming the file: it is no .npy file, of a type that no shader has, in Fortran's order, big-endian.
NpyArray read_npy(const std::filesystem::path& path);

/// The file of an array.
std::vector<std::byte> to_npy(const NpyArray& array);

/// The scalars of a value, without what lies between them; arrays, matrices (column by column) and vectors give the
/// shape. Throws Error where they are of several types.
NpyArray npy_of(const ValueType& type, std::span<const std::byte> bytes);

/// The numbers become the scalars in their order. Throws Error where they are of another type, or more than there are.
void fill_from(std::span<std::byte> bytes, const ValueType& type, const NpyArray& array);

}  // namespace tandem::program
