#include "tools/options/threshold_options.hpp"

#include <limits>

#include <fmt/format.h>

#include "base/error.hpp"
#include "tools/options/option_values.hpp"

namespace tandem::tools {
namespace {

constexpr const char* within_1e3 = "--min-within-1e3";
constexpr const char* bit_equal = "--min-bit-equal";
constexpr const char* mean_difference = "--max-mean-difference";
constexpr const char* non_finite = "--max-non-finite";
constexpr const char* bias_p_value = "--min-p-value";

}  // namespace

void add_threshold_options(CLI::App& command, ThresholdOptions& options) {
  CLI::App& group =
      *command.add_option_group("Verdict (defaults: SCENE.thresholds.json, or else the value in brackets)");
  add_named(group, "--tier", options.tier, compare::tier_names(),
            "exact: every bit equal; tolerance: equal up to rounding; statistical: equal up to noise [tolerance]");
  add_number(group, within_1e3, options.within_1e3, 0.0, 1.0,
             "Minimum fraction of pixels within a relative difference of 1e-3 [0.99]");
  add_number(group, bit_equal, options.bit_equal, 0.0, 1.0, "Minimum fraction of bit-equal pixels [0]");
  add_number(group, mean_difference, options.mean_difference, 0.0, 1.0,
             "Maximum relative difference of the image means [1e-4]");
  add_whole_number(group, non_finite, options.non_finite, 0, std::numeric_limits<std::uint32_t>::max(),
                   "Maximum number of pixels of an image with a NaN or an infinity [0]");
  add_number(group, bias_p_value, options.bias_p_value, 0.0, 1.0,
             "Tier statistical: minimum p-value, which is also the rate of false alarms [1e-4]");
}

void apply(const ThresholdOptions& options, compare::Thresholds& thresholds) {
  using compare::RuleMetric;
  thresholds.tier = options.tier.value_or(thresholds.tier);
  const auto set = [&](const char* option, RuleMetric metric, const auto& limit) {
    if (!limit) return;
    if (!compare::applies(metric, thresholds.tier))
      throw Error(fmt::format("{} has no meaning in tier {}", option, compare::name(thresholds.tier)));
    thresholds.set({metric, static_cast<double>(*limit), fmt::format("given by {}", option)});
  };
  set(within_1e3, RuleMetric::within_1e3, options.within_1e3);
  set(bit_equal, RuleMetric::bit_equal, options.bit_equal);
  set(mean_difference, RuleMetric::mean_difference, options.mean_difference);
  set(non_finite, RuleMetric::non_finite, options.non_finite);
  set(bias_p_value, RuleMetric::bias_p_value, options.bias_p_value);
}

}  // namespace tandem::tools
