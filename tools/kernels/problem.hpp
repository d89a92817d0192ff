#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace tandem::kernels {

using Words = std::vector<std::uint32_t>;

/// What a kernel reads at binding 1, 2, ...: a storage buffer, or a sampled image of one float a texel.
struct Input {
  Words words = {};
  std::uint32_t image_side = 0;  ///< 0: a buffer
};

enum class Size {
  small,  ///< a few workgroups, to check answers
  usual   ///< 10 to 100 ms on the slowest device of a small machine
};

/// One dispatch, and the words that it must leave in the buffer at binding 0.
struct Problem {
  std::vector<Input> inputs = {};
  Words push_constants = {};
  std::array<std::uint32_t, 3> workgroup_count = {1, 1, 1};
  std::vector<double> expected = {};  ///< of each word
  bool floats = false;                ///< the words are floats, else whole numbers
  double tolerance = 0.0;             ///< of each; 0: inputs are such that rounding cannot change the answer
};

/// What is wrong with the answer: "word 3 is 7 in place of 6"; empty if nothing is.
std::string mistake(const Problem& problem, std::span<const std::uint32_t> answer);

}  // namespace tandem::kernels
