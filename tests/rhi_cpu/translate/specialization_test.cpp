// Specialisation constants are constants of the translated code.

#include <bit>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "rhi/error.hpp"
#include "tests/rhi_cpu/translate/kernel_harness.hpp"

namespace {

using tandem::test::Kernel;
using tandem::test::resource;

const char* const shader = R"(
  layout(local_size_x_id = 0, local_size_y = 2) in;
  layout(constant_id = 1) const int N = 3;
  layout(constant_id = 2) const float SCALE = 1.5;
  layout(constant_id = 3) const bool DOUBLE = false;
  layout(constant_id = 4) const uint M = 2u;
  const int LENGTH = N * 2 + int(M);
  layout(std430, binding = 0) buffer Result { float result[]; };
  struct Holder { float values[N]; };
  void main() {
    float list[LENGTH];
    Holder holder;
    for (int i = 0; i < LENGTH; ++i) list[i] = float(i) * SCALE;
    holder.values[N - 1] = 4.0;
    float sum = 0.0;
    for (int i = 0; i < list.length(); ++i) sum += list[i];
    result[0] = DOUBLE ? 2.0 * sum : sum;
    result[1] = float(LENGTH);
    result[2] = holder.values[N - 1];
    result[3] = float(gl_WorkGroupSize.x * 10u + gl_WorkGroupSize.y);
    result[4] = M > 2u ? 1.0 : 0.0;
  })";

TEST_CASE("defaults hold where no value is given") {
  const Kernel kernel(shader);
  CHECK(kernel.info().workgroup_size[0] == 1);
  std::vector<float> result(5);
  kernel.run({resource(result)});
  CHECK(result == std::vector<float>{42, 8, 4, 12, 0});
}

TEST_CASE("values reach array lengths, expressions and the workgroup size") {
  const Kernel kernel(shader,
                      {.specialization = {{0, 4}, {1, 5}, {2, std::bit_cast<std::uint32_t>(0.25f)}, {3, 1}, {4, 7}},
                       .more_options = {}});
  CHECK(kernel.info().workgroup_size[0] == 4);
  CHECK(kernel.info().workgroup_size[1] == 2);
  std::vector<float> result(5);
  kernel.run({resource(result)});
  CHECK(result == std::vector<float>{2 * 0.25f * (17 * 16 / 2), 17, 4, 42, 1});
}

TEST_CASE("a value for a constant that does not exist is an error") {
  CHECK_THROWS_WITH_AS(Kernel(shader, {.specialization = {{99, 1}}, .more_options = {}}),
                       "test.comp: the shader has no specialisation constant 99", tandem::rhi::Error);
}

TEST_CASE("expressions of every width are folded") {
  const std::string source = R"(
    #extension GL_EXT_shader_explicit_arithmetic_types : require
    layout(local_size_x = 1) in;
    layout(constant_id = 0) const int N = 3;
    layout(constant_id = 1) const float F = 2.5;
    layout(constant_id = 2) const float16_t H = float16_t(1.5);
    layout(constant_id = 3) const bool B = true;
    layout(constant_id = 4) const int16_t S = int16_t(-7);
    layout(constant_id = 5) const uint8_t C = uint8_t(200);
    layout(constant_id = 6) const uint U = 7u;
    const int64_t L = int64_t(N) * 5000000000l;
    layout(std430, binding = 0) buffer Result { double result[20]; };
    void main() {
      result[0] = double(L);
      result[1] = double(uint64_t(N) * 3ul / 2ul);
      result[2] = double(float(H));
      result[3] = double(float16_t(F));
      result[4] = double(F);
      result[5] = double(int16_t(N));
      result[6] = double(int(S) * 2);
      result[7] = double(uint(C) / 3u);
      result[8] = double(-S);
      result[9] = double(uint8_t(~C));
      result[10] = double(S % int16_t(4));
      result[11] = double(S >> int16_t(1));
      result[12] = double(B ? L : 5l);
      result[13] = double(U64);
      result[14] = double(V.y << 2);
      result[15] = double(int(Q));
      result[16] = double(W.z);
      result[17] = double(uint16_t(S));
      result[18] = double(P.x);
      result[19] = double(int8_t(C));
    }
  )";
  const std::string constants = R"(
    const uint64_t U64 = uint64_t(U) << 40ul;
    const ivec3 V = ivec3(N, N + 1, N * 2);
    const bool Q = L > 14000000000l && S < int16_t(0) && C >= uint8_t(200);
    const i64vec3 W = i64vec3(V) * 3l;
    const f16vec2 P = f16vec2(vec2(F, F));
)";
  std::string text = source;
  text.insert(text.find("    layout(std430"), constants);
  std::vector<double> result(20);
  Kernel(text).run({resource(result)});
  CHECK(result == std::vector<double>{15e9, 4, 1.5, 2.5,   2.5, 3,    -14,
                                      66,   7, 55,  1,     -4,  15e9, 7.0 * std::ldexp(1.0, 40),
                                      16,   1, 18,  65529, 2.5, -56});
  const std::vector<tandem::rhi::SpecializationValue> values = {{0, static_cast<std::uint32_t>(-3)},
                                                                {1, std::bit_cast<std::uint32_t>(0.1f)},
                                                                {2, 0x3555},
                                                                {3, 0},
                                                                {4, 6},
                                                                {5, 3}};
  Kernel(text, {.specialization = values, .more_options = {}}).run({resource(result)});
  CHECK(result == std::vector<double>{-15e9,
                                      std::floor((18446744073709551616.0 - 9) / 2),
                                      0.333251953125,
                                      0.0999755859375,
                                      static_cast<double>(0.1f),
                                      -3,
                                      12,
                                      1,
                                      -6,
                                      252,
                                      2,
                                      3,
                                      5,
                                      7.0 * std::ldexp(1.0, 40),
                                      -8,
                                      0,
                                      -18,
                                      6,
                                      0.0999755859375,
                                      3});
}

}  // namespace
