#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

namespace tandem::cpu::exact {

/// An integer times a power of two: sums and products of floats without any rounding. It holds polynomials of degree
/// seven in floats, whatever their exponents; std::length_error beyond its capacity.
class ExactNumber {
 public:
  ExactNumber() = default;  ///< zero
  /// @param value finite
  ExactNumber(double value);  // NOLINT(google-explicit-constructor): numbers of both kinds are written alike

  /// -1, 0 or 1.
  int sign() const { return size_ == 0 ? 0 : negative_ ? -1 : 1; }

  /// The nearest double or one of its neighbours, for numbers in the range of double.
  double approximation() const;

  ExactNumber operator-() const;
  friend ExactNumber operator+(const ExactNumber& a, const ExactNumber& b);
  friend ExactNumber operator-(const ExactNumber& a, const ExactNumber& b) { return a + -b; }
  friend ExactNumber operator*(const ExactNumber& a, const ExactNumber& b);

 private:
  using Limb = std::uint64_t;
  static constexpr int limb_bits = 64;
  // Terms of degree seven are multiples of 2^(-149 * 7) and below 2^(128 * 7 + 8): 31 limbs, one for the alignment of
  // the lowest, one for a carry, and some that a product has before its zeros are cut off.
  static constexpr int capacity = 40;

  static int checked_size(int size);
  static int compare_magnitudes(const ExactNumber& a, const ExactNumber& b);
  /// The limb that counts 2^(64 * position), 0 where there is none.
  Limb limb_at(int position) const;
  void trim();

  Limb& at(int index) { return limbs_[static_cast<std::size_t>(index)]; }
  Limb at(int index) const { return limbs_[static_cast<std::size_t>(index)]; }

  std::array<Limb, capacity> limbs_{};  ///< from the lowest; neither the first nor the last used one is zero
  int size_ = 0;                        ///< limbs in use
  int exponent_ = 0;                    ///< the first limb counts 2^(64 * exponent_)
  bool negative_ = false;
};

inline std::optional<int> sign_of(const ExactNumber& number) { return number.sign(); }

/// The float nearest to numerator / denominator, ties to even, infinity beyond the largest; never a negative zero.
/// @param denominator not zero
std::optional<float> rounded_quotient(const ExactNumber& numerator, const ExactNumber& denominator);

}  // namespace tandem::cpu::exact
