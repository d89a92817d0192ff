#include "compare/verdict.hpp"

#include <doctest/doctest.h>

#include <string>

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

/// The one reason why the metrics differ.
std::string only_reason(const Metrics& metrics, const Tolerance& tolerance = {}) {
  const Verdict verdict = judge(metrics, tolerance);
  CHECK_FALSE(verdict.agree);
  REQUIRE(verdict.reasons.size() == 1);
  return verdict.reasons.front();
}

TEST_CASE("images within every tolerance agree, without reasons") {
  const Verdict verdict = judge(good_metrics());
  CHECK(verdict.agree);
  CHECK(verdict.reasons.empty());
  CHECK(std::string(name(verdict)) == "agree");
}

TEST_CASE("each rule that is broken gives its own reason, with the numbers") {
  Metrics metrics = good_metrics();
  metrics.within_1e3 = 0.9899;
  CHECK(only_reason(metrics) == "Only 98.9900 % of the pixels are within 1e-3 relative; at least 99 % must be.");

  metrics = good_metrics();
  metrics.mean_b = 0.5001;  // 2e-4 relative
  CHECK(only_reason(metrics) == "The means 0.5 and 0.5001 differ by more than 0.0001 relative.");

  metrics = good_metrics();
  metrics.non_finite_b = 1;
  CHECK(only_reason(metrics) == "Image b has 1 pixels with a NaN or an infinity; none may have.");

  CHECK(only_reason(good_metrics(), {.bit_equal = 0.95}) ==
        "Only 90.0000 % of the pixels are bit-equal; at least 95 % must be.");
}

TEST_CASE("all broken rules are named") {
  Metrics metrics = good_metrics();
  metrics.within_1e3 = 0.0;
  metrics.mean_b = 1.0;
  metrics.non_finite_a = 3;
  metrics.non_finite_b = 3;
  const Verdict verdict = judge(metrics);
  CHECK(verdict.reasons.size() == 4);
  CHECK(std::string(name(verdict)) == "differ");
}

TEST_CASE("limits are inclusive, and black images agree") {
  Metrics metrics = good_metrics();
  metrics.within_1e3 = 0.99;
  CHECK(judge(metrics).agree);
  metrics.mean_a = 0.0;
  metrics.mean_b = 0.0;
  CHECK(judge(metrics).agree);
  metrics.non_finite_a = 2;
  CHECK(judge(metrics, {.non_finite = 2}).agree);
}

}  // namespace
}  // namespace tandem::compare
