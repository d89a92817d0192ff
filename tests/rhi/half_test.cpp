// 16-bit floats: every device rounds each operation, so that they agree to the last bit where IEEE 754 says what it is.

#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "tests/rhi/dispatch.hpp"

using namespace tandem;

namespace {

constexpr std::uint32_t workgroups = 16, size = 64, invocations = workgroups * size, columns = 8;

/// Two halves per word: normal numbers of a few powers of two around 1, whose results are no NaN.
std::vector<std::uint32_t> operands() {
  std::mt19937 generator(16);
  std::vector<std::uint32_t> words(2 * invocations);
  for (std::uint32_t& word : words) word = (static_cast<std::uint32_t>(generator()) & 0x8fff8fffu) + 0x34003400u;
  return words;
}

const std::string shader = R"(#version 460
#extension GL_EXT_shader_explicit_arithmetic_types_float16 : require
layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer Operands { uint operands[]; };
layout(std430, binding = 1) writeonly buffer Results { uint results[]; };
void main() {
  uint i = gl_GlobalInvocationID.x;
  f16vec2 a = unpackFloat2x16(operands[2 * i]), b = unpackFloat2x16(operands[2 * i + 1]);
  uint first = 8 * i;
  results[first] = packFloat2x16(a + b);
  results[first + 1] = packFloat2x16(a * b);
  results[first + 2] = packFloat2x16(fma(a, b, b));
  results[first + 3] = packFloat2x16(mix(a, b, f16vec2(0.25)));
  results[first + 4] = packFloat2x16(f16vec2(dot(a, b), dot(f16vec3(a, b.x), f16vec3(b, a.y))));
  results[first + 5] = packFloat2x16(floor(a) + fract(b) + min(a, b) + sign(a) * abs(b));
  results[first + 6] = packFloat2x16(f16vec2(vec2(a) * 1.0009765625 + vec2(b)));
  results[first + 7] = uint(int(a.x * float16_t(100))) + (a.x < b.x ? 1u : 0u);
}
)";

std::vector<std::uint32_t> results_of(rhi::Device& device) {
  const rhi::ComputePipelineHandle pipeline = test::compute_pipeline(device, shader, "halves");
  const rhi::BufferHandle in = test::buffer_of(device, operands(), "operands");
  const rhi::BufferHandle out =
      test::buffer_of(device, std::vector<std::uint32_t>(columns * invocations), "results of halves");
  test::run(device, pipeline, {in, out}, workgroups);
  return test::contents<std::uint32_t>(device, out, columns * invocations);
}

}  // namespace

TANDEM_DEVICE_TEST("16-bit floats have the bits that the CPU device gives them") {
  const std::vector<std::uint32_t> results = results_of(device), expected = results_of(*test::device("cpu"));
  for (std::uint32_t column = 0; column < columns; ++column) {
    std::uint32_t different = 0, first = 0;
    for (std::uint32_t i = 0; i < invocations; ++i) {
      const std::uint32_t place = columns * i + column;
      if (results[place] != expected[place] && different++ == 0) first = i;
    }
    CAPTURE(column);
    CAPTURE(first);
    CAPTURE(results[columns * first + column]);
    CAPTURE(expected[columns * first + column]);
    CHECK(different == 0);
  }
}
