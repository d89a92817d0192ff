// The wide form: what the lanes of a kernel write is what the scalar form writes.

#include <cstdint>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "tests/rhi_cpu/translate/kernel_harness.hpp"

namespace {

using tandem::test::compute_spirv;
using tandem::test::Kernel;
using tandem::test::resource;

using Words = std::vector<std::uint32_t>;

constexpr std::uint32_t invocation_count = 21;

/// What each of 21 invocations writes into its element of `own`; `data` has the numbers 0, 1, 2... The statements know
/// the number of the invocation as `id`.
Words written(const std::string& statements, const std::string& declarations, std::uint32_t lanes,
              bool optimize = false) {
  const std::string source =
      "layout(local_size_x = 7) in;\nlayout(std430, binding = 0) buffer Own { uint own[]; };\n"
      "layout(std430, binding = 1) readonly buffer Data { uint data[]; };\n" +
      declarations + "\nvoid main() {\n  uint id = gl_GlobalInvocationID.x;\n" + statements + "\n}\n";
  Words own(invocation_count), data(64);
  for (std::uint32_t i = 0; i < data.size(); ++i) data[i] = i;
  Kernel(compute_spirv(source), {.specialization = {}, .optimize = optimize, .more_options = {}, .lanes = lanes})
      .run({resource(own), resource(data)}, {3});
  return own;
}

void check_lanes(const std::string& statements, const std::string& declarations = "") {
  const Words expected = written(statements, declarations, 0);
  CHECK(written(statements, declarations, 4) == expected);
  CHECK(written(statements, declarations, 4, true) == expected);
}

}  // namespace

TEST_CASE("in lanes: a loop that all leave together, by a condition that the edge back sets") {
  check_lanes(R"(
  bool again = true, last;
  uint a = data[5], b = 1u;
  int k = 0;
  do {
    a = a + 3u;
    b = b * 5u + a;
    last = again;
    again = ++k < 4;
  } while (last);
  own[id] = a + b + id;)");
}

TEST_CASE("in lanes: an address from a loop that lanes leave in different rounds") {
  check_lanes(R"(
  do own[id]++; while (own[id] < data[id * 2 & 15]);
  own[id] *= 3;)");
}

TEST_CASE("in lanes: what a function writes through a pointer beside its result") {
  check_lanes(R"(
  float x = float(data[7]) * 0.75, y = float(id) * 0.75, whole;
  own[id] = uint(modf(x, all) * 8.0) + uint(all) * 100u;
  own[id] += uint(modf(y, whole) * 8.0) * 10000u + uint(whole);
  own[id] += uint(modf(x, whole) * 8.0) * 1000000u + uint(whole);)",
              "float all = 0.0;");
}
