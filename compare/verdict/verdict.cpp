#include "compare/verdict/verdict.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace tandem::compare {
namespace {

/// Collects the sentences of the rules that do not hold.
class RuleCheck {
 public:
  explicit RuleCheck(const Thresholds& thresholds) : thresholds_(thresholds) {}

  std::vector<std::string> reasons() && { return std::move(reasons_); }

  void check_counts(const Evidence& evidence) {
    check_finite('a', evidence.metrics.non_finite_a);
    check_finite('b', evidence.metrics.non_finite_b);
    check_mismatches(evidence.mismatches.value_or(0), "path differs", "paths differ");
    check_mismatches(evidence.probe_mismatches.value_or(0), "answer to a probe differs", "answers to probes differ");
  }

  void check_exact(const Metrics& metrics) {
    const double different = std::round((1.0 - metrics.bit_equal) * static_cast<double>(metrics.pixels));
    require(metrics.bit_equal == 1.0,
            fmt::format("{:.0f} of {} pixels do not have the same bits; tier exact requires all to.", different,
                        metrics.pixels));
  }

  void check_tolerance(const Metrics& metrics) {
    check_fraction(RuleMetric::within_1e3, metrics.within_1e3, "within 1e-3 relative");
    check_fraction(RuleMetric::bit_equal, metrics.bit_equal, "bit-equal");
    // Without a division, so that two black images have equal means. Few paths that took another course are noise, of
    // which four standard errors are allowed; where all pixels are off by the same, that is next to nothing.
    const double larger_mean = std::max(std::abs(metrics.mean_a), std::abs(metrics.mean_b));
    const double most = thresholds_.limit(RuleMetric::mean_difference);
    require(std::abs(metrics.mean_a - metrics.mean_b) <= most * larger_mean + 4.0 * metrics.mean_noise,
            fmt::format("The means {:.9g} and {:.9g} differ by more than {:g} relative.", metrics.mean_a,
                        metrics.mean_b, most));
  }

  void check_bias(const std::vector<BiasFinding>& findings) {
    if (findings.empty()) throw std::invalid_argument("a statistical verdict needs a test");
    const double least = thresholds_.limit(RuleMetric::bias_p_value);
    for (const BiasFinding& finding : findings)
      require(finding.p_value >= least,
              fmt::format("{}: the p-value is {:.2g}, the minimum is {:g}.", finding.sentence, finding.p_value, least));
  }

 private:
  static std::string count_text(double count) { return fmt::format("{:.0f}", count); }

  void require(bool holds, std::string otherwise) {
    if (!holds) reasons_.push_back(std::move(otherwise));
  }

  void check_finite(char image, std::uint64_t count) {
    const double most = thresholds_.limit(RuleMetric::non_finite);
    require(static_cast<double>(count) <= most,
            fmt::format("Image {} has {} pixels with a NaN or an infinity; the limit is {}.", image, count,
                        count_text(most)));
  }

  void check_mismatches(std::uint64_t count, const char* one, const char* several) {
    const double most = thresholds_.limit(RuleMetric::mismatches);
    require(static_cast<double>(count) <= most, fmt::format("{} {} beyond what rounding explains; the limit is {}.",
                                                            count, count == 1 ? one : several, count_text(most)));
  }

  void check_fraction(RuleMetric metric, double fraction, const char* what) {
    const double least = thresholds_.limit(metric);
    require(fraction >= least, fmt::format("Only {:.4f} % of the pixels are {}; at least {:g} % must be.",
                                           100.0 * fraction, what, 100.0 * least));
  }

  const Thresholds& thresholds_;
  std::vector<std::string> reasons_;
};

}  // namespace

Verdict make_verdict(const Evidence& evidence, const Thresholds& thresholds) {
  RuleCheck rules(thresholds);
  rules.check_counts(evidence);
  switch (thresholds.tier) {
    case Tier::exact:
      rules.check_exact(evidence.metrics);
      break;
    case Tier::tolerance:
      rules.check_tolerance(evidence.metrics);
      break;
    case Tier::statistical:
      rules.check_bias(evidence.bias);
      break;
  }
  Verdict verdict{.tier = thresholds.tier, .agree = false, .reasons = std::move(rules).reasons()};
  verdict.agree = verdict.reasons.empty();
  return verdict;
}

const char* name(const Verdict& verdict) { return verdict.agree ? "agree" : "differ"; }

}  // namespace tandem::compare
