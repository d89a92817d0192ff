#include "rhi/precision.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>

namespace tandem::rhi {
namespace {

constexpr double anything = std::numeric_limits<double>::infinity();

constexpr std::string_view names[] = {"add", "subtract", "multiply", "divide", "fma",  "sqrt", "inverse_sqrt",
                                      "exp", "exp2",     "log",      "log2",   "pow",  "sin",  "cos",
                                      "tan", "asin",     "acos",     "atan",   "atan2"};

struct Width {
  int mantissa_bits;
  int smallest_exponent;  ///< of a normal number
  int largest_exponent;
};

Width width_of(int bits) { return bits == 16 ? Width{10, -14, 15} : Width{23, -126, 127}; }

/// Where the tables say anything of a quotient: |y| in [2^-126, 2^126] for 32 bits, and the quotient not subnormal.
bool is_divisor(double y, const Width& width) {
  const double magnitude = std::abs(y);
  return magnitude >= std::ldexp(1.0, width.smallest_exponent) &&
         magnitude <= std::ldexp(1.0, width.largest_exponent - 1);
}

double exponential_error(double x, double exact, int bits) {
  return ((bits == 16 ? 1 : 3) + 2 * std::abs(x)) * ulp_at(exact, bits);
}

double logarithm_error(double x, double exact, int bits) {
  if (x >= 0.5 && x <= 2.0) return bits == 16 ? 0x1p-7 : 0x1p-21;
  return 3 * ulp_at(exact, bits);
}

double sine_error(double x, int bits) {
  if (std::abs(x) > std::numbers::pi) return anything;
  return bits == 16 ? 0x1p-7 : 0x1p-11;
}

double arc_error(double exact, int bits) { return (bits == 16 ? 5 : 4096) * ulp_at(exact, bits); }

/// x^y = exp2(y * log2(x)): the error of the logarithm, scaled by y, goes into the exponent.
double power_error(double x, double y, double exact, int bits) {
  if (x <= 0) return anything;
  const double exponent = y * std::log2(x);
  const double exponent_error = std::abs(y) * logarithm_error(x, std::log2(x), bits) + ulp_at(exponent, bits);
  return exponential_error(exponent, exact, bits) + exact * std::expm1(std::numbers::ln2 * exponent_error);
}

}  // namespace

std::string_view name_of(FloatOperation operation) {
  static_assert(std::size(names) == static_cast<std::size_t>(FloatOperation::atan2) + 1);
  return names[static_cast<std::size_t>(operation)];
}

double ulp_at(double value, int bits) {
  const Width width = width_of(bits);
  int exponent = width.smallest_exponent;
  if (value != 0) exponent = std::max(std::ilogb(value), width.smallest_exponent);
  return std::ldexp(1.0, exponent - width.mantissa_bits);
}

double allowed_error(FloatOperation operation, int bits, double x, double y, double exact) {
  const double ulp = ulp_at(exact, bits);
  const Width width = width_of(bits);
  switch (operation) {
    case FloatOperation::add:
    case FloatOperation::subtract:
    case FloatOperation::multiply:
      return 0.5 * ulp;
    case FloatOperation::fma:  // as a multiplication and an addition
      return 0.5 * ulp + 0.5 * ulp_at(x * y, bits);
    case FloatOperation::divide:
      return is_divisor(y, width) && std::abs(exact) >= std::ldexp(1.0, width.smallest_exponent) ? 2.5 * ulp : anything;
    case FloatOperation::inverse_sqrt:
      return 2 * ulp;
    case FloatOperation::sqrt:  // as 1 / inverse_sqrt: the two errors add up
      return 4.5 * ulp + 2 * std::abs(exact) * std::ldexp(1.0, -width.mantissa_bits);
    case FloatOperation::exp:
    case FloatOperation::exp2:
      return exponential_error(x, exact, bits);
    case FloatOperation::log:
    case FloatOperation::log2:
      return logarithm_error(x, exact, bits);
    case FloatOperation::pow:
      return power_error(x, y, exact, bits);
    case FloatOperation::sin:
    case FloatOperation::cos:
      return sine_error(x, bits);
    case FloatOperation::tan: {  // as sin / cos
      const double error = sine_error(x, bits), cosine = std::abs(std::cos(x));
      return error < cosine ? (error + std::abs(exact) * error) / (cosine - error) + 2.5 * ulp : anything;
    }
    case FloatOperation::asin:  // as atan2(x, sqrt(1 - x * x)): near 1 the root loses half of the bits
    case FloatOperation::acos:
      return arc_error(std::max(std::abs(exact), 1.0), bits);
    case FloatOperation::atan:
    case FloatOperation::atan2:
      return arc_error(exact, bits);
  }
  return anything;
}

}  // namespace tandem::rhi
