#include "tools/kernels/problem.hpp"

#include <fmt/format.h>

#include <bit>
#include <cmath>

namespace tandem::kernels {

std::string mistake(const Problem& problem, std::span<const std::uint32_t> answer) {
  for (std::size_t i = 0; i < problem.expected.size(); ++i) {
    const double seen = problem.floats ? double{std::bit_cast<float>(answer[i])} : static_cast<double>(answer[i]);
    if (std::abs(seen - problem.expected[i]) <= problem.tolerance) continue;  // not so for NaN
    std::string text = fmt::format("word {} is {:.9g} in place of {:.9g}", i, seen, problem.expected[i]);
    if (problem.tolerance > 0.0) text += fmt::format(", which may differ by {:.3g}", problem.tolerance);
    return text;
  }
  return {};
}

}  // namespace tandem::kernels
