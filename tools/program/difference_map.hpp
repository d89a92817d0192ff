#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "program/job/value_type.hpp"

/// Where two values of one type differ, as a picture.
namespace tandem::tools::program_run {

struct DifferenceMap {
  std::uint32_t width = 0, height = 0;
  std::uint64_t scalars_of_cell = 1;   ///< numbers that one pixel stands for
  std::vector<std::uint8_t> rgb = {};  ///< 3 * width * height, sRGB, row by row
};

/// Of each cell the largest relative difference of its numbers, |a - b| over the larger of the two. Black: all bits are
/// equal. Then one colour a decade, as compare::heat_map has them: dark blue up to 1e-6, blue 1e-5, cyan 1e-4, green
/// 1e-3, yellow 1e-2, red 1e-1, white from 1 on. Magenta: a NaN or an infinity in one alone.
/// @param size pixels, width first; cells behind the last number are grey
/// @param scalars_of_cell numbers of a pixel, which follow each other
DifferenceMap difference_map(const program::ValueType& type, std::span<const std::byte> a, std::span<const std::byte> b,
                             const std::array<std::uint32_t, 2>& size, std::uint64_t scalars_of_cell);

/// The same for values without a shape: rows of at most 128 cells, and at most 128 rows.
DifferenceMap difference_map(const program::ValueType& type, std::span<const std::byte> a,
                             std::span<const std::byte> b);

}  // namespace tandem::tools::program_run
