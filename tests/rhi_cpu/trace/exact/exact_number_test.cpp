// The two kinds of numbers against rational arithmetic.

#include "rhi_cpu/trace/exact/exact_number.hpp"

#include <doctest/doctest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>
#include <utility>
#include <vector>

#include "rhi_cpu/trace/exact/bounded_number.hpp"
#include "tests/rhi_cpu/trace/exact/rational_tracer.hpp"

using namespace tandem;
using namespace tandem::cpu::exact;

namespace {

/// Any finite float, all exponents alike, and often a small integer, so that terms cancel.
float random_float(std::mt19937& random) {
  if (random() % 4 == 0) return static_cast<float>(static_cast<int>(random() % 5) - 2);
  for (;;) {
    const auto value = std::bit_cast<float>(static_cast<std::uint32_t>(random()));
    if (std::isfinite(value)) return value;
  }
}

struct Polynomial {
  ExactNumber exact;
  BoundedNumber bounded;
  mpq_class rational;
};

/// A sum of up to eight products of up to `degree` floats, some of which are repeated with the other sign.
Polynomial random_polynomial(std::mt19937& random, std::uint_fast32_t degree) {
  Polynomial sum{.exact = {}, .bounded = {}, .rational = 0};
  const auto terms = 1 + random() % 8;
  for (std::uint_fast32_t i = 0; i < terms; ++i) {
    Polynomial product{.exact = {1.0}, .bounded = {1.0f}, .rational = 1};
    for (auto factors = 1 + random() % degree; factors > 0; --factors) {
      const float factor = random_float(random);
      product = {product.exact * ExactNumber(factor), product.bounded * BoundedNumber(factor),
                 product.rational * mpq_class(factor)};
    }
    sum = {sum.exact + product.exact, sum.bounded + product.bounded, sum.rational + product.rational};
    if (random() % 3 != 0) continue;
    const float shift = random_float(random);
    sum = {sum.exact - product.exact + ExactNumber(shift), sum.bounded - product.bounded + BoundedNumber(shift),
           sum.rational - product.rational + mpq_class(shift)};
  }
  return sum;
}

}  // namespace

TEST_CASE("exact numbers have the sign of the rational number") {
  std::mt19937 random(1);
  int zeros = 0;
  for (int i = 0; i < 20000; ++i) {
    const Polynomial a = random_polynomial(random, 7);
    REQUIRE(a.exact.sign() == sgn(a.rational));
    zeros += a.exact.sign() == 0;
  }
  CHECK(zeros > 100);
}

TEST_CASE("products of sums are exact") {
  std::mt19937 random(2);
  for (int i = 0; i < 20000; ++i) {
    const Polynomial a = random_polynomial(random, 3), b = random_polynomial(random, 4);
    const ExactNumber product = a.exact * b.exact;
    const mpq_class rational = a.rational * b.rational;
    REQUIRE(product.sign() == sgn(rational));
    // Equal numbers differ by zero, and nothing else does.
    REQUIRE((product - b.exact * a.exact).sign() == 0);
    REQUIRE((product - a.exact * b.exact + ExactNumber(0x1p-149)).sign() == 1);
    const ExactNumber square = (a.exact + b.exact) * ExactNumber(2.0);
    REQUIRE((square - a.exact - a.exact - b.exact - b.exact).sign() == 0);
  }
}

TEST_CASE("quotients of exact numbers are rounded to the nearest float") {
  std::mt19937 random(3);
  int finite = 0;
  for (int i = 0; i < 20000; ++i) {
    const Polynomial a = random_polynomial(random, 1 + random() % 6), b = random_polynomial(random, 1 + random() % 5);
    if (b.rational == 0) continue;
    const float expected = test::nearest_float(a.rational / b.rational);
    const auto quotient = rounded_quotient(a.exact, b.exact);
    REQUIRE(quotient.has_value());
    REQUIRE(std::bit_cast<std::uint32_t>(*quotient) == std::bit_cast<std::uint32_t>(expected));
    finite += std::isfinite(expected) && expected != 0;
  }
  CHECK(finite > 2000);
}

TEST_CASE("quotients in the middle of two floats are rounded to the even one") {
  for (const float below : {1.0f, std::nextafter(1.0f, 2.0f), 0.0f, 0x1p-149f, 0x1p-126f, 0x1.fffffep127f, 3e7f}) {
    const float above = std::nextafter(below, std::numeric_limits<float>::infinity());
    const double end = std::isinf(above) ? 0x1p128 : double{above};
    const double middle = (double{below} + end) / 2;
    const float even = (std::bit_cast<std::uint32_t>(below) & 1) == 0 ? below : above;
    const ExactNumber third(3.0);
    CHECK(*rounded_quotient(ExactNumber(middle) * third, third) == even);
    CHECK(*rounded_quotient(-ExactNumber(middle) * third, third) == -even);
    CHECK(*rounded_quotient(ExactNumber(middle) * third + ExactNumber(0x1p-700), third) == above);
    CHECK(*rounded_quotient(ExactNumber(middle) * third - ExactNumber(0x1p-700), third) == below);
  }
}

TEST_CASE("an exact number that does not fit is an error") {
  const ExactNumber large = ExactNumber(0x1p1000) + ExactNumber(0x1p-1000);
  CHECK_THROWS_AS(large * large, std::length_error);
}

TEST_CASE("bounded numbers bound, and say only what is so") {
  std::mt19937 random(4);
  int known_signs = 0, known_quotients = 0;
  const int count = 20000;
  for (int i = 0; i < count; ++i) {
    const Polynomial a = random_polynomial(random, 6), b = random_polynomial(random, 5);
    const mpq_class distance = abs(a.rational - mpq_class(a.bounded.value()));
    const bool is_within = distance <= mpq_class(a.bounded.error());
    REQUIRE(is_within);
    if (const auto sign = sign_of(a.bounded)) {
      REQUIRE(*sign == sgn(a.rational));
      ++known_signs;
    }
    if (b.rational == 0) continue;
    if (const auto quotient = rounded_quotient(a.bounded, b.bounded)) {
      const float expected = test::nearest_float(a.rational / b.rational);
      REQUIRE(std::bit_cast<std::uint32_t>(*quotient) == std::bit_cast<std::uint32_t>(expected));
      ++known_quotients;
    }
  }
  CHECK(known_signs > count / 2);
  CHECK(known_quotients > count / 2);
}
