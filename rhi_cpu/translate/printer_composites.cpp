#include <fmt/format.h>

#include "rhi_cpu/translate/printer.hpp"

namespace tandem::cpu {

using spirv_cross::SPIRType;

void Printer::print_call(const Instruction& i) {
  const std::uint32_t function = i.operand(0);
  std::string arguments;
  for (std::size_t k = 1; k < i.operand_count(); ++k) {
    const std::uint32_t argument = i.operand(k);
    if (k > 1) arguments += ", ";
    const Type& type = type_of(argument);
    if (is_pointer(type) && type.storage == spv::StorageClassUniformConstant) {
      arguments += descriptor_value(argument);
    } else {
      arguments += is_buffer_pointer(argument) ? pointer_value(argument) : value(argument);
    }
  }
  const std::string text = fmt::format("{}({})", to_name(function), arguments);
  if (is_marked_) statement("own_lane.enter(", place_words(), ");");
  if (get<Type>(i.result_type()).basetype == SPIRType::Void)
    statement(text, ";");
  else
    define(i, text);
  if (is_marked_) statement("own_lane.leave(", 2 * marks_.places.at(place_).loops.size() + 1, ");");
  print_call_ending(function);
}

void Printer::print_construct(const Instruction& i) {
  const Type& type = get<Type>(i.result_type());
  const std::string elements = values_with_sign(i, 0, Sign::any);
  if (is_array(type))
    define(i, fmt::format("{}{{{{{}}}}}", type_name(type), elements));
  else if (type.basetype == SPIRType::Struct)
    define(i, fmt::format("{}{{{}}}", type_name(type), elements));
  else
    define(i, fmt::format("{}({})", type_name(type), elements));
}

std::string Printer::part(const std::string& composite, const Type& type, const Instruction& i, std::size_t first) {
  std::string text = composite;
  const Type* part_type = &type;
  for (std::size_t k = first; k < i.operand_count(); ++k) {
    text = element(text, *part_type, i.operand(k));
    part_type = &element_type(*part_type, i.operand(k));
  }
  return text;
}

void Printer::print_extract(const Instruction& i) {
  const std::uint32_t composite = i.operand(0);
  define(i, part(value(composite), type_of(composite), i, 1));
}

void Printer::print_insert(const Instruction& i) {
  define(i, value(i.operand(1)));
  const std::string place = part(value(i.result()), get<Type>(i.result_type()), i, 2);
  statement(place, " = ", value(i.operand(0)), ";");
}

void Printer::print_extract_dynamic(const Instruction& i) {
  define(i, fmt::format("{}[{}]", value(i.operand(0)), value(i.operand(1))));
}

void Printer::print_insert_dynamic(const Instruction& i) {
  define(i, value(i.operand(0)));
  statement(value(i.result()), "[", value(i.operand(2)), "] = ", value(i.operand(1)), ";");
}

void Printer::print_shuffle(const Instruction& i) {
  constexpr std::size_t first_component = 2;
  constexpr std::uint32_t undefined = 0xffffffffu;
  const std::uint32_t a = i.operand(0), b = i.operand(1);
  const std::uint32_t length_of_a = type_of(a).vecsize;
  std::string elements;
  for (std::size_t k = first_component; k < i.operand_count(); ++k) {
    const std::uint32_t component = i.operand(k);
    elements += k == first_component ? "" : ", ";
    if (component == undefined)
      elements += "0";
    else if (component < length_of_a)
      elements += element(value(a), type_of(a), component);
    else
      elements += element(value(b), type_of(b), component - length_of_a);
  }
  define(i, fmt::format("{}({})", type_name(i.result_type()), elements));
}

void Printer::print_copy(const Instruction& i) {
  if (is_buffer_pointer(i.operand(0))) return print_pointer_copy(i);
  define(i, value(i.operand(0)));
}

void Printer::print_copy_logical(const Instruction& i) {
  // Value types do not depend on memory layout; names may differ.
  const std::string to = type_name(i.result_type());
  const std::string operand = value(i.operand(0));
  const bool same = to == type_name(type_of(i.operand(0)));
  define(i, same ? operand : fmt::format("k::bit_cast<{}>({})", to, operand));
}

}  // namespace tandem::cpu
