#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "pathtracer/scene/settings.hpp"

/// How far two images may be apart: the limits that a verdict holds them to, and the small file in which a scene keeps
/// limits of its own.
namespace tandem::compare {

/// How alike two images must be.
enum class Tier {
  exact,       ///< to the last bit
  tolerance,   ///< the same picture, but for rounding and for the few paths that it sends elsewhere
  statistical  ///< estimates of the same picture with other noise
};
std::span<const Named<Tier>> tier_names();
const char* name(Tier tier);

/// What a rule limits.
enum class RuleMetric {
  within_1e3,       ///< least fraction of pixels within 1e-3 relative; tier tolerance
  bit_equal,        ///< least fraction of bit-equal pixels; tier tolerance (tier exact asks for all of them)
  mean_difference,  ///< largest |mean_a - mean_b| / max(|mean_a|, |mean_b|); tier tolerance
  non_finite,       ///< most pixels of either image with a NaN or an infinity; every tier
  mismatches,   ///< maximum of paths, and of answers to probes, that differ beyond what rounding explains; every tier
  bias_p_value  ///< least p-value of a test for bias, which is the rate of its false alarms; tier statistical
};
std::span<const Named<RuleMetric>> rule_metric_names();
const char* name(RuleMetric metric);
/// Whether a verdict of that tier asks for the metric.
bool applies(RuleMetric metric, Tier tier);

struct Rule {
  RuleMetric metric = RuleMetric::within_1e3;
  double limit = 0;
  std::string reason;  ///< why this limit and no other
};

/// A tier and one rule for each metric, in the order of RuleMetric. Rules that the tier does not ask for are kept for
/// when it is changed.
struct Thresholds {
  Thresholds();  ///< the defaults, for one shader, seed and scene on two backends that round alike up to a few ULP

  double limit(RuleMetric metric) const;
  const Rule& rule(RuleMetric metric) const;
  void set(Rule rule);  ///< in the place of the one for its metric

  Tier tier = Tier::tolerance;
  std::vector<Rule> rules;
};

/// `<folder>/<stem>.thresholds.json` for `<folder>/<stem>.<anything>`.
std::filesystem::path thresholds_file(const std::filesystem::path& scene);

/// Reads a file of thresholds over others: {"tier": "tolerance", "rules": [{"metric", "limit", "reason"}, ...]}, where
/// tier and rules may be absent. Throws Error, naming file and place, for what it does not know, for a
/// limit out of range, for a rule without a reason, and for two rules with one metric.
void read_thresholds(const std::filesystem::path& file, Thresholds& thresholds);

/// The thresholds of a scene: `usual`, changed by the file beside it, if there is one.
Thresholds thresholds_of(const std::filesystem::path& scene, Thresholds usual = {});

}  // namespace tandem::compare
