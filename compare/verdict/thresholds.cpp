#include "compare/verdict/thresholds.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <set>

#include <nlohmann/json.hpp>

#include "base/json_value.hpp"

namespace tandem::compare {
namespace {

constexpr std::array tiers = {Named<Tier>{Tier::exact, "exact"}, Named<Tier>{Tier::tolerance, "tolerance"},
                              Named<Tier>{Tier::statistical, "statistical"}};

constexpr std::array metrics = {Named<RuleMetric>{RuleMetric::within_1e3, "within_1e3"},
                                Named<RuleMetric>{RuleMetric::bit_equal, "bit_equal"},
                                Named<RuleMetric>{RuleMetric::mean_difference, "mean_difference"},
                                Named<RuleMetric>{RuleMetric::non_finite, "non_finite"},
                                Named<RuleMetric>{RuleMetric::mismatches, "mismatches"},
                                Named<RuleMetric>{RuleMetric::bias_p_value, "bias_p_value"}};

bool is_count(RuleMetric metric) { return metric == RuleMetric::non_finite || metric == RuleMetric::mismatches; }

}  // namespace

std::span<const Named<Tier>> tier_names() { return tiers; }
std::span<const Named<RuleMetric>> rule_metric_names() { return metrics; }
const char* name(Tier tier) { return name_of(tier_names(), tier); }
const char* name(RuleMetric metric) { return name_of(rule_metric_names(), metric); }

bool applies(RuleMetric metric, Tier tier) {
  if (is_count(metric)) return true;
  return tier == (metric == RuleMetric::bias_p_value ? Tier::statistical : Tier::tolerance);
}

Thresholds::Thresholds()
    : rules({{RuleMetric::within_1e3, 0.99,
              "where a ray meets an edge, or rounding flips a decision, a path takes another course; on correct "
              "backends that is far fewer than one pixel in a hundred, while a wrong normal, index or random number "
              "spoils most of them"},
             {RuleMetric::bit_equal, 0, "hardware may round division and square root differently"},
             {RuleMetric::mean_difference, 1e-4,
              "paths that took another course are noise of both signs and average out; a systematic difference does "
              "not"},
             {RuleMetric::non_finite, 0, "correct shaders produce none"},
             {RuleMetric::mismatches, 0, "a difference must be explained by rounding, or a device is wrong"},
             {RuleMetric::bias_p_value, 1e-4, "one false alarm in ten thousand comparisons"}}) {}

const Rule& Thresholds::rule(RuleMetric metric) const { return *std::ranges::find(rules, metric, &Rule::metric); }

double Thresholds::limit(RuleMetric metric) const { return rule(metric).limit; }

void Thresholds::set(Rule rule) { *std::ranges::find(rules, rule.metric, &Rule::metric) = std::move(rule); }

std::filesystem::path thresholds_file(const std::filesystem::path& scene) {
  return scene.parent_path() / (scene.stem().string() + ".thresholds.json");
}

void read_thresholds(const std::filesystem::path& file, Thresholds& thresholds) {
  using namespace json;
  const nlohmann::json document = json::parse(file);
  const Object root(Value(document, file.string(), ""), {"tier", "rules"});
  if (const auto tier = root.get("tier")) thresholds.tier = tier->choice(tier_names());
  const auto rules = root.get("rules");
  if (!rules) return;
  std::set<RuleMetric> given;
  for (const Value& value : rules->elements()) {
    const Object object(value, {"metric", "limit", "reason"});
    Rule rule;
    rule.metric = object.require("metric").choice(rule_metric_names());
    const Value limit = object.require("limit");
    if (is_count(rule.metric)) {
      rule.limit = limit.whole_number(0, UINT32_MAX);
    } else {
      rule.limit = limit.double_number(fraction);
    }
    const Value reason = object.require("reason");
    rule.reason = reason.text();
    if (rule.reason.empty()) reason.fail("must not be empty");
    if (!given.insert(rule.metric).second) value.fail("limits what another rule limits");
    thresholds.set(std::move(rule));
  }
}

Thresholds thresholds_of(const std::filesystem::path& scene, Thresholds usual) {
  const std::filesystem::path file = thresholds_file(scene);
  if (std::filesystem::exists(file)) read_thresholds(file, usual);
  return usual;
}

}  // namespace tandem::compare
