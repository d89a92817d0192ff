// What each sampler promises of the points of one pixel, exactly.

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include <doctest/doctest.h>

#include "tests/shaders/function_kernel.hpp"
#include "tests/shaders/sampling/sampler_draws.hpp"
#include "tests/support/device_test.hpp"
#include "tests/support/statistics/chi_square.hpp"

using namespace tandem;
using test::Bits;
using test::Draw;

namespace {

/// Index of the part of [0, 2^32) among `parts` equal ones.
std::uint32_t part_of(std::uint32_t bits, std::uint32_t parts) {
  return static_cast<std::uint32_t>(std::uint64_t{bits} * parts >> 32);
}

/// The most points of one cell of a grid of so many parts of number i and of number j.
std::uint32_t fullest_cell(const std::vector<Bits>& points, std::size_t i, std::uint32_t parts_i, std::size_t j,
                           std::uint32_t parts_j) {
  std::vector<std::uint32_t> counts(std::size_t{parts_i} * parts_j);
  for (const Bits& point : points)
    ++counts[std::size_t{part_of(point[i], parts_i)} * parts_j + part_of(point[j], parts_j)];
  return *std::ranges::max_element(counts);
}

/// Whether every box of volume 1 / points with sides of powers of two has exactly one point: a (0, m, 2)-net in base 2.
bool is_net(const std::vector<Bits>& points, std::size_t i, std::size_t j) {
  const auto count = static_cast<std::uint32_t>(points.size());
  for (std::uint32_t parts = 1; parts <= count; parts *= 2)
    if (fullest_cell(points, i, parts, j, count / parts) != 1) return false;
  return true;
}

std::vector<Bits> part(const std::vector<Bits>& points, std::size_t first, std::size_t count) {
  const auto begin = points.begin() + static_cast<std::ptrdiff_t>(first);
  return {begin, begin + static_cast<std::ptrdiff_t>(count)};
}

const std::vector<Draw> some_draws = {{.x = 0, .y = 0, .dimension = 0},
                                      {.x = 5, .y = 700, .dimension = 1},
                                      {.x = 511, .y = 3, .dimension = 4, .seed = 9},
                                      {.x = 300, .y = 300, .dimension = 17}};

}  // namespace

TANDEM_DEVICE_TEST("permuted_index permutes, and permutations come equally often") {
  const test::FunctionKernel kernel = {
      .includes = "#include \"sampling/permutation.glsl\"",
      .body = "output_bits(0, permuted_index(input_bits(0), input_bits(1), input_bits(2)));",
      .input_count = 3};
  std::vector<std::uint32_t> inputs;
  const std::vector<std::uint32_t> lengths = {1, 2, 3, 4, 5, 7, 16, 53, 100, 1000, 65025};
  for (const std::uint32_t length : lengths)
    for (std::uint32_t i = 0; i < length; ++i) inputs.insert(inputs.end(), {i, length, 77u * length});
  std::vector<std::uint32_t> outputs = test::run_bits(device, kernel, inputs);
  auto next = outputs.begin();
  for (const std::uint32_t length : lengths) {
    CAPTURE(length);
    const std::set<std::uint32_t> images(next, next + length);
    CHECK(images.size() == length);
    CHECK(*images.rbegin() == length - 1);
    next += length;
  }
  inputs.clear();
  constexpr std::uint32_t keys = 10'000;
  for (std::uint32_t key = 0; key < keys; ++key)
    for (std::uint32_t i = 0; i < 5; ++i) inputs.insert(inputs.end(), {i, 5u, key});
  outputs = test::run_bits(device, kernel, inputs);
  std::vector<double> counts(5 * 5 * 5 * 5);
  std::vector<double> possible(counts.size());
  for (std::size_t i = 0; i < counts.size(); ++i)
    possible[i] = std::set{i / 125, i / 25 % 5, i / 5 % 5, i % 5}.size() == 4 ? 1 : 0;
  for (std::size_t i = 0; i < outputs.size(); i += 5)
    counts[((outputs[i] * 5 + outputs[i + 1]) * 5 + outputs[i + 2]) * 5 + outputs[i + 3]] += 1;
  CHECK(test::chi_square(counts, possible).p_value > 1e-3);  // the keys are fixed
}

TANDEM_DEVICE_TEST("permuted_quadrant gives each of the 24 permutations equally often") {
  const test::FunctionKernel kernel = {.includes = "#include \"sampling/permutation.glsl\"",
                                       .body = R"(
    for (uint i = 0; i < 4; ++i) output_bits(i, permuted_quadrant(i, hash_bits(input_bits(0))));)",
                                       .output_count = 4};
  std::vector<std::uint32_t> keys(24'000);
  for (std::uint32_t i = 0; i < keys.size(); ++i) keys[i] = i;
  const std::vector<std::uint32_t> outputs = test::run_bits(device, kernel, keys);
  std::vector<double> counts(256), possible(256);
  for (std::size_t i = 0; i < 256; ++i) possible[i] = std::set{i >> 6, i >> 4 & 3, i >> 2 & 3, i & 3}.size() == 4;
  for (std::size_t i = 0; i < outputs.size(); i += 4)
    counts[outputs[i] << 6 | outputs[i + 1] << 4 | outputs[i + 2] << 2 | outputs[i + 3]] += 1;
  CHECK(test::chi_square(counts, possible).p_value > 1e-3);
}

TANDEM_DEVICE_TEST("stratum_bits cuts [0, 2^32) into equal parts without gaps") {
  const test::FunctionKernel kernel = {.includes = "#include \"sampling/permutation.glsl\"",
                                       .body = R"(
    output_bits(0, stratum_bits(input_bits(0), input_bits(1), 0u));
    output_bits(1, stratum_bits(input_bits(0), input_bits(1), 0xffffffffu));)",
                                       .input_count = 2,
                                       .output_count = 2};
  for (const std::uint32_t count : {1u, 2u, 3u, 4u, 7u, 64u, 81u, 65025u, 65535u}) {
    CAPTURE(count);
    std::vector<std::uint32_t> inputs;
    for (std::uint32_t i = 0; i < count; ++i) inputs.insert(inputs.end(), {i, count});
    const std::vector<std::uint32_t> outputs = test::run_bits(device, kernel, inputs);
    std::size_t wrong = 0;
    for (std::uint64_t i = 0; i < count; ++i) {
      wrong += outputs[2 * i] != (i << 32) / count;
      wrong += outputs[2 * i + 1] != ((i + 1) << 32) / count - 1;
    }
    CHECK(wrong == 0);
  }
}

TANDEM_DEVICE_TEST("sobol_point gives the points that Joe and Kuo publish") {
  // The first eight of dimensions 1 to 4, in eighths, in the order of their program, which is that of Gray codes.
  const std::vector<std::array<double, 4>> published = {{0, 0, 0, 0}, {4, 4, 4, 4}, {6, 2, 2, 2}, {2, 6, 6, 6},
                                                        {3, 3, 5, 7}, {7, 7, 1, 3}, {5, 1, 7, 5}, {1, 5, 3, 1}};
  std::vector<std::uint32_t> indices;
  for (std::uint32_t i = 0; i < 8; ++i) indices.push_back(i ^ i >> 1);
  const std::vector<std::uint32_t> outputs = test::run_bits(device,
                                                            {.includes = "#include \"sampling/sobol.glsl\"",
                                                             .body = R"(
    uvec4 bits = sobol_point(input_bits(0));
    output_bits(0, bits.x); output_bits(1, bits.y); output_bits(2, bits.z); output_bits(3, bits.w);)",
                                                             .output_count = 4},
                                                            indices);
  for (std::size_t i = 0; i < 8; ++i)
    for (std::size_t k = 0; k < 4; ++k) CHECK(8 * test::fraction(outputs[4 * i + k]) == published[i][k]);
}

TANDEM_DEVICE_TEST("Sobol samples of a pixel are nets, and so is every further power of two") {
  for (const Draw& first : some_draws) {
    const std::vector<Bits> points = test::draw_samples(device, test::sobol, 60, first, 256);
    for (const auto& [begin, count] : {std::pair{0, 64}, {64, 64}, {128, 128}, {0, 256}}) {
      CAPTURE(begin);
      const std::vector<Bits> block = part(points, static_cast<std::size_t>(begin), static_cast<std::size_t>(count));
      CHECK(is_net(block, 0, 1));
      CHECK(fullest_cell(block, 2, static_cast<std::uint32_t>(count), 3, 1) == 1);
      CHECK(fullest_cell(block, 3, static_cast<std::uint32_t>(count), 2, 1) == 1);
    }
  }
}

TANDEM_DEVICE_TEST("Blue-noise samples are nets in every pixel and in every square of pixels of a power of two") {
  for (const std::uint32_t side : {1u, 2u, 4u}) {
    std::vector<Draw> draws;
    for (std::uint32_t pixel = 0; pixel < side * side; ++pixel)
      for (std::uint32_t sample = 16; sample < 32; ++sample)
        draws.push_back({.x = 44 + pixel % side, .y = 300 + pixel / side, .sample = sample, .dimension = 3});
    const std::vector<Bits> points = test::draw(device, test::blue_noise, 16, draws);
    CAPTURE(side);
    CHECK(is_net(points, 0, 1));
    CHECK(fullest_cell(points, 2, 16 * side * side, 3, 1) == 1);
    CHECK(fullest_cell(points, 3, 16 * side * side, 2, 1) == 1);
  }
}

TANDEM_DEVICE_TEST("Stratified samples hit every stratum of each number and every cell of each pair once") {
  struct Grid {
    std::uint32_t total, columns, rows;
  };
  for (const Grid grid : {Grid{1, 1, 1}, {4, 2, 2}, {12, 3, 4}, {32, 4, 8}, {64, 8, 8}, {7, 2, 4}, {210, 14, 15}}) {
    const std::uint32_t cells = grid.columns * grid.rows;
    CAPTURE(grid.total);
    for (const Draw& first : some_draws) {
      const std::vector<Bits> points = test::draw_samples(device, test::stratified, grid.total, first, 2 * grid.total);
      for (const std::uint32_t begin : {0u, grid.total}) {
        const std::vector<Bits> block = part(points, begin, grid.total);
        for (const std::size_t pair : {0, 2}) {
          CHECK(fullest_cell(block, pair, cells, pair + 1, 1) == 1);
          CHECK(fullest_cell(block, pair, 1, pair + 1, cells) == 1);
          CHECK(fullest_cell(block, pair, grid.columns, pair + 1, grid.rows) == 1);
        }
      }
    }
  }
}

TANDEM_DEVICE_TEST("Halton samples hit every stratum of their bases once, wherever they begin") {
  const std::vector<Bits> points = test::draw_samples(device, test::halton, 200, {.x = 12, .y = 34}, 200);
  CHECK(fullest_cell(part(points, 30, 64), 0, 64, 1, 1) == 1);
  CHECK(fullest_cell(part(points, 30, 81), 0, 1, 1, 81) == 1);
  CHECK(fullest_cell(part(points, 30, 72), 0, 8, 1, 9) == 1);
  CHECK(fullest_cell(part(points, 30, 125), 2, 125, 3, 1) == 1);
  CHECK(fullest_cell(part(points, 30, 49), 3, 49, 2, 1) == 1);
  CHECK(fullest_cell(part(points, 30, 35), 2, 5, 3, 7) == 1);
  const std::vector<Bits> last = test::draw_samples(device, test::halton, 200, {.x = 12, .y = 34, .dimension = 3}, 53);
  CHECK(fullest_cell(last, 3, 53, 0, 1) == 1);
  // Padded dimensions have another order, but all planned samples together are the same points.
  const std::vector<Bits> padded =
      test::draw_samples(device, test::halton, 72, {.x = 12, .y = 34, .dimension = 20}, 144);
  for (const std::size_t begin : {0, 72}) CHECK(fullest_cell(part(padded, begin, 72), 0, 8, 1, 9) == 1);
}

TANDEM_DEVICE_TEST("Hammersley samples are i / n, then radical inverses") {
  for (const std::uint32_t dimension : {0u, 20u}) {
    const Draw first{.x = 12, .y = 34, .dimension = dimension};
    const std::vector<Bits> points = test::draw_samples(device, test::hammersley, 64, first, 128);
    for (const std::size_t begin : {0, 64}) CHECK(is_net(part(points, begin, 64), 0, 1));
    const std::vector<Bits> more = test::draw_samples(device, test::hammersley, 90, first, 90);
    CHECK(fullest_cell(more, 0, 90, 1, 1) == 1);
    CHECK(fullest_cell(more, 0, 10, 2, 9) == 1);
  }
  const std::vector<Bits> next =
      test::draw_samples(device, test::hammersley, 49, {.x = 12, .y = 34, .dimension = 1}, 49);
  CHECK(fullest_cell(next, 0, 49, 1, 1) == 1);  // base 7, then 11
  const std::vector<Bits> few =
      test::draw_samples(device, test::hammersley, 11, {.x = 12, .y = 34, .dimension = 1}, 11);
  CHECK(fullest_cell(few, 0, 1, 1, 11) == 1);
}
