// Specialisation constants are constants of the translated code.

#include <bit>
#include <cstdint>
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

}  // namespace
