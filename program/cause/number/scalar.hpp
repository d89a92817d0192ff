#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "program/cause/number/real.hpp"
#include "program/record/components.hpp"

/// The scalars of recorded values, with as many bits as their types have.
namespace tandem::program {

struct RecordedWords;

struct Scalar {
  ComponentKind kind = ComponentKind::unsigned_integer;
  std::uint32_t width = 32;
  std::uint64_t bits = 0;  ///< of a boolean 0 or 1; zeros beyond the width
  bool undefined = false;  ///< of an OpUndef: the bits say nothing
};

using Scalars = std::vector<Scalar>;

/// The bits of an integer of this width.
constexpr std::uint64_t mask_of(std::uint32_t width) {
  return width >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << width) - 1;
}

/// The two's complement number that the low `width` bits are.
constexpr std::int64_t sign_extended(std::uint64_t bits, std::uint32_t width) {
  if (width >= 64) return static_cast<std::int64_t>(bits);
  const std::uint64_t sign = std::uint64_t{1} << (width - 1);
  return static_cast<std::int64_t>(((bits & mask_of(width)) ^ sign) - sign);
}

/// @pre a floating scalar
Real real_of(const Scalar& scalar);

/// A float of this width. @pre the format has the value
Scalar float_scalar(Real value, std::uint32_t width);

inline std::int64_t signed_of(const Scalar& scalar) { return sign_extended(scalar.bits, scalar.width); }

Scalars scalars_of(const RecordedWords& value);

/// The inverse, of a value with these components. Floats of 16 bits are recorded as the equal float of 32 bits.
RecordedWords words_of(const std::vector<Component>& components, std::span<const Scalar> scalars);

}  // namespace tandem::program
