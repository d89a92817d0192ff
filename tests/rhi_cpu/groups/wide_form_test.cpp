// The wide form of a kernel gives the bits of the scalar form.

#include <cstdint>
#include <string>

#include <doctest/doctest.h>
#include <fmt/format.h>

#include "rhi_cpu/device.hpp"
#include "tests/rhi_cpu/groups/device.hpp"

namespace tandem::cpu::test {
namespace {

Words run_with(std::uint32_t lanes, const std::string& glsl, const Words& words, std::uint32_t workgroups) {
  rhi::DeviceDesc desc;
  desc.lanes = lanes;
  return run(*create_device(desc, {}), glsl, words, workgroups);
}

void check_forms(const std::string& glsl, const Words& words, std::uint32_t workgroups) {
  const Words expected = run_with(1, glsl, words, workgroups);
  for (const std::uint32_t lanes : {4u, 8u, 16u}) {
    CAPTURE(lanes);
    const Words found = run_with(lanes, glsl, words, workgroups);
    std::size_t differences = 0;
    for (std::size_t i = 0; i < words.size(); ++i) {
      if (found[i] == expected[i]) continue;
      if (differences++ < 3) MESSAGE(fmt::format("word {}: {:#x} instead of {:#x}", i, found[i], expected[i]));
    }
    CHECK(differences == 0);
  }
}

TEST_CASE("a negative fraction becomes the integer 0, and that the float +0") {
  const std::string glsl = R"(
#extension GL_EXT_shader_explicit_arithmetic_types : require
layout(local_size_x = 16) in;
layout(binding = 0) buffer B { uint b[]; };
void main() {
  uint i = gl_LocalInvocationIndex;
  float x = uintBitsToFloat(b[i]);
  uint all_bits = floatBitsToUint(float(int(x))) | floatBitsToUint(float(uint(x))) |
                  floatBitsToUint(vec2(ivec2(x)).y) | floatBitsToUint(float(int64_t(x)));
  b[i] = all_bits | unpackDouble2x32(double(int(double(x)))).y;
}
)";
  const Words zeros(16);
  for (const std::uint32_t lanes : {1u, 16u}) CHECK(run_with(lanes, glsl, Words(16, 0xbf000000u), 1) == zeros);
}

}  // namespace
}  // namespace tandem::cpu::test
