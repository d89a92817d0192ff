#include "rhi_cpu/translate/instructions/scalar_types.hpp"

#include <stdexcept>

#include <fmt/format.h>

namespace tandem::cpu {

using spirv_cross::SPIRType;

namespace {

struct Integer {
  BaseType as_signed;
  BaseType as_unsigned;
};

constexpr Integer integers[] = {
    {SPIRType::SByte, SPIRType::UByte},
    {SPIRType::Short, SPIRType::UShort},
    {SPIRType::Int, SPIRType::UInt},
    {SPIRType::Int64, SPIRType::UInt64},
};

const Integer* integer_of(BaseType base) {
  for (const Integer& each : integers)
    if (each.as_signed == base || each.as_unsigned == base) return &each;
  return nullptr;
}

}  // namespace

bool is_integer(BaseType base) { return integer_of(base) != nullptr; }

BaseType with_sign(BaseType base, Sign sign) {
  const Integer* integer = integer_of(base);
  if (integer == nullptr || sign == Sign::any) return base;
  return sign == Sign::as_signed ? integer->as_signed : integer->as_unsigned;
}

std::string scalar_name(BaseType base) {
  switch (base) {
    case SPIRType::Void:
      return "void";
    case SPIRType::Boolean:
      return "bool";
    case SPIRType::SByte:
      return "std::int8_t";
    case SPIRType::UByte:
      return "std::uint8_t";
    case SPIRType::Short:
      return "std::int16_t";
    case SPIRType::UShort:
      return "std::uint16_t";
    case SPIRType::Int:
      return "int";
    case SPIRType::UInt:
      return "k::uint";
    case SPIRType::Int64:
      return "std::int64_t";
    case SPIRType::UInt64:
      return "std::uint64_t";
    case SPIRType::Half:
      return "k::half";
    case SPIRType::Float:
      return "float";
    case SPIRType::Double:
      return "double";
    default:
      throw std::logic_error("a value has components that are no numbers");
  }
}

std::string vector_name(BaseType base, std::uint32_t length) {
  if (length == 1) return scalar_name(base);
  const char* prefix = base == SPIRType::Float     ? ""
                       : base == SPIRType::Int     ? "i"
                       : base == SPIRType::UInt    ? "u"
                       : base == SPIRType::Boolean ? "b"
                       : base == SPIRType::Double  ? "d"
                       : base == SPIRType::Half    ? "f16"
                                                   : nullptr;
  if (prefix == nullptr) return fmt::format("k::vector<{}, {}>", length, scalar_name(base));
  return fmt::format("k::{}vec{}", prefix, length);
}

}  // namespace tandem::cpu
