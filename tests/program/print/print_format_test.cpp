#include "program/print/print_format.hpp"

#include <doctest/doctest.h>

#include <bit>
#include <cstdint>
#include <string>
#include <vector>

#include "base/error.hpp"

using namespace tandem;
using namespace tandem::program;

namespace {

using Arguments = std::vector<std::vector<Component>>;

std::vector<Component> vector_of(ComponentKind kind, std::uint32_t width, std::uint32_t size) {
  std::vector<Component> components;
  for (std::uint32_t i = 0; i < size; ++i)
    components.push_back({.path = size == 1 ? std::vector<std::uint32_t>{} : std::vector<std::uint32_t>{i},
                          .kind = kind,
                          .width = width,
                          .word = i * (width == 64 ? 2 : 1)});
  return components;
}

const std::vector<Component> a_float = vector_of(ComponentKind::floating, 32, 1);
const std::vector<Component> a_uint = vector_of(ComponentKind::unsigned_integer, 32, 1);
const std::vector<Component> an_int = vector_of(ComponentKind::signed_integer, 32, 1);

std::uint32_t word(float value) { return std::bit_cast<std::uint32_t>(value); }

std::string print(const std::string& text, const Arguments& arguments, const std::vector<std::uint32_t>& words) {
  const PrintFormat format = parse_print_format(text);
  check_arguments(format, arguments);
  return print_text(format, arguments, words);
}

/// What is wrong with the format.
std::string fault(const std::string& text, const Arguments& arguments) {
  try {
    check_arguments(parse_print_format(text), arguments);
  } catch (const Error& error) {
    return error.what();
  }
  return "nothing";
}

}  // namespace

// The texts are those of C's printf for the same values.
TEST_CASE("debugPrintfEXT's conversions print what printf prints") {
  CHECK(print("no conversion, 100%%", {}, {}) == "no conversion, 100%");
  CHECK(print("%d %i|%u", {an_int, an_int, an_int}, {~0u, 7, ~0u}) == "-1 7|4294967295");
  CHECK(print("%d", {a_uint}, {~0u}) == "-1");
  CHECK(print("%x %X %o %#x %08x", {a_uint, a_uint, a_uint, a_uint, a_uint}, {255, 255, 8, 255, 255}) ==
        "ff FF 10 0xff 000000ff");
  CHECK(print("%f %.1f %8.3f|%-8.2f|%+g", {a_float, a_float, a_float, a_float, a_float},
              {word(1.5f), word(-0.25f), word(3.14159f), word(2), word(10)}) == "1.500000 -0.2    3.142|2.00    |+10");
  CHECK(print("%e %G %a", {a_float, a_float, a_float}, {word(1500), word(1e-10f), word(0.5f)}) ==
        "1.500000e+03 1E-10 0x1p-1");
  CHECK(print("%f", {a_float}, {word(std::bit_cast<float>(0x7f800000))}) == "inf");
}

TEST_CASE("debugPrintfEXT prints vectors, 64 bits, small integers and booleans") {
  const auto vec3 = vector_of(ComponentKind::floating, 32, 3);
  CHECK(print("<%v3f>", {vec3}, {word(1), word(2.5f), word(-3)}) == "<1.000000, 2.500000, -3.000000>");
  CHECK(print("%.1v3f %u", {vec3, a_uint}, {word(1), word(2.5f), word(-3), 9}) == "1.0, 2.5, -3.0 9");
  CHECK(print("%v2d", {vector_of(ComponentKind::signed_integer, 32, 2)}, {1, ~1u}) == "1, -2");
  const auto large = vector_of(ComponentKind::unsigned_integer, 64, 1);
  CHECK(print("%lu %ul %lx %ld", {large, large, large, large}, {1, 1, 0, 2, 0xf, 1, ~0u, ~0u}) ==
        "4294967297 8589934592 10000000f -1");
  CHECK(print("%v2lu", {vector_of(ComponentKind::unsigned_integer, 64, 2)}, {1, 0, 0, 1}) == "1, 4294967296");
  const std::uint64_t bits = std::bit_cast<std::uint64_t>(0.1);
  CHECK(print("%.17g", {vector_of(ComponentKind::floating, 64, 1)},
              {static_cast<std::uint32_t>(bits), static_cast<std::uint32_t>(bits >> 32)}) == "0.10000000000000001");
  CHECK(print("%d %u",
              {vector_of(ComponentKind::signed_integer, 16, 1), vector_of(ComponentKind::signed_integer, 16, 1)},
              {0xffff, 0xffff}) == "-1 65535");
  CHECK(print("%d", {vector_of(ComponentKind::boolean, 32, 1)}, {1}) == "1");
  // "If the format is exhausted while arguments remain, the excess arguments are ignored": NonSemantic.DebugPrintf.
  CHECK(print("%u", {a_uint, a_float}, {3, word(1)}) == "3");
}

TEST_CASE("a format that is wrong, or that its arguments do not fit, is refused with what is wrong") {
  CHECK(fault("%s", {a_uint}).starts_with("'%s' is no conversion of debugPrintfEXT"));
  CHECK(fault("%lf", {a_float}).starts_with("'%lf' is no conversion of debugPrintfEXT"));
  CHECK(fault("x %", {}) == "'%' has no letter that says what is printed");
  CHECK(fault("%v5f", {a_float}) == "'%v' is no vector of 2, 3 or 4 components, as in %v3f");
  CHECK(fault("%1000d", {a_uint}) == "'%1000' has a width or a precision of more than three digits");
  CHECK(fault("%d %u", {an_int}) == "'%u' has no argument: 1 follow the format, which has 2 conversions");
  CHECK(fault("%d", {a_float}) == "'%d' is given a float");
  CHECK(fault("%f", {a_uint}) == "'%f' is given a whole number");
  CHECK(fault("%f", {vector_of(ComponentKind::floating, 32, 3)}) == "'%f' is given a vector of 3 floats");
  CHECK(fault("%v2f", {vector_of(ComponentKind::floating, 32, 3)}) == "'%v2f' is given a vector of 3 floats");
}
