#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <vector>

#include "tests/shaders/function_kernel.hpp"
#include "tests/support/device_test.hpp"

using namespace tandem;

namespace {

using Bits = std::array<std::uint32_t, 4>;

/// The published hash, written down a second time.
Bits pcg4d(Bits v) {
  for (std::uint32_t& x : v) x = x * 1664525u + 1013904223u;
  const auto mix = [&v] {
    v[0] += v[1] * v[3];
    v[1] += v[2] * v[0];
    v[2] += v[0] * v[1];
    v[3] += v[1] * v[2];
  };
  mix();
  for (std::uint32_t& x : v) x ^= x >> 16;
  mix();
  return v;
}

std::vector<std::uint32_t> random_bits(rhi::Device& device, const std::vector<std::uint32_t>& keys) {
  return test::run_bits(device,
                        {.includes = "#include \"random.glsl\"",
                         .body = R"(
    RandomKey key;
    key.pixel = input_bits(0);
    key.sample_index = input_bits(1);
    key.seed = input_bits(3);
    uvec4 bits = random_bits(key, input_bits(2));
    output_bits(0, bits.x); output_bits(1, bits.y); output_bits(2, bits.z); output_bits(3, bits.w);)",
                         .input_count = 4,
                         .output_count = 4},
                        keys);
}

/// How far a chi-square value with so many degrees of freedom is from its mean, in standard deviations.
double chi_square_deviation(const std::vector<std::uint32_t>& counts, double expected) {
  double chi_square = 0.0;
  for (const std::uint32_t count : counts) chi_square += (count - expected) * (count - expected) / expected;
  const double freedom = static_cast<double>(counts.size()) - 1.0;
  return (chi_square - freedom) / std::sqrt(2.0 * freedom);
}

// The numbers are fixed, so a passing test cannot fail later. Of some sixty values none should be beyond 4.5 deviations
// (1 in 150,000 for a normal distribution).
constexpr double largest_deviation = 4.5;

constexpr std::uint32_t draws = 1 << 18;

/// Keys (pixel, sample, dimension, seed) of which one part counts up, as it does in a render.
std::vector<std::uint32_t> counting_keys(std::size_t part) {
  std::vector<std::uint32_t> keys;
  for (std::uint32_t i = 0; i < draws; ++i) {
    std::array<std::uint32_t, 4> key = {5 | (7 << 16), 3, 2, 1};
    key[part] = part == 0 ? (i % 512) | ((i / 512) << 16) : i;
    keys.insert(keys.end(), key.begin(), key.end());
  }
  return keys;
}

}  // namespace

TANDEM_DEVICE_TEST("Random bits are those of pcg4d") {
  const std::vector<std::uint32_t> keys = counting_keys(0);
  const std::vector<std::uint32_t> bits = random_bits(device, keys);
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < bits.size(); i += 4) {
    const Bits expected = pcg4d({keys[i], keys[i + 1], keys[i + 2], keys[i + 3]});
    for (std::size_t k = 0; k < 4; ++k) wrong += bits[i + k] != expected[k];
  }
  CHECK(wrong == 0);
}

TANDEM_DEVICE_TEST("Random numbers are equidistributed along pixels, samples, dimensions and seeds") {
  for (std::size_t part = 0; part < 4; ++part) {
    const std::vector<std::uint32_t> bits = random_bits(device, counting_keys(part));
    for (std::size_t k = 0; k < 4; ++k) {
      std::vector<std::uint32_t> upper(256), pairs(4096), serial(4096);
      for (std::size_t i = 0; i < draws; ++i) {
        const std::uint32_t value = bits[4 * i + k];
        const std::uint32_t companion = bits[4 * i + (k + 1) % 4];
        const std::uint32_t successor = bits[4 * ((i + 1) % draws) + k];
        ++upper[value >> 24];
        ++pairs[(value >> 26) << 6 | companion >> 26];
        ++serial[(value >> 26) << 6 | successor >> 26];
      }
      INFO("part ", part, " of the key, number ", k);
      CHECK(std::abs(chi_square_deviation(upper, draws / 256.0)) < largest_deviation);
      CHECK(std::abs(chi_square_deviation(pairs, draws / 4096.0)) < largest_deviation);
      CHECK(std::abs(chi_square_deviation(serial, draws / 4096.0)) < largest_deviation);
    }
  }
}

TANDEM_DEVICE_TEST("unit_interval is a multiple of 2^-24 in [0, 1)") {
  const test::FunctionKernel kernel = {.includes = "#include \"random.glsl\"",
                                       .body = "output_float(0, unit_interval(input_bits(0)));"};
  const std::vector<std::uint32_t> outputs =
      test::run_bits(device, kernel, {0u, 0xffu, 0x100u, 0x80000000u, 0xffffffffu});
  CHECK(outputs == std::vector<std::uint32_t>{0x00000000u, 0x00000000u, 0x33800000u, 0x3f000000u, 0x3f7fffffu});
}
