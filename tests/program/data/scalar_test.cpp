#include "program/data/scalar.hpp"

#include <doctest/doctest.h>

#include <array>
#include <bit>
#include <cmath>
#include <limits>

#include "base/error.hpp"

using namespace tandem;
using namespace tandem::program;

namespace {

TEST_CASE("texts become the bits of every type, and come back") {
  struct Case {
    ScalarType scalar;
    const char* text;
    std::uint64_t bits;
  };
  for (const Case& each :
       {Case{ScalarType::int8, "-128", 0x80}, Case{ScalarType::uint8, "255", 0xff},
        Case{ScalarType::float16, "-1.5", 0xbe00}, Case{ScalarType::int16, "-2", 0xfffe},
        Case{ScalarType::uint16, "65535", 0xffff}, Case{ScalarType::float32, "0.1", 0x3dcccccd},
        Case{ScalarType::float32, "-inf", 0xff800000}, Case{ScalarType::float32, "-0", 0x80000000},
        Case{ScalarType::int32, "-2147483648", 0x80000000}, Case{ScalarType::uint32, "4294967295", 0xffffffff},
        Case{ScalarType::float64, "0.1", 0x3fb999999999999a}, Case{ScalarType::int64, "-1", ~std::uint64_t{0}},
        Case{ScalarType::uint64, "18446744073709551615", ~std::uint64_t{0}}}) {
    CAPTURE(each.text);
    CHECK(from_text(each.scalar, each.text) == each.bits);
    if (std::string_view(each.text) != "-0") CHECK(to_text(each.scalar, each.bits) == each.text);
  }
  CHECK(to_text(ScalarType::float32, 0x80000000) == "-0");
  CHECK(from_text(ScalarType::float32, "0x3f800000") == 0x3f800000);
  CHECK(from_text(ScalarType::float32, "+1") == 0x3f800000);
  CHECK(std::isnan(number_of(ScalarType::float16, from_text(ScalarType::float16, "nan"))));
  CHECK(to_text(ScalarType::float32, 0x7fc00000) == "nan");
}

TEST_CASE("texts that are no number of the type are refused") {
  const auto refused = [](ScalarType scalar, const char* text) {
    CAPTURE(text);
    CHECK_THROWS_AS(from_text(scalar, text), Error);
  };
  refused(ScalarType::uint8, "256");
  refused(ScalarType::uint8, "-1");
  refused(ScalarType::int8, "128");
  refused(ScalarType::uint32, "1.5");
  refused(ScalarType::uint16, "0x10000");
  refused(ScalarType::float32, "one");
  refused(ScalarType::float32, "1x");
  refused(ScalarType::float64, "");
  CHECK_THROWS_WITH_AS(from_text(ScalarType::uint8, "256"), "'256' is no uint8", Error);
}

TEST_CASE("numbers beyond a type become its nearest, and whole numbers wrap around") {
  CHECK(bits_of_number(ScalarType::uint8, 300) == 255);
  CHECK(bits_of_number(ScalarType::uint8, -3) == 0);
  CHECK(bits_of_number(ScalarType::int8, -300) == 0x80);
  CHECK(bits_of_number(ScalarType::int8, 300) == 0x7f);
  CHECK(bits_of_number(ScalarType::int32, -7.9) == 0xfffffff9);
  CHECK(bits_of_number(ScalarType::uint64, 1e30) == std::numeric_limits<std::uint64_t>::max());
  CHECK(bits_of_number(ScalarType::int64, 1e30) == std::numeric_limits<std::int64_t>::max());
  CHECK(bits_of_number(ScalarType::uint32, NAN) == 0);
  CHECK(bits_of_whole(ScalarType::uint8, 257) == 1);
  CHECK(bits_of_whole(ScalarType::float32, 3) == std::bit_cast<std::uint32_t>(3.0f));
}

TEST_CASE("bits are read and written at a place alone") {
  std::array<std::byte, 8> bytes{};
  set_bits(bytes, {.offset = 2, .scalar = ScalarType::uint16}, 0xabcd);
  CHECK(bits_at(bytes, {.offset = 0, .scalar = ScalarType::uint32}) == 0xabcd0000);
  CHECK(bits_at(bytes, {.offset = 3, .scalar = ScalarType::uint8}) == 0xab);
  CHECK(bits_at(bytes, {.offset = 4, .scalar = ScalarType::uint32}) == 0);
}

}  // namespace
