#include "compare/verdict/verdict.hpp"

#include <doctest/doctest.h>

#include <stdexcept>
#include <string>
#include <vector>

namespace tandem::compare {
namespace {

Metrics good_metrics() {
  Metrics metrics;
  metrics.pixels = 1000;
  metrics.bit_equal = 0.9;
  metrics.within_1e5 = 0.98;
  metrics.within_1e3 = 0.995;
  metrics.mean_a = 0.5;
  metrics.mean_b = 0.50001;
  return metrics;
}

Thresholds with(Tier tier, RuleMetric metric, double limit) {
  Thresholds thresholds;
  thresholds.tier = tier;
  thresholds.set({metric, limit, "a test"});
  return thresholds;
}

Thresholds of(Tier tier) {
  Thresholds thresholds;
  thresholds.tier = tier;
  return thresholds;
}

/// The one reason why the images differ.
std::string only_reason(const Evidence& evidence, const Thresholds& thresholds = {}) {
  const Verdict verdict = make_verdict(evidence, thresholds);
  CHECK(verdict.outcome == Outcome::differ);
  REQUIRE(verdict.reasons.size() == 1);
  return verdict.reasons.front();
}

TEST_CASE("images within every tolerance agree, without reasons") {
  const Verdict verdict = make_verdict({.metrics = good_metrics()});
  CHECK(verdict.outcome == Outcome::agree);
  CHECK(verdict.reasons.empty());
  CHECK(std::string(name(verdict)) == "agree");
}

TEST_CASE("each rule that is broken gives its own reason, with the numbers") {
  Metrics metrics = good_metrics();
  metrics.within_1e3 = 0.9899;
  CHECK(only_reason({.metrics = metrics}) ==
        "Only 98.9900 % of the pixels are within 1e-3 relative; at least 99 % must be.");

  metrics = good_metrics();
  metrics.mean_b = 0.5001;  // 2e-4 relative
  CHECK(only_reason({.metrics = metrics}) == "The means 0.5 and 0.5001 differ by more than 0.0001 relative.");

  metrics = good_metrics();
  metrics.non_finite_b = 1;
  CHECK(only_reason({.metrics = metrics}) == "Image b has 1 pixels with a NaN or an infinity; the limit is 0.");

  CHECK(only_reason({.metrics = good_metrics()}, with(Tier::tolerance, RuleMetric::bit_equal, 0.95)) ==
        "Only 90.0000 % of the pixels are bit-equal; at least 95 % must be.");
}

TEST_CASE("all broken rules are named") {
  Metrics metrics = good_metrics();
  metrics.within_1e3 = 0.0;
  metrics.mean_b = 1.0;
  metrics.non_finite_a = 3;
  metrics.non_finite_b = 3;
  const Verdict verdict = make_verdict({.metrics = metrics});
  CHECK(verdict.reasons.size() == 4);
  CHECK(std::string(name(verdict)) == "differ");
}

TEST_CASE("limits are inclusive, and black images agree") {
  Metrics metrics = good_metrics();
  metrics.within_1e3 = 0.99;
  CHECK(make_verdict({.metrics = metrics}).outcome == Outcome::agree);
  metrics.mean_a = 0.0;
  metrics.mean_b = 0.0;
  CHECK(make_verdict({.metrics = metrics}).outcome == Outcome::agree);
  metrics.non_finite_a = 2;
  CHECK(make_verdict({.metrics = metrics}, with(Tier::tolerance, RuleMetric::non_finite, 2)).outcome == Outcome::agree);
}

TEST_CASE("tier exact wants every bit, whatever the limits of the tolerance") {
  Metrics metrics;
  metrics.pixels = 4'000'000;
  metrics.bit_equal = 1.0;
  const Thresholds exact = with(Tier::exact, RuleMetric::bit_equal, 0.5);
  CHECK(make_verdict({.metrics = metrics}, exact).outcome == Outcome::agree);
  CHECK(make_verdict({.metrics = metrics}, exact).tier == Tier::exact);
  metrics.bit_equal = 1.0 - 1.0 / 4'000'000;
  CHECK(only_reason({.metrics = metrics}, exact) ==
        "1 of 4000000 pixels do not have the same bits; tier exact requires all to.");
}

TEST_CASE("a path that differs without an excuse breaks every tier") {
  Metrics metrics = good_metrics();
  CHECK(only_reason({.metrics = metrics, .mismatches = 1, .bias = {}}) ==
        "1 path differs beyond what rounding explains; the limit is 0.");
  CHECK(make_verdict({.metrics = metrics, .mismatches = 0, .bias = {}}).outcome == Outcome::agree);
  CHECK(only_reason({.metrics = metrics, .probe_mismatches = 2}) ==
        "2 answers to probes differ beyond what rounding explains; the limit is 0.");
  CHECK(make_verdict({.metrics = metrics, .probe_mismatches = 0}).outcome == Outcome::agree);
  metrics.bit_equal = 1;
  CHECK(make_verdict({.metrics = metrics, .mismatches = 7, .bias = {}}, of(Tier::exact)).outcome == Outcome::differ);
  CHECK(make_verdict({.metrics = metrics, .mismatches = 7, .bias = {}}, with(Tier::exact, RuleMetric::mismatches, 7))
            .outcome == Outcome::agree);
}

TEST_CASE("what a classification explains is no fault of a device, and no agreement either") {
  Metrics metrics = good_metrics();
  metrics.within_1e3 = 0.7;
  const UnexplainedDifference unexplained{.metrics = good_metrics(), .sentence = "All 300 are ties."};
  Evidence evidence{.metrics = metrics, .mismatches = 0, .unexplained = unexplained};
  const Verdict explained = make_verdict(evidence);
  CHECK(explained.outcome == Outcome::explained);
  CHECK(std::string(name(explained)) == "explained");
  CHECK(explained.reasons ==
        std::vector<std::string>{"Only 70.0000 % of the pixels are within 1e-3 relative; at least 99 % must be.",
                                 "Without the pixels that the scene explains, every rule holds: All 300 are ties."});
  // A mismatch is told without what is no fault.
  evidence.mismatches = 1;
  CHECK(only_reason(evidence) == "1 path differs beyond what rounding explains; the limit is 0.");
  // The rest breaks a rule by itself.
  evidence.mismatches = 0;
  evidence.unexplained->metrics.within_1e3 = 0.8;
  const Verdict differ = make_verdict(evidence);
  CHECK(differ.outcome == Outcome::differ);
  CHECK(differ.reasons.front() == "Only 80.0000 % of the pixels are within 1e-3 relative; at least 99 % must be.");
  // Images that agree as a whole need no explanation.
  CHECK(make_verdict({.metrics = good_metrics(), .mismatches = 0, .unexplained = unexplained}).outcome ==
        Outcome::agree);
  // Ties are no equality of bits.
  evidence.unexplained->metrics.bit_equal = 1;
  CHECK(make_verdict(evidence, of(Tier::exact)).outcome == Outcome::explained);
  CHECK(worse(Outcome::explained, Outcome::agree) == Outcome::explained);
  CHECK(worse(Outcome::explained, Outcome::differ) == Outcome::differ);
}

TEST_CASE("tier statistical asks for p-values, not for pixels") {
  Metrics metrics = good_metrics();
  metrics.within_1e3 = metrics.bit_equal = 0;
  metrics.mean_b = 0.6;
  const auto evidence = [&](double p) { return Evidence{metrics, {}, {{"Image b is darker", p}, {"Nothing", 1.0}}}; };
  CHECK(make_verdict(evidence(1e-4), of(Tier::statistical)).outcome == Outcome::agree);
  CHECK(only_reason(evidence(2e-5), of(Tier::statistical)) ==
        "Image b is darker: the p-value is 2e-05, the minimum is 0.0001.");
  CHECK(make_verdict(evidence(2e-5), with(Tier::statistical, RuleMetric::bias_p_value, 1e-5)).outcome ==
        Outcome::agree);
  CHECK_THROWS_AS(make_verdict({.metrics = metrics}, of(Tier::statistical)), std::invalid_argument);
  metrics.non_finite_a = 1;
  CHECK(make_verdict(evidence(1.0), of(Tier::statistical)).outcome == Outcome::differ);
}

TEST_CASE("few pixels that differ by much are noise of the mean, many that differ by the same are not") {
  pathtracer::Image a{.width = 64, .height = 64, .pixels = std::vector<glm::vec3>(4096, glm::vec3(0.5F))};
  pathtracer::Image b = a;
  for (std::size_t i = 0; i < 16; ++i) b.pixels[i] = glm::vec3(5.0F);
  // 16 pixels of one sign are four standard errors, and the least that chance could not be.
  const Metrics few = measure(a, b);
  CHECK(few.mean_b > 1.01 * few.mean_a);
  CHECK(make_verdict({.metrics = few, .bias = {}}).outcome == Outcome::agree);
  for (std::size_t i = 0; i < 40; ++i) b.pixels[i] = glm::vec3(5.0F);
  CHECK(make_verdict({.metrics = measure(a, b), .bias = {}}).outcome == Outcome::differ);

  b = a;
  for (glm::vec3& pixel : b.pixels) pixel *= 1.0003F;
  const Metrics all = measure(a, b);
  CHECK(all.within_1e3 == 1.0);
  CHECK(all.mean_noise == doctest::Approx(1.5e-4 / 64).epsilon(0.01));  // rounding of 0.50015
  CHECK(make_verdict({.metrics = all, .bias = {}}).outcome == Outcome::differ);
}

}  // namespace
}  // namespace tandem::compare
