// Control flow, functions and variables, with plain modules and with optimised ones, where variables have become phis.

#include <cstdint>
#include <string>
#include <vector>

#include <algorithm>
#include <iterator>

#include <doctest/doctest.h>

#include "rhi_cpu/translate/translate.hpp"

#include "tests/rhi_cpu/translate/kernel_harness.hpp"

namespace {

using tandem::test::compute_spirv;
using tandem::test::evaluate;
using tandem::test::Kernel;
using tandem::test::resource;

using Ints = std::vector<std::int32_t>;

/// The same function in GLSL and in C++; their common subset is large.
#define TANDEM_BOTH(...) \
  __VA_ARGS__            \
  const char* const both_source = #__VA_ARGS__;

// GLSL has no attribute that says that a case falls through on purpose.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wimplicit-fallthrough"
TANDEM_BOTH(
    int loops(int n) {
      int sum = 0;
      for (int i = 0; i < n; ++i) {
        if (i % 3 == 1) continue;
        int j = i;
        while (j > 0) {
          j -= 2;
          if (j == 4) break;
          for (int k = j; k < n; k += 3) {
            if (k == 7) continue;
            if (k > 11) break;
            sum += k * 5 + i;
            if (sum > 900) return sum + 10000;
          }
        }
        do {
          sum += j;
          if (sum % 5 == 0) break;
          ++j;
        } while (j < 3);
      }
      return sum;
    }

    int cases(int n) {
      int result = 1;
      switch (n) {
        case 0:
          return 7;
        case 1:
          result += 10;
        case 2:
          result += 20;
          break;
        case -3:
        case 4:
          if (n > 0) break;
          result = 50;
        default:
          result += 100;
          for (int i = 0; i < 3; ++i) {
            switch (i) {
              case 1:
                continue;
              case 2:
                result *= 2;
                break;
              default:
                result += 3;
            }
            result += i;
          }
          break;
        case 9:
          result += 5;
      }
      return result * 2;
    }

    int collatz(int n) {
      int steps = 0;
      for (;;) {
        if (n == 1) return steps;
        ++steps;
        n = (n & 1) == 0 ? n / 2 : 3 * n + 1;
      }
    }

    int rotate_three(int n) {
      int a = 1;
      int b = 2;
      int c = 3;
      for (int i = 0; i < n; ++i) {
        int t = a;
        a = b;
        b = c;
        c = t + a;
      }
      return a * 10000 + b * 100 + c;
    }

    int short_circuit(int n) {
      int a = 0;
      if ((n > 2 && (a += 3) > 1) || (n == 1 && (a += 5) > 1)) a += 100;
      return n > 5 ? a + 1 : n < 2 ? a + 2 : a;
    })

#pragma GCC diagnostic pop

TEST_CASE("loops, switches, returns and conditions take the paths that C++ takes") {
  constexpr int inputs = 24;
  const char* const names[] = {"loops", "cases", "collatz", "rotate_three", "short_circuit"};
  int (*const functions[])(int) = {loops, cases, collatz, rotate_three, short_circuit};
  std::string statements;
  for (std::size_t f = 0; f < std::size(names); ++f)
    statements += "for (int n = -4; n < 20; ++n) result[" + std::to_string(f * inputs) + " + n + 4] = " + names[f] +
                  "(max(n, " + (f == 2 ? "1" : "-4") + "));\n";
  const Ints result = evaluate<std::int32_t>("int", inputs * std::size(names), statements, both_source);
  for (std::size_t f = 0; f < std::size(names); ++f)
    for (int n = -4; n < 20; ++n) {
      CAPTURE(names[f]);
      CAPTURE(n);
      CHECK(result[f * inputs + static_cast<std::size_t>(n + 4)] == functions[f](f == 2 ? std::max(n, 1) : n));
    }
}

TEST_CASE("parameters go in, out and both, through vectors, structs and arrays") {
  const Ints result = evaluate<std::int32_t>("int", 9, R"(
    S s = S(ivec3(1, 2, 3), int[4](4, 5, 6, 7));
    int left = -1;
    result[0] = change(s.v.y, s, left, s.list);
    result[1] = s.v.x; result[2] = s.v.y; result[3] = s.v.z;
    result[4] = left;
    result[5] = s.list[0]; result[6] = s.list[3];
    swap(s.list[1], s.list[2]);
    result[7] = s.list[1] * 10 + s.list[2];
    result[8] = total;
  )",
                                             R"(
    struct S { ivec3 v; int list[4]; };
    int total = 5;
    void swap(inout int a, inout int b) { int t = a; a = b; b = t; total += a; }
    int change(inout int y, in S copy, out int written, inout int list[4]) {
      y += 40;
      copy.v.x = 1000;
      written = copy.v.x + copy.v.y;
      list[0] = list[3] + y;
      list[3] = 8;
      return copy.list[3];
    })");
  CHECK(result == Ints{7, 1, 42, 3, 1002, 49, 8, 65, 11});
}

TEST_CASE("an array parameter that is stored to once, and a constant") {
  const Ints result = evaluate<std::int32_t>(
      "int", 2, "int list[2] = int[2](1, 2); set(list); result[0] = list[0]; result[1] = list[1];",
      "void set(inout int list[2]) { if (list[0] == 1) list = int[2](7, 9); }");
  CHECK(result == Ints{7, 9});
}

TEST_CASE("variables without an initialiser start as zero") {
  CHECK(evaluate<std::int32_t>("int", 3,
                               "int a; ivec3 b; float c[3]; result[0] = a; result[1] = b.y; result[2] = int(c[2]);") ==
        Ints{0, 0, 0});
}

TEST_CASE("constant tables, global variables and arrays of arrays") {
  const Ints result = evaluate<std::int32_t>("int", 5, R"(
    int n = result.length();
    result[0] = primes[n - 2];
    grid[n - 4][n - 3] = 9;
    result[1] = grid[1][2] + grid[0][0];
    ivec4 v = ivec4(1, 2, 3, 4);
    v[n - 3] = 30;
    result[2] = v[2] + v[n - 4];
    result[3] = pairs[n - 4].b;
    mat3 m = mat3(2.0);
    m[n - 4][n - 5] = 7.0;
    result[4] = int(m[1].x + m[n - 4][1]);
  )",
                                             R"(
    struct Pair { int a; int b; };
    const int primes[5] = int[](2, 3, 5, 7, 11);
    const Pair pairs[2] = Pair[](Pair(1, 2), Pair(3, 4));
    int grid[2][3] = int[2][3](int[3](1, 2, 3), int[3](4, 5, 6)); )");
  CHECK(result == Ints{7, 10, 32, 4, 9});
}

TEST_CASE("names that mean something else in C++") {
  const Ints result = evaluate<std::int32_t>("int", 1, R"(
    int class_ = 1, new = 2, k = 3, std = 4, M_PI = 5, INFINITY = 6, errno = 7, resources = 8, run = 9, Invocation = 10, int8_t = 11;
    result[0] = class_ + new + k + std + M_PI + INFINITY + errno + resources + run + Invocation + int8_t + delete(1) + result.length();
  )",
                                             "int delete(int mutable) { return mutable; }\n");
  CHECK(result == Ints{68});
}

TEST_CASE("built-in variables and partial ranges of workgroups") {
  const Kernel kernel(R"(
    layout(local_size_x = 2, local_size_y = 3) in;
    struct Ids { uvec3 global; uint index; uvec3 local; uint pad; uvec3 group; uint pad2; uvec3 count; uint size; };
    layout(std430, binding = 0) buffer Result { Ids ids[]; };
    void main() {
      uint width = gl_NumWorkGroups.x * 2, height = gl_NumWorkGroups.y * 3;
      uint at = (gl_GlobalInvocationID.z * height + gl_GlobalInvocationID.y) * width + gl_GlobalInvocationID.x;
      ids[at] = Ids(gl_GlobalInvocationID, gl_LocalInvocationIndex, gl_LocalInvocationID, 0, gl_WorkGroupID, 0,
                    gl_NumWorkGroups, gl_WorkGroupSize.x * 100 + gl_WorkGroupSize.y * 10 + gl_WorkGroupSize.z);
    })");
  CHECK(kernel.info().workgroup_size[0] == 2);
  CHECK(kernel.info().workgroup_size[1] == 3);
  CHECK(kernel.info().workgroup_size[2] == 1);
  const std::uint32_t groups[3] = {3, 2, 2};
  std::vector<std::uint32_t> ids(16 * 6 * 12, 0xffffffffu);
  kernel.run({resource(ids)}, {groups[0], groups[1], groups[2]});
  for (std::uint32_t z = 0; z < 2; ++z)
    for (std::uint32_t y = 0; y < 6; ++y)
      for (std::uint32_t x = 0; x < 6; ++x) {
        const std::uint32_t* id = &ids[16 * ((z * 6 + y) * 6 + x)];
        const std::vector<std::uint32_t> expected = {
            x, y, z, y % 3 * 2 + x % 2, x % 2, y % 3, 0, 0, x / 2, y / 3, z, 0, 3, 2, 2, 231};
        CHECK(std::vector<std::uint32_t>(id, id + 16) == expected);
      }

  std::vector<std::uint32_t> part(16 * 6 * 12, 0xffffffffu);
  tandem::kernel::Resource only = resource(part);
  tandem::kernel::Dispatch dispatch;
  dispatch.resources = &only;
  std::copy(groups, groups + 3, dispatch.workgroup_count);
  kernel.info().run(dispatch, 4, 5);  // x = 1, y = 1, z = 0
  std::uint32_t written = 0;
  for (std::size_t i = 0; i < part.size(); i += 16) {
    if (part[i] == 0xffffffffu) continue;
    ++written;
    CHECK(part[i + 8] == 1);
    CHECK(part[i + 9] == 1);
    CHECK(part[i + 10] == 0);
  }
  CHECK(written == 6);
}

TEST_CASE("a module with debug information points the debugger at the GLSL") {
  const std::string glsl =
      "layout(local_size_x = 1) in;\nlayout(std430, binding = 0) buffer R { int r; };\nvoid main() {\n  r = 5;\n}\n";
  const std::string with = tandem::cpu::translate(compute_spirv(glsl, true), "test.comp").source;
  CHECK(with.find("#line 5 \"") != std::string::npos);
  const std::string without = tandem::cpu::translate(compute_spirv(glsl), "test.comp").source;
  CHECK(without.find("#line") == std::string::npos);
}

}  // namespace
