#include <fmt/format.h>

#include "rhi_cpu/translate/printer.hpp"

namespace tandem::cpu {

using spirv_cross::SPIRType;

void Printer::print_call(Operands ops, std::uint32_t length) {
  std::string arguments;
  for (std::uint32_t i = 3; i < length; ++i) {
    if (i > 3) arguments += ", ";
    const Type& type = type_of(ops[i]);
    if (is_pointer(type) && type.storage == spv::StorageClassUniformConstant) {
      arguments += descriptor_value(ops[i]);
    } else {
      arguments += is_buffer_pointer(ops[i]) ? printed(address_of(ops[i])) : value(ops[i]);
    }
  }
  const std::string text = fmt::format("{}({})", to_name(ops[2]), arguments);
  if (get<Type>(ops[0]).basetype == SPIRType::Void)
    statement(text, ";");
  else
    define(ops[0], ops[1], text);
  print_call_ending(ops[2]);
}

void Printer::print_composite(spv::Op op, Operands ops, std::uint32_t length) {
  const Type& type = get<Type>(ops[0]);
  switch (op) {
    case spv::OpCompositeConstruct: {
      std::string elements;
      for (std::uint32_t i = 2; i < length; ++i) elements += (i == 2 ? "" : ", ") + value(ops[i]);
      if (is_array(type))
        define(ops[0], ops[1], fmt::format("{}{{{{{}}}}}", type_name(type), elements));
      else if (type.basetype == SPIRType::Struct)
        define(ops[0], ops[1], fmt::format("{}{{{}}}", type_name(type), elements));
      else
        define(ops[0], ops[1], fmt::format("{}({})", type_name(type), elements));
      return;
    }
    case spv::OpCompositeExtract: {
      std::string text = value(ops[2]);
      const Type* part = &type_of(ops[2]);
      for (std::uint32_t i = 3; i < length; part = &element_type(*part, ops[i++])) text = element(text, *part, ops[i]);
      define(ops[0], ops[1], text);
      return;
    }
    case spv::OpCompositeInsert: {
      define(ops[0], ops[1], value(ops[3]));
      std::string text = value(ops[1]);
      const Type* part = &type;
      for (std::uint32_t i = 4; i < length; part = &element_type(*part, ops[i++])) text = element(text, *part, ops[i]);
      statement(text, " = ", value(ops[2]), ";");
      return;
    }
    case spv::OpVectorExtractDynamic:
      return define(ops[0], ops[1], fmt::format("{}[{}]", value(ops[2]), value(ops[3])));
    case spv::OpVectorInsertDynamic:
      define(ops[0], ops[1], value(ops[2]));
      statement(value(ops[1]), "[", value(ops[4]), "] = ", value(ops[3]), ";");
      return;
    case spv::OpVectorShuffle: {
      const std::uint32_t first_length = type_of(ops[2]).vecsize;
      std::string elements;
      for (std::uint32_t i = 4; i < length; ++i) {
        elements += i == 4 ? "" : ", ";
        if (ops[i] == 0xffffffffu)
          elements += "0";
        else if (ops[i] < first_length)
          elements += element(value(ops[2]), type_of(ops[2]), ops[i]);
        else
          elements += element(value(ops[3]), type_of(ops[3]), ops[i] - first_length);
      }
      return define(ops[0], ops[1], fmt::format("{}({})", type_name(type), elements));
    }
    case spv::OpCopyLogical: {
      // Value types do not depend on memory layout; names may differ.
      const std::string to = type_name(type);
      const bool same = to == type_name(type_of(ops[2]));
      return define(ops[0], ops[1], same ? value(ops[2]) : fmt::format("k::bit_cast<{}>({})", to, value(ops[2])));
    }
    default:
      return define(ops[0], ops[1], value(ops[2]));
  }
}

}  // namespace tandem::cpu
