#include "program/amber/expectation.hpp"

#include <doctest/doctest.h>

#include <cstring>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "program/amber/script.hpp"

using namespace tandem::program;
using namespace tandem::program::amber;

namespace {

/// What the last expectation of a script says of the initial contents of its buffers and images.
std::string failure_in(const std::string& declarations, const std::string& expectation) {
  const Script script = parse("#!amber\n" + declarations + "\nEXPECT " + expectation, "test.amber");
  const Expectation& last = script.expectations.at(0);
  const auto contents = [&](const Storage& storage) -> std::span<const std::byte> {
    return storage.kind == Storage::Kind::buffer ? std::span(script.job.buffers.at(storage.index).initial)
                                                 : std::span(script.job.images.at(storage.index).initial);
  };
  const auto* buffers = std::get_if<BuffersExpectation>(&last.what);
  return failure(last, contents(last.storage), buffers != nullptr ? contents(buffers->other) : contents(last.storage));
}

std::string of_integers(const std::string& expectation) {
  return failure_in("BUFFER b DATA_TYPE int32 DATA -1 2 3 4 END", "b IDX " + expectation);
}

std::string of_floats(const std::string& expectation) {
  return failure_in("BUFFER b DATA_TYPE float DATA 0.1 2 nan -0.0 END", "b IDX " + expectation);
}

TEST_CASE("integers are compared exactly, with their sign") {
  CHECK(of_integers("0 EQ -1 2 3 4") == "");
  CHECK(of_integers("4 EQ 2 4") == "b is 3 at byte 8, expected 4");
  CHECK(of_integers("0 NE 1") == "");
  CHECK(of_integers("0 NE -1") == "b is -1 at byte 0, expected not -1");
  CHECK(of_integers("0 LT 0 3") == "");
  CHECK(of_integers("0 LT -1") == "b is -1 at byte 0, expected less than -1");
  CHECK(of_integers("0 LE -1") == "");
  CHECK(of_integers("0 LE -2") == "b is -1 at byte 0, expected at most -2");
  CHECK(of_integers("4 GT 1") == "");
  CHECK(of_integers("4 GT 2") == "b is 2 at byte 4, expected greater than 2");
  CHECK(of_integers("4 GE 2") == "");
  CHECK(of_integers("4 GE 3") == "b is 2 at byte 4, expected at least 3");
  CHECK(of_integers("12 TOLERANCE 1 EQ 5") == "");
  CHECK(of_integers("12 TOLERANCE 1 EQ 6") == "b is 4 at byte 12, expected 6 within 1");
}

TEST_CASE("unsigned integers are not signed ones") {
  const std::string buffer = "BUFFER b DATA_TYPE uint64 DATA 0xffffffffffffffff END";
  CHECK(failure_in(buffer, "b IDX 0 GT 1") == "");
  CHECK(failure_in(buffer, "b IDX 0 EQ 0xfffffffffffffffe") != "");
}

TEST_CASE("floating-point numbers are compared with what their type holds") {
  CHECK(of_floats("0 EQ 0.1 2") == "");
  CHECK(of_floats("0 EQ 0.10001") != "");
  CHECK(of_floats("0 NE 0.1") != "");
  CHECK(of_floats("8 EQ nan") == "");
  CHECK(of_floats("8 EQ 1") == "b is nan at byte 8, expected 1");
  CHECK(of_floats("4 EQ nan") != "");
  CHECK(of_floats("8 TOLERANCE 5 EQ 1") != "");
  CHECK(of_floats("8 LT 1") != "");
  CHECK(of_floats("8 GE 1") != "");
  CHECK(of_floats("12 EQ 0") == "");
  CHECK(of_floats("4 TOLERANCE 0.5 EQ 2.5") == "");
  CHECK(of_floats("4 TOLERANCE 0.5 EQ 2.6") != "");
  CHECK(of_floats("4 TOLERANCE 10 % EQ 2.2") == "");
  CHECK(of_floats("4 TOLERANCE 10% EQ 2.3") == "b is 2 at byte 4, expected 2.3 within 10 %");
  CHECK(failure_in("BUFFER b DATA_TYPE float DATA 1e39 END", "b IDX 0 TOLERANCE 5 EQ 1e39") == "");
}

TEST_CASE("a tolerance for each component is for that component") {
  const std::string buffer = "BUFFER b DATA_TYPE vec2<float> DATA 1 1 5 5 END";
  CHECK(failure_in(buffer, "b IDX 0 TOLERANCE 0.1 1 EQ 1.05 2 5.05 6") == "");
  CHECK(failure_in(buffer, "b IDX 0 TOLERANCE 0.1 1 EQ 1.05 2 5.5 6") != "");
  CHECK(failure_in(buffer, "b IDX 8 TOLERANCE 1 EQ 6 4") == "");
}

TEST_CASE("padding between values is no value") {
  const std::string buffer = "BUFFER b DATA_TYPE vec3<float> DATA 1 2 3 4 5 6 END";
  CHECK(failure_in(buffer, "b IDX 0 EQ 1 2 3 4 5 6") == "");
  CHECK(failure_in(buffer, "b IDX 16 EQ 4 5 7") == "b is 6 at byte 24, expected 7");
}

TEST_CASE("texels are compared as numbers in [0, 1]") {
  const std::string image =
      "IMAGE i FORMAT B8G8R8A8_UNORM DIM_2D WIDTH 2 HEIGHT 2 DATA\n"
      "30 20 10 255  30 20 10 255\n30 20 10 128  31 20 10 255\nEND";
  CHECK(failure_in(image, "i IDX 0 0 SIZE 2 1 EQ_RGBA 10 20 30 255") == "");
  CHECK(failure_in(image, "i IDX 0 0 SIZE 1 2 EQ_RGB 10 20 30") == "");
  CHECK(failure_in(image, "i IDX 0 0 SIZE 1 2 EQ_RGBA 10 20 30 255") != "");
  CHECK(failure_in(image, "i IDX 0 0 SIZE 2 2 EQ_RGB 10 20 30") == "i is 31 20 10 at (1, 1), expected 10 20 30");
  CHECK(failure_in(image, "i IDX 0 0 SIZE 2 2 EQ_RGB 10 20 30 TOLERANCE 0 0 0.004") == "");
  CHECK(failure_in(image, "i IDX 0 0 SIZE 2 2 EQ_RGB 10 20 30 TOLERANCE 0.004 0 0") != "");
}

TEST_CASE("a component of a packed float, an integer or a 64-bit format is its value") {
  CHECK(failure_in("IMAGE i FORMAT R8G8B8A8_UINT DIM_2D WIDTH 1 HEIGHT 1 FILL 7",
                   "i IDX 0 0 SIZE 1 1 EQ_RGBA 7 7 7 7") == "");
  CHECK(failure_in("IMAGE i FORMAT R8G8B8A8_UINT DIM_2D WIDTH 1 HEIGHT 1 FILL 7",
                   "i IDX 0 0 SIZE 1 1 EQ_RGBA 7 7 7 8") != "");
  CHECK(failure_in("IMAGE i FORMAT R64G64B64A64_SFLOAT DIM_2D WIDTH 1 HEIGHT 1 DATA 1 0 1 0 END",
                   "i IDX 0 0 SIZE 1 1 EQ_RGBA 255 0 255 0") == "");
  // 1.0 is 0x3c0 with six bits of mantissa, 0x1e0 with five.
  CHECK(failure_in("IMAGE i FORMAT B10G11R11_UFLOAT_PACK32 DIM_2D WIDTH 1 HEIGHT 1 DATA 0x780003c0 END",
                   "i IDX 0 0 SIZE 1 1 EQ_RGB 255 0 255") == "");
}

TEST_CASE("buffers are compared by byte, by distance and by histogram") {
  const std::string two = "BUFFER a DATA_TYPE float DATA 1 2 3 4 END\nBUFFER b DATA_TYPE float DATA 1 2 3 6 END\n";
  CHECK(failure_in(two, "a EQ_BUFFER a") == "");
  CHECK(failure_in(two, "a EQ_BUFFER b") == "a is 4 at byte 12, where b is 6");
  CHECK(failure_in(two, "a RMSE_BUFFER b TOLERANCE 1") == "");
  CHECK(failure_in(two, "a RMSE_BUFFER b TOLERANCE 0.99") ==
        "the root mean square error of a and b is 1, expected at most 0.99");
  const std::string nan = "BUFFER a DATA_TYPE float DATA nan END\nBUFFER b DATA_TYPE float DATA 1 END\n";
  CHECK(failure_in(nan, "a RMSE_BUFFER b TOLERANCE 1000") != "");

  const std::string images =
      "BUFFER a DATA_TYPE R8G8B8A8_UNORM DATA 0 0 0 0  9 9 9 9 END\n"
      "BUFFER b DATA_TYPE R8G8B8A8_UNORM DATA 9 9 9 9  0 0 0 0 END\n"
      "BUFFER c DATA_TYPE R8G8B8A8_UNORM DATA 9 9 137 9  0 0 0 0 END\n";
  CHECK(failure_in(images, "a EQ_HISTOGRAM_EMD_BUFFER b TOLERANCE 0") == "");
  CHECK(failure_in(images, "a EQ_HISTOGRAM_EMD_BUFFER c TOLERANCE 0.25") == "");  // half of it by 128 of 256 bins
  CHECK(failure_in(images, "a EQ_HISTOGRAM_EMD_BUFFER c TOLERANCE 0.24") != "");
}

}  // namespace
