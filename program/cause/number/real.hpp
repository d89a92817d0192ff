#pragma once

#include <cfloat>
#include <cstdint>

/// Numbers of 113 bits, which hold the sum of most and the product of all 64-bit floats exactly, and their rounding to
/// the formats of shaders.
namespace tandem::program {

#if LDBL_MANT_DIG >= 113
using Real = long double;
#else
__extension__ typedef __float128 Real;
#endif

/// An IEEE 754 binary format of 16, 32 or 64 bits.
struct Format {
  int width = 32;
  int mantissa_bits = 23;
  int smallest_exponent = -126;  ///< of a normal number
  int largest_exponent = 127;
};

Format format_of(std::uint32_t width);

Real infinity();
Real not_a_number();
bool is_nan(Real x);
bool is_infinite(Real x);
bool is_finite(Real x);
bool is_negative(Real x);  ///< also of -0

Real absolute(Real x);
Real truncated(Real x);
Real floored(Real x);
Real square_root(Real x);  ///< to about 110 bits

/// x * 2^exponent, in the range of Real.
Real scaled(Real x, int exponent);

/// The e of 2^e <= |x| < 2^(e+1). @pre x is finite and not 0
int exponent_of(Real x);

/// The exponent of the last digit of x that is 1. @pre x is finite and not 0
int last_digit_of(Real x);

/// The rounding error of x + y. @pre the sum is finite
Real sum_tail(Real x, Real y);

Real largest_finite(const Format& format);
Real smallest_normal(const Format& format);

/// The distance of the floats around x, of a power of two the one above, like rhi::ulp_at().
Real ulp(Real x, const Format& format);

// The exact value is x + tail, where the tail is too small for x to hold. Beyond the largest finite number follows an
// infinity.
Real rounded_down(Real x, const Format& format, Real tail = 0);
Real rounded_up(Real x, const Format& format, Real tail = 0);
Real rounded_to_zero(Real x, const Format& format, Real tail = 0);
Real rounded_to_nearest(Real x, const Format& format, Real tail = 0);  ///< ties to even

bool is_denormal(Real x, const Format& format);

Real decoded(std::uint64_t bits, const Format& format);

/// @pre the format has x: it was rounded
std::uint64_t encoded(Real x, const Format& format);

}  // namespace tandem::program
