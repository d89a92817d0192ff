#pragma once

#include <cstdint>
#include <string_view>

/// How far a shader's result may lie from the exact one: Vulkan, appendix "Vulkan Environment for SPIR-V", tables
/// "Precision of Core SPIR-V Instructions" and "Precision of GLSL.std.450 Instructions".
namespace tandem::rhi {

/// Instructions of floats that the tables name. What they call inherited is worked out in allowed_error().
enum class FloatOperation : std::uint8_t {
  add,
  subtract,
  multiply,
  divide,
  fma,
  sqrt,
  inverse_sqrt,
  exp,
  exp2,
  log,
  log2,
  pow,
  sin,
  cos,
  tan,
  asin,
  acos,
  atan,
  atan2
};

std::string_view name_of(FloatOperation operation);

/// The largest distance from the exact result that the tables allow, of 16 or 32 bits.
/// @param x the operand, or the first of two
/// @param y the second operand, 0 where there is none
/// @param exact the exact result for these operands, which are what the instruction got
/// Infinite where the tables allow anything: divisors and quotients outside of the normal range, sin and cos outside of
/// [-pi, pi], pow of a negative number.
double allowed_error(FloatOperation operation, int bits, double x, double y, double exact);

/// One unit in the last place of a float of 16 or 32 bits at `value`.
double ulp_at(double value, int bits);

}  // namespace tandem::rhi
