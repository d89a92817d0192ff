#pragma once

#include <cstdint>
#include <random>

namespace tandem::weekend {

/// The random numbers of a rendering, as the books have them: one stream for everything.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}

  /// In [0, 1): 53 random bits.
  double uniform() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }

 private:
  std::mt19937_64 engine_;
};

}  // namespace tandem::weekend
