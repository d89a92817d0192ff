#include "program/data/npy.hpp"

#include <doctest/doctest.h>

#include <cstring>
#include <fstream>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "program/data/fill.hpp"
#include "program/data/scalar.hpp"
#include "tests/support/scratch_folder.hpp"

using namespace tandem;
using namespace tandem::program;

namespace {

std::string text_of(const std::vector<std::byte>& bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// What numpy.save writes: the header padded to 64 bytes.
std::string numpy_file(std::string header, const std::string& data) {
  header.resize(64 - 10 - 1 + 64, ' ');
  header += '\n';
  return std::string("\x93NUMPY\1\0", 8) + static_cast<char>(header.size()) + '\0' + header + data;
}

TEST_CASE("an array is written as NumPy writes it") {
  const ValueType vectors = make_array(make_type(ScalarType::float32, 3), 0, 16);
  std::vector<std::byte> bytes(32);
  fill_iota(bytes, vectors);
  const NpyArray array = npy_of(vectors, bytes);
  CHECK(array.shape == std::vector<std::uint64_t>{2, 3});
  const float values[] = {0, 1, 2, 3, 4, 5};
  const std::string data(reinterpret_cast<const char*>(values), sizeof(values));
  CHECK(text_of(to_npy(array)) == numpy_file("{'descr': '<f4', 'fortran_order': False, 'shape': (2, 3), }", data));
  const ValueType small = make_array(make_type(ScalarType::uint8), 0);
  CHECK(text_of(to_npy(npy_of(small, std::vector<std::byte>(3)))) ==
        numpy_file("{'descr': '|u1', 'fortran_order': False, 'shape': (3,), }", std::string(3, '\0')));
}

TEST_CASE("an array is read into scalars, whatever lies between them") {
  const test::ScratchFolder folder;
  const std::int16_t values[] = {-1, 2, 3};
  const std::string data(reinterpret_cast<const char*>(values), sizeof(values));
  const auto path =
      folder.write("a.npy", numpy_file("{'descr': '<i2', 'fortran_order': False, 'shape': (3,), }", data));
  const NpyArray array = read_npy(path);
  CHECK(array.scalar == ScalarType::int16);
  CHECK(array.shape == std::vector<std::uint64_t>{3});
  const ValueType apart = make_array(make_type(ScalarType::int16), 0, 8);
  std::vector<std::byte> bytes(32);
  fill_from(bytes, apart, array);
  CHECK(bits_at(bytes, {.offset = 0, .scalar = ScalarType::uint64}) == 0xffff);
  CHECK(bits_at(bytes, {.offset = 16, .scalar = ScalarType::uint64}) == 3);
  CHECK_THROWS_WITH_AS(fill_from(bytes, make_array(make_type(ScalarType::float32), 0), array),
                       "the array holds int16, where the shader has float32", Error);
  std::vector<std::byte> few(16);
  CHECK_THROWS_WITH_AS(fill_from(few, apart, array), "3 values are given, where int16_t[] holds 2", Error);
}

TEST_CASE("files that are no arrays of a shader's numbers are refused by name") {
  const test::ScratchFolder folder;
  const auto refusal = [&](const std::string& text) -> std::string {
    try {
      read_npy(folder.write("bad.npy", text));
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  CHECK(refusal("no array").ends_with("bad.npy': it is no .npy file"));
  CHECK(refusal(numpy_file("{'descr': '>f4', 'fortran_order': False, 'shape': (1,), }", "1234"))
            .ends_with("it is big-endian"));
  CHECK(refusal(numpy_file("{'descr': '<c8', 'fortran_order': False, 'shape': (1,), }", "12345678"))
            .ends_with("no shader has values of the type '<c8'"));
  CHECK(refusal(numpy_file("{'descr': '<f4', 'fortran_order': True, 'shape': (1, 1), }", "1234")).find("Fortran") !=
        std::string::npos);
  CHECK(refusal(numpy_file("{'descr': '<f4', 'fortran_order': False, 'shape': (2,), }", "1234"))
            .ends_with("it ends before its last number"));
  CHECK(refusal(numpy_file("{'descr': '<f4', 'fortran_order': False, 'shape': (99999999999,9999999999), }", "1234"))
            .ends_with("its shape is no shape"));
  CHECK(refusal(std::string("\x93NUMPY\1\0\xff\xff{", 11) + "}").ends_with("it ends within its header"));
}

TEST_CASE("a structure of several types is no array") {
  const ValueType mixed{.kind = ValueType::Kind::structure,
                        .size = 8,
                        .members = {{"a", 0, make_type(ScalarType::float32)}, {"b", 4, make_type(ScalarType::uint32)}}};
  CHECK_THROWS_AS(npy_of(mixed, std::vector<std::byte>(8)), Error);
}

}  // namespace
