#include "compare/study/convergence.hpp"

#include <cmath>
#include <vector>

#include <doctest/doctest.h>

using namespace tandem;

TEST_CASE("The slope of convergence is found") {
  const std::vector<double> counts = {1, 4, 16, 64};
  const study::Line exact = study::convergence(counts, std::vector<double>{3, 1.5, 0.75, 0.375});
  CHECK(exact.slope == doctest::Approx(-0.5));
  CHECK(std::exp(exact.intercept) == doctest::Approx(3));
  CHECK(exact.slope_error < 1e-9);
  const study::Line rough = study::convergence(counts, std::vector<double>{3, 1.4, 0.8, 0.36});
  CHECK(rough.slope_error > 0.01);
  CHECK(std::abs(rough.slope + 0.5) < 3 * rough.slope_error);
}
