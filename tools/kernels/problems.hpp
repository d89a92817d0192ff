#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "tools/kernels/problem.hpp"

/// The problem of each kernel, with its answer by plain C++. Where inputs are small whole numbers in floats, all sums
/// and products are exact below 2^24, so that no order of them and no fused operation changes the answer.
namespace tandem::kernels {

// problems_blocks.cpp: each workgroup answers for a block of its own.
Problem subgroup_reduction(Size size);
Problem prefix_sum(Size size);
Problem bitonic_sort(Size size);
Problem fft(Size size);

// problems_images.cpp: a value for each pixel.
Problem filter_buffer(Size size);
Problem filter_image(Size size);
Problem mandelbrot(Size size);

// problems_numbers.cpp: each value of the answer needs all of the input.
Problem matrix_product(Size size);
Problem n_body(Size size);

/// The same random number for the same index, uniform in 32 bits (the finaliser of MurmurHash3).
constexpr std::uint32_t hashed(std::uint32_t index) {
  index = (index ^ (index >> 16)) * 0x85ebca6bU;
  index = (index ^ (index >> 13)) * 0xc2b2ae35U;
  return index ^ (index >> 16);
}

/// `count` floats that are whole numbers from -`most` to `most`.
inline std::vector<float> whole_floats(std::size_t count, std::uint32_t most, std::uint32_t seed) {
  std::vector<float> values(count);
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t number = hashed(static_cast<std::uint32_t>(i) + seed * 0x9e3779b9U) % (2 * most + 1);
    values[i] = static_cast<float>(static_cast<std::int32_t>(number) - static_cast<std::int32_t>(most));
  }
  return values;
}

/// A number from -1 to 1.
inline float unit(std::uint32_t index) { return static_cast<float>(hashed(index) >> 8) * 0x1p-23F - 1.0F; }

inline Words words_of(const std::vector<float>& values) {
  Words words;
  for (const float value : values) words.push_back(std::bit_cast<std::uint32_t>(value));
  return words;
}

}  // namespace tandem::kernels
