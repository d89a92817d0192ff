#include "program/data/table.hpp"

#include <doctest/doctest.h>

#include <string>
#include <vector>

#include "program/data/fill.hpp"
#include "tests/support/scratch_folder.hpp"

using namespace tandem;
using namespace tandem::program;

namespace {

/// struct Item { vec2 at; uint id; }
ValueType item() {
  return {.kind = ValueType::Kind::structure,
          .size = 16,
          .members = {{"at", 0, make_type(ScalarType::float32, 2)}, {"id", 8, make_type(ScalarType::uint32)}}};
}

std::vector<std::byte> counted(const ValueType& type, std::size_t bytes) {
  std::vector<std::byte> result(bytes);
  fill_iota(result, type);
  return result;
}

TEST_CASE("an array is a line for each element, any other value a line for each scalar") {
  const ValueType items = make_array(item(), 0);
  CHECK(to_csv(items, counted(items, 32)) == "at.x,at.y,id\n0,1,2\n3,4,5\n");
  CHECK(to_csv(item(), counted(item(), 16)) == "name,value\nat.x,0\nat.y,1\nid,2\n");
  const ValueType vectors = make_array(make_type(ScalarType::float32, 2), 2),
                  words = make_array(make_type(ScalarType::uint32), 0);
  CHECK(to_csv(vectors, counted(vectors, 16)) == "x,y\n0,1\n2,3\n");
  CHECK(to_csv(words, counted(words, 12)) == "value\n0\n1\n2\n");
}

TEST_CASE("columns are aligned, and end after as many lines as are asked for") {
  const ValueType items = make_array(item(), 0);
  CHECK(to_columns(items, counted(items, 64), 2) ==
        "       at.x  at.y  id\n  [0]     0     1   2\n  [1]     3     4   5\n");
  CHECK(to_columns(item(), counted(item(), 16), 100) == "  name  value\n  at.x      0\n  at.y      1\n  id        2\n");
}

TEST_CASE("tables that were written are read, and so is plain text") {
  const test::ScratchFolder folder;
  const ValueType items = make_array(item(), 0);
  const std::vector<std::string> six = {"0", "1", "2", "3", "4", "5"};
  CHECK(read_table(folder.write("array.csv", to_csv(items, counted(items, 32)))) == six);
  CHECK(read_table(folder.write("value.csv", to_csv(item(), counted(item(), 16)))) ==
        std::vector<std::string>{"0", "1", "2"});
  CHECK(read_table(folder.write("text.txt", "0 1,2\r\n\n3;4\t5")) == six);
  CHECK(read_table(folder.write("signs.txt", "-inf +1 .5")) == std::vector<std::string>{"-inf", "+1", ".5"});
}

}  // namespace
