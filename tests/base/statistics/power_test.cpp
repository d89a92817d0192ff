#include "base/statistics/power.hpp"

#include <cmath>
#include <initializer_list>
#include <numbers>

#include <doctest/doctest.h>

#include "base/statistics/distributions.hpp"

namespace tandem::statistics {
namespace {

TEST_CASE("critical values are those of the tables, and invert the p-values far out") {
  // NIST/SEMATECH, Handbook of Statistical Methods, 1.3.6.7.2, to the digits printed there.
  CHECK(student_critical_value(0.05, 10) == doctest::Approx(2.228).epsilon(2e-4));
  CHECK(student_critical_value(0.05, 1) == doctest::Approx(12.706).epsilon(1e-4));
  CHECK(student_critical_value(0.002, 30) == doctest::Approx(3.385).epsilon(2e-4));
  for (const double p_value : {0.5, 1e-3, 1e-8, 1e-12})
    for (const double freedom : {3.0, 14.5, 62.0, 1000.0})
      CHECK(student_p_value(student_critical_value(p_value, freedom), freedom) ==
            doctest::Approx(p_value).epsilon(1e-6));
}

TEST_CASE("Sidak's correction is inverted") {
  for (const std::size_t count : {1U, 4U, 4096U})
    for (const double p_value : {0.5, 1e-4, 1e-9})
      CHECK(sidak(sidak_single(p_value, count), count) == doctest::Approx(p_value).epsilon(1e-9));
}

TEST_CASE("without a shift, the power is half of the p-value: one of the two sides") {
  for (const double freedom : {1.0, 4.0, 30.0})
    for (const double p_value : {0.1, 1e-2, 1e-4})
      CHECK(shift_power(0, student_critical_value(p_value, freedom), freedom) ==
            doctest::Approx(p_value / 2).epsilon(0.01));  // of the midpoint rule, far out
}

TEST_CASE("the power of t-tests is that of the tables") {
  // Two samples of n each whose means lie d standard deviations apart, level 0.05 on two sides: G*Power 3.1 (Faul et
  // al., Behavior Research Methods 39, 2007) and Cohen's tables (Statistical Power Analysis, 1988, table 2.3.5) give
  // 0.80.
  struct Case {
    double n, d, power;
  };
  for (const Case& each : {Case{17, 1.0, 0.8070}, Case{26, 0.8, 0.8075}, Case{64, 0.5, 0.8015}}) {
    const double freedom = 2 * each.n - 2;
    const double critical = student_critical_value(0.05, freedom);
    CHECK(shift_power(each.d * std::sqrt(each.n / 2), critical, freedom) == doctest::Approx(each.power).epsilon(2e-4));
  }
  // With a known error the distribution is normal, of which 90 % lie below 1.2816.
  CHECK(detectable_shift(0.9, 3.0, 1e6) == doctest::Approx(3.0 + 1.2816).epsilon(1e-4));
}

TEST_CASE("a detectable shift is found with its probability") {
  for (const double freedom : {3.0, 14.0, 62.0})
    for (const double probability : {0.1, 0.5, 0.9, 0.99}) {
      const double critical = student_critical_value(1e-6, freedom);
      CHECK(shift_power(detectable_shift(probability, critical, freedom), critical, freedom) ==
            doctest::Approx(probability).epsilon(1e-9));
    }
}

}  // namespace
}  // namespace tandem::statistics
