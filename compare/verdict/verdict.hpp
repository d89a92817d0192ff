#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "compare/metrics/metrics.hpp"
#include "compare/verdict/thresholds.hpp"

namespace tandem::compare {

/// A test that two sets of images are estimates of the same picture.
struct BiasFinding {
  std::string sentence;  ///< what is the case if the p-value is too small, as in "Image b is not the picture of a"
  double p_value = 1;    ///< corrected for all that was looked at
};

/// What a verdict is made from.
struct Evidence {
  Metrics metrics;
  std::optional<std::uint64_t> mismatches = {};        ///< paths of class mismatch; absent: none was classified
  std::vector<BiasFinding> bias = {};                  ///< tier statistical: not empty
  std::optional<std::uint64_t> probe_mismatches = {};  ///< answers to probes likewise; absent: nothing was probed
};

struct Verdict {
  Tier tier = Tier::tolerance;
  bool agree = false;
  std::vector<std::string> reasons;  ///< one sentence with its numbers for each rule that is broken; empty when agree
};

/// Holds the evidence to the rules of the tier. Throws std::invalid_argument for tier statistical without a test.
Verdict make_verdict(const Evidence& evidence, const Thresholds& thresholds = {});

/// "agree" or "differ".
const char* name(const Verdict& verdict);

}  // namespace tandem::compare
