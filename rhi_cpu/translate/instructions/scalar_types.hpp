#pragma once

#include <cstdint>
#include <string>

#include <spirv_cross/spirv_common.hpp>

/// What values consist of: SPIRV-Cross's base types, and their names in a kernel's C++.
namespace tandem::cpu {

using BaseType = spirv_cross::SPIRType::BaseType;

/// SPIR-V's integers have a signedness of their own, and its instructions another: SDiv of two unsigned numbers divides
/// them as signed ones.
enum class Sign : std::uint8_t { any, as_signed, as_unsigned };

bool is_integer(BaseType base);

/// `base` with the signedness that an instruction wants; what is no integer, and with Sign::any everything, stays.
BaseType with_sign(BaseType base, Sign sign);

/// `base` must be void, bool, an integer or a floating-point number; throws std::logic_error else.
std::string scalar_name(BaseType base);

/// The scalar's name for a length of 1.
std::string vector_name(BaseType base, std::uint32_t length);

}  // namespace tandem::cpu
