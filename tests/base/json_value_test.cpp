#include "base/json_value.hpp"

#include <doctest/doctest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "tests/support/scratch_folder.hpp"

namespace tandem::json {
namespace {

std::string error_of(std::string_view text) {
  const test::ScratchFolder folder;
  try {
    const nlohmann::json document = parse(folder.write("x.json", text));
    Object(Value(document, "x.json", ""), {"known"}).require("known").number({1, 2, false});
  } catch (const Error& error) {
    const std::string sentence = error.what();
    return sentence.substr(sentence.find("x.json"));
  }
  return "no error";
}

}  // namespace

TEST_CASE("What is no JSON is a sentence of the place, without the library's marks") {
  for (const char* text :
       {"{", "{\"known\": 1e999}", "[1, 2", "nul", "{\"a\": \"\x01\"}", "{\"a\": \"\xff\"}", "1 2"}) {
    CAPTURE(text);
    const std::string sentence = error_of(text);
    CHECK(sentence.starts_with("x.json: "));
    CHECK(sentence.find("json.exception") == std::string::npos);
  }
  CHECK(error_of("{\"known\": 1}") == "no error");
  CHECK(error_of("\xef\xbb\xbf{\"known\": 1}") == "no error");
}

TEST_CASE("A member that is there twice is an error, at any depth") {
  CHECK(error_of("{\"a\": 1, \"a\": 2}") == "x.json: an object has two members named a");
  CHECK(error_of("{\"known\": [{\"b\": {}}, {\"b\": {\"c\": 1, \"b\": 1, \"c\": 2}}]}") ==
        "x.json: an object has two members named c");
}

TEST_CASE("Values that are nested without end are refused before anything walks through them") {
  const auto nested = [](std::size_t depth) {
    return "{\"known\": " + std::string(depth, '[') + std::string(depth, ']') + "}";
  };
  CHECK(error_of(nested(255)).find("must be a number from 1 to 2") != std::string::npos);
  CHECK(error_of(nested(256)) == "x.json: values are nested deeper than 256 times");
  CHECK(error_of(nested(1000000)) == "x.json: values are nested deeper than 256 times");
}

TEST_CASE("Names from a file are escaped and cut") {
  CHECK(error_of("{\"a\\u001b[31m\": 1}") == "x.json: a\\x1b[31m is not known; known here are: known");
  CHECK(error_of("{\"" + std::string(100000, 'x') + "\": 1}").size() < 200);
  CHECK(error_of("{\"a\": \"" + std::string(100000, 'x')).size() < 300);
}

TEST_CASE("A range is given as a range") {
  CHECK(Range{-1e12, 1e12, false}.sentence() == "must be a number from -1e+12 to 1e+12");
  CHECK(Range{0, 1e12, true}.sentence() == "must be a number from 1.18e-38 to 1e+12");
  CHECK(Range{0, 1e9, false}.sentence() == "must be a number from 0 to 1e+09");
  CHECK(Range{1, 2, true}.sentence() == "must be a number above 1, at most 2");
  CHECK(Range{}.sentence() == "must be a finite number");
  CHECK(error_of("{\"known\": 3}") == "x.json: known must be a number from 1 to 2");
}

}  // namespace tandem::json
