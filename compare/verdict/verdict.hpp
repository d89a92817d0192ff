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

/// What a classification of paths leaves for the thresholds (compare/cause/unexplained_difference.hpp).
struct UnexplainedDifference {
  Metrics metrics;       ///< of the images, but for the pixels whose difference is explained
  std::string sentence;  ///< what explains them, with numbers
};

/// What a verdict is made from.
struct Evidence {
  Metrics metrics;
  std::optional<std::uint64_t> mismatches = {};           ///< paths of class mismatch; absent: none was classified
  std::vector<BiasFinding> bias = {};                     ///< tier statistical: not empty
  std::optional<std::uint64_t> probe_mismatches = {};     ///< answers to probes likewise; absent: nothing was probed
  std::optional<UnexplainedDifference> unexplained = {};  ///< where paths were classified
};

enum class Outcome {
  agree,      ///< every rule holds
  explained,  ///< not every rule holds, but each does once the pixels that the scene explains are left out
  differ      ///< a device is at fault, or the difference is unexplained
};

/// "agree", "explained", "differ".
const char* name(Outcome outcome);

/// That of several comparisons together.
Outcome worse(Outcome first, Outcome second);

struct Verdict {
  Tier tier = Tier::tolerance;
  Outcome outcome = Outcome::differ;
  /// One sentence with its numbers for each rule that is broken, and what explains it; empty when the images agree.
  std::vector<std::string> reasons;
};

/// Holds the evidence to the rules of the tier: all of the images, and if that fails, what no scene explains of them.
/// Throws std::invalid_argument for tier statistical without a test.
Verdict make_verdict(const Evidence& evidence, const Thresholds& thresholds = {});

/// That of its outcome.
const char* name(const Verdict& verdict);

}  // namespace tandem::compare
