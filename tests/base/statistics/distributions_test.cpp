#include "base/statistics/distributions.hpp"

#include <cmath>
#include <initializer_list>
#include <numbers>

#include <doctest/doctest.h>

namespace tandem::statistics {
namespace {

TEST_CASE("Incomplete gamma and beta functions have their closed forms") {
  for (const double x : {0.01, 0.5, 1.0, 2.0, 7.5, 30.0, 300.0}) {
    CHECK(regularised_upper_gamma(1.0, x) == doctest::Approx(std::exp(-x)).epsilon(1e-10));
    CHECK(regularised_upper_gamma(0.5, x) == doctest::Approx(std::erfc(std::sqrt(x))).epsilon(1e-10));
    CHECK(regularised_upper_gamma(3.0, x) == doctest::Approx(std::exp(-x) * (1.0 + x + 0.5 * x * x)).epsilon(1e-10));
  }
  CHECK(regularised_upper_gamma(2.0, 0.0) == 1.0);
  for (const double x : {0.0, 0.1, 0.3, 0.5, 0.9, 0.999, 1.0}) {
    CHECK(regularised_beta(1.0, 1.0, x) == doctest::Approx(x).epsilon(1e-10));
    CHECK(regularised_beta(3.0, 1.0, x) == doctest::Approx(x * x * x).epsilon(1e-10));
    CHECK(regularised_beta(0.5, 0.5, x) ==
          doctest::Approx(2.0 / std::numbers::pi * std::asin(std::sqrt(x))).epsilon(1e-10));
  }
}

TEST_CASE("p-values are those of the tables") {
  // Quantiles of NIST/SEMATECH, Handbook of Statistical Methods, 1.3.6.7, to the digits printed there.
  CHECK(chi_square_p_value(18.307, 10) == doctest::Approx(0.05).epsilon(1e-4));
  CHECK(chi_square_p_value(149.449, 100) == doctest::Approx(0.001).epsilon(1e-4));
  CHECK(normal_p_value(-1.959964) == doctest::Approx(0.05).epsilon(1e-5));
  CHECK(student_p_value(2.228139, 10) == doctest::Approx(0.05).epsilon(1e-5));
  CHECK(student_p_value(-12.7062, 1) == doctest::Approx(0.05).epsilon(1e-5));
  CHECK(sidak(0.5, 2) == doctest::Approx(0.75));
  CHECK(sidak(1e-12, 1000) == doctest::Approx(1e-9));
  CHECK(sidak(1.0, 3) == 1.0);
}

}  // namespace
}  // namespace tandem::statistics
