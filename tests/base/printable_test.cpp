#include "base/printable.hpp"

#include <doctest/doctest.h>

#include <string>

using namespace tandem;
using namespace std::string_literals;

TEST_CASE("Control characters are written as escapes, letters of all scripts as they are") {
  CHECK(printable("") == "");
  CHECK(printable("plain 'text' \\ 100 %") == "plain 'text' \\ 100 %");
  CHECK(printable("Grün 木 🌳") == "Grün 木 🌳");
  CHECK(printable("a\nb\tc\rd\x1b[31m\a\0\x7f"s) == "a\\nb\\tc\\rd\\x1b[31m\\x07\\x00\\x7f");
  CHECK(printable("a\nb\x1b\n", "\n") == "a\nb\\x1b\n");
  // NEL of C1, an override of the direction, a separator of lines
  CHECK(printable("\u0085 \u202e \u2028") == "\\x85 \\u202e \\u2028");
}

TEST_CASE("What is no UTF-8 is written byte by byte") {
  CHECK(printable("\xff a \xc3") == "\\xff a \\xc3");
  CHECK(printable("\xc0\xaf \xed\xa0\x80 \xf4\x90\x80\x80") == "\\xc0\\xaf \\xed\\xa0\\x80 \\xf4\\x90\\x80\\x80");
  CHECK(printable("Gr\xfcn") == "Gr\\xfcn");
}

TEST_CASE("Of a long name the beginning and the end are shown") {
  CHECK(shortened("name") == "name");
  CHECK(shortened("a\nb") == "a\\nb");
  CHECK(shortened(std::string(100, 'x')) == std::string(100, 'x'));
  CHECK(shortened("begin" + std::string(1000000, 'x') + "end", 20) == "beginxxxxx...xxend");
  // Characters are not cut.
  std::string trees;
  for (int i = 0; i < 1000; ++i) trees += "木";
  const std::string cut = shortened(trees, 20);
  CHECK(cut == "木木木...木");
}
