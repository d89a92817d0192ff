#include "rhi_cpu/trace/exact/exact_number.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace tandem::cpu::exact {
namespace {

using DoubleLimb = unsigned __int128;

int floor_divide(int a, int b) { return a >= 0 ? a / b : -((b - 1 - a) / b); }

}  // namespace

ExactNumber::ExactNumber(double value) : negative_(value < 0) {
  if (value == 0) return;
  constexpr int mantissa_bits = std::numeric_limits<double>::digits;
  int exponent = 0;
  const double fraction = std::frexp(std::abs(value), &exponent);
  const auto mantissa = static_cast<Limb>(std::ldexp(fraction, mantissa_bits));
  exponent -= mantissa_bits;
  exponent_ = floor_divide(exponent, limb_bits);
  const DoubleLimb aligned = DoubleLimb{mantissa} << (exponent - exponent_ * limb_bits);
  at(0) = static_cast<Limb>(aligned);
  at(1) = static_cast<Limb>(aligned >> limb_bits);
  size_ = 2;
  trim();
}

int ExactNumber::checked_size(int size) {
  if (size > capacity) throw std::length_error("an exact number needs more than 2560 bits");
  return size;
}

void ExactNumber::trim() {
  while (size_ > 0 && at(size_ - 1) == 0) --size_;
  const auto used = limbs_.begin() + size_;
  const auto first = std::find_if(limbs_.begin(), used, [](Limb limb) { return limb != 0; });
  const auto zeros = static_cast<int>(first - limbs_.begin());
  if (zeros > 0) std::copy(first, used, limbs_.begin());
  size_ -= zeros;
  exponent_ += zeros;
}

ExactNumber::Limb ExactNumber::limb_at(int position) const {
  const int index = position - exponent_;
  return index >= 0 && index < size_ ? at(index) : 0;
}

int ExactNumber::compare_magnitudes(const ExactNumber& a, const ExactNumber& b) {
  const int low = std::min(a.exponent_, b.exponent_);
  for (int i = std::max(a.exponent_ + a.size_, b.exponent_ + b.size_) - 1; i >= low; --i) {
    if (a.limb_at(i) != b.limb_at(i)) return a.limb_at(i) < b.limb_at(i) ? -1 : 1;
  }
  return 0;
}

ExactNumber ExactNumber::operator-() const {
  ExactNumber result = *this;
  result.negative_ = !negative_;
  return result;
}

ExactNumber operator+(const ExactNumber& a, const ExactNumber& b) {
  if (a.size_ == 0) return b;
  if (b.size_ == 0) return a;
  const bool subtract = a.negative_ != b.negative_;
  const bool a_is_larger = ExactNumber::compare_magnitudes(a, b) >= 0;
  const ExactNumber& large = a_is_larger ? a : b;
  const ExactNumber& small = a_is_larger ? b : a;
  ExactNumber result;
  result.negative_ = large.negative_;
  result.exponent_ = std::min(a.exponent_, b.exponent_);
  const int end = std::max(a.exponent_ + a.size_, b.exponent_ + b.size_) + 1;
  result.size_ = ExactNumber::checked_size(end - result.exponent_);
  ExactNumber::Limb carry = 0;  // or borrow
  for (int i = 0; i < result.size_; ++i) {
    const DoubleLimb x = large.limb_at(result.exponent_ + i);
    const DoubleLimb y = DoubleLimb{small.limb_at(result.exponent_ + i)} + carry;
    const DoubleLimb limb = subtract ? x - y : x + y;
    result.at(i) = static_cast<ExactNumber::Limb>(limb);
    carry = static_cast<ExactNumber::Limb>(limb >> ExactNumber::limb_bits) & 1;
  }
  result.trim();
  return result;
}

ExactNumber operator*(const ExactNumber& a, const ExactNumber& b) {
  ExactNumber result;
  if (a.size_ == 0 || b.size_ == 0) return result;
  result.negative_ = a.negative_ != b.negative_;
  result.exponent_ = a.exponent_ + b.exponent_;
  result.size_ = ExactNumber::checked_size(a.size_ + b.size_);
  for (int i = 0; i < a.size_; ++i) {
    ExactNumber::Limb carry = 0;
    for (int j = 0; j < b.size_; ++j) {
      ExactNumber::Limb& limb = result.at(i + j);
      const DoubleLimb sum = DoubleLimb{a.at(i)} * b.at(j) + limb + carry;
      limb = static_cast<ExactNumber::Limb>(sum);
      carry = static_cast<ExactNumber::Limb>(sum >> ExactNumber::limb_bits);
    }
    result.at(i + b.size_) = carry;
  }
  result.trim();
  return result;
}

double ExactNumber::approximation() const {
  if (size_ == 0) return 0;
  const int top = exponent_ + size_ - 1;
  const double magnitude = std::ldexp(static_cast<double>(limb_at(top)), limb_bits) +
                           static_cast<double>(limb_at(top - 1));  // at least 64 significant bits, rounded twice
  const double value = std::ldexp(magnitude, (top - 1) * limb_bits);
  return negative_ ? -value : value;
}

std::optional<float> rounded_quotient(const ExactNumber& numerator, const ExactNumber& denominator) {
  const ExactNumber n = numerator.sign() < 0 ? -numerator : numerator;
  const ExactNumber d = denominator.sign() < 0 ? -denominator : denominator;
  constexpr float infinity = std::numeric_limits<float>::infinity();
  const auto wide = [](float x) { return x == infinity ? 0x1p128 : double{x}; };
  const auto is_odd = [](float x) { return (std::bit_cast<std::uint32_t>(x) & 1) != 0; };
  // Next to the right one already. Now it moves until the quotient is within half a step of it.
  auto quotient = static_cast<float>(n.approximation() / d.approximation());
  while (quotient > 0) {
    const float below = std::nextafter(quotient, 0.0f);
    const int side = (n - ExactNumber((wide(quotient) + wide(below)) / 2) * d).sign();
    if (side > 0 || (side == 0 && !is_odd(quotient))) break;
    quotient = below;
  }
  while (quotient < infinity) {
    const float above = std::nextafter(quotient, infinity);
    const int side = (n - ExactNumber((wide(quotient) + wide(above)) / 2) * d).sign();
    if (side < 0 || (side == 0 && !is_odd(quotient))) break;
    quotient = above;
  }
  return quotient > 0 && numerator.sign() != denominator.sign() ? -quotient : quotient;
}

}  // namespace tandem::cpu::exact
