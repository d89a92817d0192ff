#pragma once

#include <cmath>
#include <limits>
#include <optional>

namespace tandem::cpu::exact {

/// A double and how far the number that it stands for may be away from it. Quick, and often enough to tell a sign or a
/// rounding; where it is not, ExactNumber is.
///
/// The bounds hold for polynomials in floats up to degree seven. Whatever is computed of one is a multiple of 2^(-149 *
/// 7), which double represents, and below 2^1023: no operation underflows or overflows, so each is wrong by at most
/// 2^-53 of its result.
class BoundedNumber {
 public:
  BoundedNumber() = default;
  BoundedNumber(float value) : value_(value) {}  // NOLINT(google-explicit-constructor): as ExactNumber's

  double value() const { return value_; }
  double error() const { return error_; }

  BoundedNumber operator-() const { return {-value_, error_}; }

  friend BoundedNumber operator+(const BoundedNumber& a, const BoundedNumber& b) {
    // Knuth, The Art of Computer Programming, volume 2, 4.2.2, theorem B: what the rounding of a sum lost, exactly. So
    // sums that are exact, as those of vertices with like exponents are, add nothing to the error.
    const double sum = a.value_ + b.value_;
    const double of_b = sum - a.value_;
    const double lost = (a.value_ - (sum - of_b)) + (b.value_ - of_b);
    return {sum, (a.error_ + b.error_ + std::abs(lost)) * slack};
  }

  friend BoundedNumber operator-(const BoundedNumber& a, const BoundedNumber& b) { return a + -b; }

  friend BoundedNumber operator*(const BoundedNumber& a, const BoundedNumber& b) {
    const double product = a.value_ * b.value_;
    if (product == 0 && a.error_ == 0 && b.error_ == 0) return {product, 0};
    const double error = std::abs(product) * 0x1p-53 + std::abs(a.value_) * b.error_ + a.error_ * std::abs(b.value_) +
                         a.error_ * b.error_;
    // Products of errors may underflow.
    return {product, error * slack + std::numeric_limits<double>::min()};
  }

  /// With an infinite error where b may be zero.
  friend BoundedNumber operator/(const BoundedNumber& a, const BoundedNumber& b) {
    const double least = std::abs(b.value_) - b.error_;
    if (!(least > 0)) return {0, std::numeric_limits<double>::infinity()};
    const double quotient = a.value_ / b.value_;
    const double error = (a.error_ + std::abs(quotient) * b.error_) / least + std::abs(quotient) * 0x1p-53;
    return {quotient, error * slack + std::numeric_limits<double>::min()};
  }

 private:
  BoundedNumber(double value, double error) : value_(value), error_(error) {}

  static constexpr double slack = 1 + 0x1p-48;  ///< for the roundings of the errors themselves, a dozen at most

  double value_ = 0;
  double error_ = 0;
};

/// Nothing when it is too close to zero to say.
inline std::optional<int> sign_of(const BoundedNumber& number) {
  if (number.value() > number.error()) return 1;
  if (number.value() < -number.error()) return -1;
  if (number.error() == 0) return 0;
  return std::nullopt;
}

/// The float nearest to numerator / denominator, as that of ExactNumbers; nothing when it is too close to the middle of
/// two floats to say.
inline std::optional<float> rounded_quotient(const BoundedNumber& numerator, const BoundedNumber& denominator) {
  const BoundedNumber quotient = numerator / denominator;
  // The ends of the interval are rounded too.
  const double error = quotient.error() + std::abs(quotient.value()) * 0x1p-52;
  const auto low = static_cast<float>(quotient.value() - error);
  const auto high = static_cast<float>(quotient.value() + error);
  if (low != high) return std::nullopt;  // or NaN
  return low + 0.0f;
}

}  // namespace tandem::cpu::exact
