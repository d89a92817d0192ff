#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "program/job/value_type.hpp"

namespace tandem::program {

/// How far two numbers may lie apart and still agree: either limit is enough.
struct Tolerance {
  std::uint64_t ulp = 0;  ///< floats: numbers of their type between them; whole numbers: their difference
  double relative = 0;    ///< their difference, of the larger absolute value
};

/// A scalar that differs.
struct Difference {
  std::uint64_t index = 0;  ///< of the scalar
  std::string path = {};    ///< as path_of says
  std::string a = {};       ///< its values, as texts
  std::string b = {};
  std::uint64_t ulp = 0;  ///< 0 where either is no number
  double relative = 0;    ///< infinite where one of them is no number, or infinite
};

/// Two values of one type, scalar by scalar. Bytes between scalars do not count.
struct Comparison {
  std::uint64_t scalars = 0;
  std::uint64_t bit_equal = 0;
  std::uint64_t within = 0;  ///< that agree within the tolerance, with those that are bit-equal
  std::uint64_t nan_a = 0;   ///< NaN in a alone: never within the tolerance. Two NaN agree, whatever their payloads
  std::uint64_t nan_b = 0;
  std::uint64_t largest_ulp = 0;
  double largest_relative = 0;
  double largest_absolute = 0;               ///< of those where both are finite
  std::optional<Difference> first = {};      ///< that is not bit-equal
  std::optional<Difference> worst = {};      ///< by the relative difference, then by the first
  std::optional<Difference> disagreed = {};  ///< the first beyond the tolerance

  bool agrees() const noexcept { return within == scalars; }
};

/// @pre a and b have the same size, and not less than the type
Comparison compare(const ValueType& type, std::span<const std::byte> a, std::span<const std::byte> b,
                   const Tolerance& tolerance);

/// How many numbers of the type lie between two, and one more: 0 for equal ones, and for -0 and 0. The largest number
/// where either is no number.
std::uint64_t ulp_distance(ScalarType scalar, std::uint64_t a, std::uint64_t b);

}  // namespace tandem::program
