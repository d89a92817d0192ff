// Which lanes take part in a subgroup operation, in control flow that differs from lane to lane.

#include <doctest/doctest.h>

#include <algorithm>
#include <cstdlib>
#include <string>

#include <fmt/format.h>

#include "tests/rhi_cpu/groups/device.hpp"
#include "tests/rhi_cpu/groups/random_program.hpp"

namespace tandem::cpu::test {
namespace {

TEST_CASE("random programs reconverge as early as they can") {
  constexpr std::uint32_t programs = 2, invocations = 77;
  // More of them: TANDEM_RANDOM_PROGRAMS=100.
  const char* rounds_text = std::getenv("TANDEM_RANDOM_PROGRAMS");
  const std::uint32_t rounds = rounds_text == nullptr ? 2 : static_cast<std::uint32_t>(std::atoi(rounds_text));
  constexpr std::uint32_t sizes[] = {16, 4, 32, 8};
  for (std::uint32_t round = 0; round < rounds; ++round) {
    CAPTURE(round);
    const std::uint32_t size = sizes[round % 4];
    std::string glsl = fmt::format(R"(
#extension GL_KHR_shader_subgroup_ballot : require
layout(local_size_x = {}) in;
layout(binding = 0) buffer B {{ uint b[]; }};
uint draw(uint lane, uint number, uint rounds) {{
  uint x = lane * 0x9e3779b1u + number * 0x85ebca77u + rounds * 0xc2b2ae3du;
  x ^= x >> 15;
  x *= 0x2c1b3c6du;
  return x >> 12;
}}
bool mix_in(inout uint h, uint number) {{
  h = h * 31u + subgroupBallot(true).x + number * 7u;
  return true;
}}
)",
                                   invocations);
    std::string main;
    std::vector<RandomProgram> random;
    random.reserve(programs);
    for (std::uint32_t p = 0; p < programs; ++p) {
      random.emplace_back(round * programs + p + 1, 3);
      glsl += random.back().glsl(fmt::format("program_{}_", p));
      main +=
          fmt::format("b[{} + gl_LocalInvocationIndex] = program_{}_(gl_LocalInvocationIndex);\n", p * invocations, p);
    }
    glsl += "void main() {\n" + main + "}\n";
    Words expected;
    for (const RandomProgram& program : random)
      for (std::uint32_t first = 0; first < invocations; first += size) {
        const Words part = program.results(std::min(size, invocations - first), first);
        expected.insert(expected.end(), part.begin(), part.end());
      }
    const bool is_right = run(*device_with(size), glsl, Words(programs * invocations)) == expected;
    CHECK_MESSAGE(is_right, glsl);
  }
}

}  // namespace
}  // namespace tandem::cpu::test
