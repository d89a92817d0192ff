#pragma once

#include <span>

#include "program/cause/number/real.hpp"

/// What the Vulkan specification permits a float to be, and how arithmetic carries it on: appendix "Vulkan Environment
/// for SPIR-V", "Precision and Operation of SPIR-V Instructions".
namespace tandem::program {

enum class Rounding { unspecified, to_nearest, to_zero };

/// What one instruction's floats are computed with.
struct Rules {
  Format format = {};
  Rounding rounding = Rounding::unspecified;  ///< of what is correctly rounded
  bool may_flush = true;                      ///< denormals, to zero
  bool must_flush = false;                    ///< denormal results
  bool keeps_specials = false;                ///< the sign of zero, NaN and infinity count
  bool relaxed = false;                       ///< RelaxedPrecision
  bool quantized = false;                     ///< results of a wider format have the digits of this one
};

/// A value that is not known exactly: every step of a formula may err.
struct Range {
  Real exact = 0;            ///< in exact arithmetic
  Real tail = 0;             ///< what `exact` is too short for
  Real low = 0, high = 0;    ///< what the specification permits
  bool may_be_zero = false;  ///< a denormal that may be flushed
  bool open = false;         ///< anything is permitted
  const char* why = "";      ///< of open: a clause
};

Range exactly(Real value);

/// Anything, where the exact value is this one.
Range open(Real exact, const char* why);

/// An operand of the instruction.
Range operand(const Rules& rules, Real value);

/// Both permitted. The exact value is the first one's.
Range either(const Range& first, const Range& second);

/// The result of a formula that the tables say precision is "inherited from": as far from the exact one as the
/// formula's results may be, on both sides.
Range inherited(const Range& range);

/// Wider by an absolute error.
Range within(const Rules& rules, const Range& range, Real error);

// Correctly rounded.
Range add(const Rules& rules, const Range& x, const Range& y);
Range subtract(const Rules& rules, const Range& x, const Range& y);
Range multiply(const Rules& rules, const Range& x, const Range& y);
Range convert(const Rules& rules, const Range& x);  ///< to the format of the rules

// Exact.
Range negate(const Range& x);
Range minimum(const Range& x, const Range& y);
Range maximum(const Range& x, const Range& y);
Range floor_of(const Range& x);
Range truncate(const Range& x);

// With the errors of the tables: of 64 bits those of 32, in units of the last place of 64 ("the precision of
// double-precision instructions is at least that of single precision").
Range divide(const Rules& rules, const Range& x, const Range& y);
Range inverse_sqrt(const Rules& rules, const Range& x);
Range square_root(const Rules& rules, const Range& x);

/// The sum of products x[i] * y[i], in any order.
Range dot(const Rules& rules, std::span<const Range> x, std::span<const Range> y);

/// Whether a float of the rules' format is permitted.
bool permits(const Rules& rules, const Range& range, Real value);

}  // namespace tandem::program
