#include "rhi/precision.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

using namespace tandem;
using rhi::allowed_error;
using rhi::FloatOperation;

TEST_CASE("an ulp is the distance to the next float, also of small ones and of halves") {
  CHECK(rhi::ulp_at(1, 32) == std::nextafter(1.0f, 2.0f) - 1.0f);
  CHECK(rhi::ulp_at(-3.5, 32) == double{std::nextafter(3.5f, 4.0f)} - 3.5);
  CHECK(rhi::ulp_at(0, 32) == double{std::numeric_limits<float>::denorm_min()});
  CHECK(rhi::ulp_at(1, 16) == 0x1p-10);
  CHECK(rhi::ulp_at(0x1p-20, 16) == 0x1p-24);
}

TEST_CASE("the precision of instructions is that of the Vulkan specification") {
  // "Precision of Core SPIR-V Instructions" and "Precision of GLSL.std.450 Instructions".
  const double ulp = 0x1p-23;
  CHECK(allowed_error(FloatOperation::add, 32, 1, 0.5, 1.5) == 0.5 * ulp);
  CHECK(allowed_error(FloatOperation::divide, 32, 3, 2, 1.5) == 2.5 * ulp);
  CHECK(std::isinf(allowed_error(FloatOperation::divide, 32, 1, 0x1p127, 0x1p-127)));
  CHECK(allowed_error(FloatOperation::inverse_sqrt, 32, 0.5, 0, std::sqrt(2)) == 2 * ulp);
  CHECK(allowed_error(FloatOperation::exp, 32, 0.25, 0, std::exp(0.25)) == 3.5 * ulp);
  CHECK(allowed_error(FloatOperation::exp2, 16, 0.25, 0, std::exp2(0.25)) == 1.5 * 0x1p-10);
  CHECK(allowed_error(FloatOperation::log, 32, 1.5, 0, std::log(1.5)) == 0x1p-21);
  CHECK(allowed_error(FloatOperation::log2, 32, 8, 0, 3) == 3 * 2 * ulp);
  CHECK(allowed_error(FloatOperation::sin, 32, 3, 0, std::sin(3)) == 0x1p-11);
  CHECK(allowed_error(FloatOperation::cos, 16, 3, 0, std::cos(3)) == 0x1p-7);
  CHECK(std::isinf(allowed_error(FloatOperation::sin, 32, 4, 0, std::sin(4))));
  CHECK(allowed_error(FloatOperation::atan, 32, 2, 0, std::atan(2)) == 4096 * ulp);
  CHECK(allowed_error(FloatOperation::atan2, 16, 1, 2, std::atan2(1, 2)) == 5 * 0x1p-12);
  // Inherited ones are wider than what they inherit from.
  CHECK(allowed_error(FloatOperation::pow, 32, 3, 2, 9) > allowed_error(FloatOperation::exp2, 32, std::log2(9), 0, 9));
  CHECK(std::isinf(allowed_error(FloatOperation::pow, 32, -1, 2, 1)));
  CHECK(allowed_error(FloatOperation::tan, 32, 1, 0, std::tan(1)) > 0x1p-11);
}
