#pragma once

#include <cstdint>
#include <random>

namespace tandem::test {

/// Arguments for tests: the same sequence with every standard library, unlike the distributions of <random>.
class RandomSource {
 public:
  explicit RandomSource(std::uint32_t seed) : generator_(seed) {}

  std::uint32_t bits() { return static_cast<std::uint32_t>(generator_()); }
  double uniform(double low, double high) { return low + (high - low) * (bits() / 4294967296.0); }

 private:
  std::mt19937 generator_;
};

}  // namespace tandem::test
