#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "compare/metrics.hpp"

namespace tandem::compare {

/// What two images may differ by and still be the same picture. The defaults are for the same shader, seed and scene on
/// two backends that round alike up to a few units in the last place.
struct Tolerance {
  /// Least fraction of pixels within 1e-3 relative. Where a ray meets an edge, or rounding flips a discrete decision, a
  /// path takes another course, and its pixel may have any value; on correct backends that happens at far fewer than
  /// one pixel in a hundred, while a wrong normal, index or random number spoils most of them.
  double within_1e3 = 0.99;

  /// Least fraction of bit-equal pixels: 0, since hardware may round division and square root differently.
  double bit_equal = 0.0;

  /// Largest |mean_a - mean_b| / max(|mean_a|, |mean_b|). Paths that took another course are noise of both signs, so
  /// they average out; a systematic difference too faint for the fraction above does not.
  double mean = 1e-4;

  /// Most pixels of either image with a NaN or an infinity: correct shaders make none.
  std::uint64_t non_finite = 0;
};

struct Verdict {
  bool agree = false;
  std::vector<std::string> reasons;  ///< one sentence with its numbers for each rule that is broken; empty when agree
};

Verdict judge(const Metrics& metrics, const Tolerance& tolerance = {});

/// "agree" or "differ".
const char* name(const Verdict& verdict);

}  // namespace tandem::compare
