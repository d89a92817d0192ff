#include "program/compare/comparison.hpp"

#include <doctest/doctest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "program/data/fill.hpp"

using namespace tandem::program;

namespace {

Comparison compared(const ValueType& type, std::size_t bytes, const std::vector<std::string>& a,
                    const std::vector<std::string>& b, const Tolerance& tolerance = {}) {
  std::vector<std::byte> first(bytes), second(bytes);
  fill_values(first, type, a);
  fill_values(second, type, b);
  return compare(type, first, second, tolerance);
}

const ValueType floats = make_array(make_type(ScalarType::float32), 0);
const ValueType vectors = make_array(make_type(ScalarType::float32, 3), 0, 16);

TEST_CASE("equal values agree") {
  const Comparison same = compared(floats, 12, {"1", "nan", "3"}, {"1", "nan", "3"});
  CHECK(same.agrees());
  CHECK(same.scalars == 3);
  CHECK(same.bit_equal == 3);
  CHECK_FALSE(same.first.has_value());
}

TEST_CASE("the first and the worst difference have names, and bytes between scalars do not count") {
  std::vector<std::byte> a(48), b(48);
  fill_iota(a, vectors);
  b = a;
  b[12] = std::byte{1};  // behind the first vector
  CHECK(compare(vectors, a, b, {}).agrees());
  const std::vector<std::string> changed = {"0", "1", "2", "3", "4.0000005", "5", "6", "7", "9"};
  fill_values(b, vectors, changed);
  const Comparison far = compare(vectors, a, b, {});
  CHECK(far.scalars == 9);
  CHECK(far.bit_equal == 7);
  CHECK_FALSE(far.agrees());
  REQUIRE((far.first && far.worst && far.disagreed));
  CHECK(far.first->path == "[1].y");
  CHECK(far.first->ulp == 1);
  CHECK(far.first->a == "4");
  CHECK(far.first->b == "4.0000005");
  CHECK(far.worst->path == "[2].z");
  CHECK(far.worst->index == 8);
  CHECK(far.largest_absolute == 1.0);
  CHECK(far.largest_relative == doctest::Approx(1.0 / 9));
  CHECK(far.disagreed->path == "[1].y");
  const Comparison tolerant = compare(vectors, a, b, {.ulp = 1});
  CHECK(tolerant.within == 8);
  CHECK(tolerant.disagreed->path == "[2].z");
}

TEST_CASE("either limit of the tolerance is enough") {
  CHECK(compared(floats, 4, {"1"}, {"1.0000001"}, {.ulp = 1}).agrees());
  CHECK_FALSE(compared(floats, 4, {"1"}, {"1.0000002"}, {.ulp = 1}).agrees());
  CHECK(compared(floats, 4, {"1"}, {"1.09"}, {.relative = 0.1}).agrees());
  CHECK_FALSE(compared(floats, 4, {"1"}, {"1.2"}, {.relative = 0.1}).agrees());
  CHECK_FALSE(compared(floats, 4, {"0"}, {"1e-30"}, {.relative = 0.1}).agrees());
  const ValueType words = make_array(make_type(ScalarType::int32), 0);
  CHECK(compared(words, 4, {"-1"}, {"1"}, {.ulp = 2}).agrees());
  CHECK_FALSE(compared(words, 4, {"-1"}, {"2"}, {.ulp = 2}).agrees());
}

TEST_CASE("zeros agree within no units, NaN with NaN alone, infinities with themselves alone") {
  const Comparison zeros = compared(floats, 4, {"0"}, {"-0"});
  CHECK(zeros.bit_equal == 0);
  CHECK(zeros.agrees());
  CHECK(compared(floats, 4, {"nan"}, {"0x7fc00001"}).agrees());
  const Comparison nan = compared(floats, 12, {"nan", "1", "nan"}, {"1", "nan", "2"}, {.ulp = 1000, .relative = 10});
  CHECK(nan.within == 0);
  CHECK(nan.nan_a == 2);
  CHECK(nan.nan_b == 1);
  CHECK(std::isinf(nan.worst->relative));
  CHECK_FALSE(compared(floats, 4, {"inf"}, {"-inf"}, {.relative = 1}).agrees());
  CHECK_FALSE(compared(floats, 4, {"inf"}, {"1"}, {.relative = 1}).agrees());
}

TEST_CASE("distances are counted in the numbers of the type") {
  CHECK(ulp_distance(ScalarType::float32, 0x80000001, 0x00000001) == 2);
  CHECK(ulp_distance(ScalarType::float16, 0x3c00, 0x3c02) == 2);
  CHECK(ulp_distance(ScalarType::float64, std::bit_cast<std::uint64_t>(1.0), std::bit_cast<std::uint64_t>(-1.0)) ==
        2 * std::bit_cast<std::uint64_t>(1.0));
  CHECK(ulp_distance(ScalarType::int8, 0x80, 0x7f) == 255);
  CHECK(ulp_distance(ScalarType::uint64, 0, ~std::uint64_t{0}) == ~std::uint64_t{0});
  CHECK(ulp_distance(ScalarType::float32, 0x7fc00000, 0) == std::numeric_limits<std::uint64_t>::max());
}

}  // namespace
