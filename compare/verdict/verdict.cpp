#include "compare/verdict/verdict.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <stdexcept>
#include <utility>

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

/// The sentences of the rules about images that do not hold.
std::vector<std::string> broken_rules(const Metrics& metrics, const Thresholds& thresholds) {
  RuleCheck rules(thresholds);
  if (thresholds.tier == Tier::exact)
    rules.check_exact(metrics);
  else
    rules.check_tolerance(metrics);
  return std::move(rules).reasons();
}

}  // namespace

const char* name(Outcome outcome) {
  switch (outcome) {
    case Outcome::agree:
      return "agree";
    case Outcome::explained:
      return "explained";
    case Outcome::differ:
      return "differ";
  }
  return "";
}

Outcome worse(Outcome first, Outcome second) { return std::max(first, second); }

Verdict make_verdict(const Evidence& evidence, const Thresholds& thresholds) {
  RuleCheck counts(thresholds);
  counts.check_counts(evidence);
  if (thresholds.tier == Tier::statistical) counts.check_bias(evidence.bias);
  Verdict verdict{.tier = thresholds.tier, .reasons = std::move(counts).reasons()};
  const bool faultless = verdict.reasons.empty();
  std::vector<std::string> broken;
  bool explained = false;
  if (thresholds.tier != Tier::statistical) broken = broken_rules(evidence.metrics, thresholds);
  if (!broken.empty() && evidence.unexplained) {
    std::vector<std::string> unexplained = broken_rules(evidence.unexplained->metrics, thresholds);
    explained = unexplained.empty();
    if (!explained) broken = std::move(unexplained);
    broken.push_back((explained ? "Without the pixels that the scene explains, every rule holds: "
                                : "The pixels that the scene explains are left out of this: ") +
                     evidence.unexplained->sentence);
  }
  // A fault is not told together with what is none.
  if (faultless || !explained) std::ranges::move(broken, std::back_inserter(verdict.reasons));
  verdict.outcome = verdict.reasons.empty()  ? Outcome::agree
                    : faultless && explained ? Outcome::explained
                                             : Outcome::differ;
  return verdict;
}

const char* name(const Verdict& verdict) { return name(verdict.outcome); }

}  // namespace tandem::compare
