#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <numeric>

#include "tools/kernels/problems.hpp"

namespace tandem::kernels {
namespace {

using Complex = std::complex<double>;

Words hashed_words(std::size_t count, std::uint32_t below) {
  Words words(count);
  for (std::size_t i = 0; i < count; ++i) words[i] = hashed(static_cast<std::uint32_t>(i)) % below;
  return words;
}

/// The transform of a signal whose length is a power of two, by Cooley and Tukey's recursion.
std::vector<Complex> transform(const std::vector<Complex>& signal) {
  const std::size_t count = signal.size();
  if (count == 1) return signal;
  std::vector<Complex> even, odd;
  for (std::size_t i = 0; i < count; i += 2) {
    even.push_back(signal[i]);
    odd.push_back(signal[i + 1]);
  }
  even = transform(even);
  odd = transform(odd);
  std::vector<Complex> spectrum(count);
  for (std::size_t i = 0; i < count / 2; ++i) {
    const Complex turned =
        odd[i] * std::polar(1.0, -2.0 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(count));
    spectrum[i] = even[i] + turned;
    spectrum[i + count / 2] = even[i] - turned;
  }
  return spectrum;
}

}  // namespace

Problem subgroup_reduction(Size size) {
  constexpr std::size_t block = 4096;
  const std::uint32_t blocks = size == Size::small ? 3 : 512;
  const std::vector<float> numbers = whole_floats(blocks * block, 100, 1);
  Problem problem{.inputs = {{.words = words_of(numbers)}}, .workgroup_count = {blocks, 1, 1}, .floats = true};
  for (std::size_t first = 0; first < numbers.size(); first += block)
    problem.expected.push_back(std::accumulate(&numbers[first], &numbers[first] + block, 0.0));
  return problem;
}

Problem prefix_sum(Size size) {
  constexpr std::size_t block = 512;
  const std::uint32_t blocks = size == Size::small ? 3 : 512;
  Problem problem{.inputs = {{.words = hashed_words(blocks * block, 1000)}}, .workgroup_count = {blocks, 1, 1}};
  double sum = 0.0;
  for (std::size_t i = 0; i < blocks * block; ++i) {
    if (i % block == 0) sum = 0.0;
    problem.expected.push_back(sum);
    sum += problem.inputs[0].words[i];
  }
  return problem;
}

Problem bitonic_sort(Size size) {
  constexpr std::size_t block = 512;
  const std::uint32_t blocks = size == Size::small ? 3 : 256;
  Problem problem{.inputs = {{.words = hashed_words(blocks * block, ~0U)}}, .workgroup_count = {blocks, 1, 1}};
  Words sorted = problem.inputs[0].words;
  for (auto first = sorted.begin(); first != sorted.end(); first += block) std::sort(first, first + block);
  problem.expected.assign(sorted.begin(), sorted.end());
  return problem;
}

Problem fft(Size size) {
  constexpr std::size_t block = 1024;
  const std::uint32_t blocks = size == Size::small ? 2 : 512;
  std::vector<float> signal(2 * block * blocks), roots;
  for (std::size_t i = 0; i < signal.size(); ++i) signal[i] = unit(static_cast<std::uint32_t>(i));
  for (std::size_t i = 0; i < block; ++i) {
    const Complex root = std::polar(1.0, -2.0 * std::numbers::pi * static_cast<double>(i) / block);
    roots.push_back(static_cast<float>(root.real()));
    roots.push_back(static_cast<float>(root.imag()));
  }
  Problem problem{.inputs = {{.words = words_of(signal)}, {.words = words_of(roots)}},
                  .workgroup_count = {blocks, 1, 1},
                  .floats = true};
  double largest = 0.0;  // sum of squares of a block
  for (std::size_t first = 0; first < signal.size(); first += 2 * block) {
    std::vector<Complex> points;
    double squares = 0.0;
    for (std::size_t i = 0; i < block; ++i) {
      points.emplace_back(signal[first + 2 * i], signal[first + 2 * i + 1]);
      squares += std::norm(points.back());
    }
    largest = std::max(largest, squares);
    for (const Complex& value : transform(points)) {
      problem.expected.push_back(value.real());
      problem.expected.push_back(value.imag());
    }
  }
  // In each of 5 passes a value takes a product and two sums, which err by at most some 4 roundings of its size; of all
  // values together that is 20 roundings of the norm of the spectrum, sqrt(1024) times that of the signal.
  problem.tolerance = 20.0 * 0x1p-24 * std::sqrt(largest * block);
  return problem;
}

}  // namespace tandem::kernels
