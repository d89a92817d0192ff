#include <doctest/doctest.h>

#include <string>

#include "base/base64.hpp"

namespace {

std::string of(const std::string& text) { return tandem::base64(std::as_bytes(std::span(text))); }

TEST_CASE("base64 is that of RFC 4648") {
  // Section 10 of it.
  CHECK(of("") == "");
  CHECK(of("f") == "Zg==");
  CHECK(of("fo") == "Zm8=");
  CHECK(of("foo") == "Zm9v");
  CHECK(of("foob") == "Zm9vYg==");
  CHECK(of("fooba") == "Zm9vYmE=");
  CHECK(of("foobar") == "Zm9vYmFy");
}

TEST_CASE("base64 takes any byte") {
  CHECK(of("\xff\xfe\xfd") == "//79");
  CHECK(of("\xfb\xef") == "++8=");
  CHECK(of(std::string(3, '\0')) == "AAAA");
}

}  // namespace
