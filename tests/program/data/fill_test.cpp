#include "program/data/fill.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "program/data/scalar.hpp"

using namespace tandem;
using namespace tandem::program;

namespace {

/// struct { uint count; vec2 values[]; }, the elements 16 bytes apart
ValueType block() {
  return {.kind = ValueType::Kind::structure,
          .size = 16,
          .members = {{"count", 0, make_type(ScalarType::uint32)},
                      {"values", 16, make_array(make_type(ScalarType::float32, 2), 0, 16)}}};
}

std::vector<std::string> texts_of(const ValueType& type, const std::vector<std::byte>& bytes) {
  std::vector<std::string> texts;
  for_each_place(type, bytes.size(),
                 [&](const Place& place) { texts.push_back(to_text(place.scalar, bits_at(bytes, place))); });
  return texts;
}

TEST_CASE("a type has a size for so many elements, and elements for so many scalars") {
  CHECK(size_with(block(), 3) == 64);
  CHECK(size_with(block(), 0) == 16);
  CHECK(size_with(make_type(ScalarType::float32, 3), 5) == 12);
  CHECK(size_with(make_array(make_type(ScalarType::uint32), 0), 0) == 1);
  CHECK(elements_for(block(), 1) == 0);
  CHECK(elements_for(block(), 2) == 1);
  CHECK(elements_for(block(), 5) == 2);
  CHECK(elements_for(make_type(ScalarType::float32, 3), 7) == 0);
}

TEST_CASE("iota counts scalars, each in its own type, and leaves the bytes between them") {
  std::vector<std::byte> bytes(48, std::byte{0xff});
  fill_iota(bytes, block());
  CHECK(texts_of(block(), bytes) == std::vector<std::string>{"0", "1", "2", "3", "4"});
  CHECK(bytes[24] == std::byte{0xff});
}

TEST_CASE("random numbers depend on the seed alone, and lie in their range") {
  const ValueType words = make_array(make_type(ScalarType::uint32), 0),
                  floats = make_array(make_type(ScalarType::float32), 0);
  std::vector<std::byte> first(4000), again(4000), other(4000);
  fill_random(first, words, 7, 0, 9);
  fill_random(again, words, 7, 0, 9);
  fill_random(other, words, 8, 0, 9);
  CHECK(first == again);
  CHECK(first != other);
  const std::vector<std::string> texts = texts_of(words, first);
  CHECK(std::set<std::string>(texts.begin(), texts.end()).size() == 10);
  fill_random(first, floats, 1, -1, 1);
  double sum = 0;
  for_each_place(floats, first.size(), [&](const Place& place) {
    const double value = number_of(place.scalar, bits_at(first, place));
    CHECK((value >= -1 && value < 1));
    sum += value;
  });
  CHECK(std::abs(sum) < 60);
}

TEST_CASE("texts become scalars in their order, and what they are not is refused by name") {
  std::vector<std::byte> bytes(48);
  fill_values(bytes, block(), std::vector<std::string>{"7", "1.5", "2"});
  CHECK(texts_of(block(), bytes) == std::vector<std::string>{"7", "1.5", "2", "0", "0"});
  CHECK_THROWS_WITH_AS(fill_values(bytes, block(), std::vector<std::string>{"7", "1.5", "x"}),
                       "values[0].y: 'x' is no float32", Error);
  CHECK_THROWS_WITH_AS(fill_values(bytes, block(), std::vector<std::string>(6, "1")),
                       "6 values are given, where struct holds 5", Error);
}

TEST_CASE("texts become a part of a value, by its name") {
  std::vector<std::byte> bytes(48);
  fill_part(bytes, block(), "values[1]", std::vector<std::string>{"3", "4"});
  fill_part(bytes, block(), "values[0].y", std::vector<std::string>{"2"});
  fill_part(bytes, block(), "count", std::vector<std::string>{"9"});
  CHECK(texts_of(block(), bytes) == std::vector<std::string>{"9", "0", "2", "3", "4"});
  CHECK_THROWS_WITH_AS(fill_part(bytes, block(), "coun", std::vector<std::string>{"1"}),
                       "'coun' is not the name of a value; the names are count, values[0].x, values[0].y, "
                       "values[1].x, values[1].y",
                       Error);
  CHECK_THROWS_WITH_AS(fill_part(bytes, block(), "values[1]", std::vector<std::string>(3, "1")),
                       "3 values are given, where values[1] holds 2", Error);
  CHECK_THROWS_WITH_AS(fill_part(bytes, block(), "count", std::vector<std::string>{"-1"}), "count: '-1' is no uint32",
                       Error);
}

}  // namespace
