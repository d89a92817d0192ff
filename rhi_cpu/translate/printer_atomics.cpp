#include <fmt/format.h>

#include "rhi_cpu/translate/printer.hpp"

namespace tandem::cpu {
namespace {

/// Operands of an atomic instruction: the pointer, a scope and memory semantics come first; OpAtomicCompareExchange has
/// two of the latter, OpAtomicStore has no result.
constexpr std::size_t pointer = 0;
constexpr std::size_t first_value = 3;

}  // namespace

std::string Printer::atomic_call(const Instruction& i, const char* function, BaseType base,
                                 const std::string& arguments) {
  const std::uint32_t type_id = pointee(expression_type_id(i.operand(pointer)));
  if (is_shared_pointer(i.operand(pointer)))
    return fmt::format("k::atomic_{}<{}>(reinterpret_cast<std::byte*>({}){})", function, scalar_name(base),
                       value(i.operand(pointer)), arguments);
  return fmt::format("k::atomic_{}<{}>({}{})", function, scalar_name(base),
                     guarded_pointer(type_id, address_of(i.operand(pointer))), arguments);
}

BaseType Printer::atomic_component(const Instruction& i) {
  const std::uint32_t pointer_id = i.operand(pointer);
  if (!is_buffer_pointer(pointer_id) && type_of(pointer_id).storage != spv::StorageClassImage &&
      !is_shared_pointer(pointer_id))
    fail("an atomic operation outside of buffers, images and shared variables");
  return get<Type>(pointee(expression_type_id(pointer_id))).basetype;
}

void Printer::print_atomic(const Instruction& i, const Operation& operation) {
  const BaseType base = with_sign(atomic_component(i), operation.sign);
  // OpAtomicIIncrement and OpAtomicIDecrement have no value.
  const std::string argument = i.operand_count() > first_value ? value_as(i.operand(first_value), base) : "1";
  define_as(i, atomic_call(i, operation.text, base, ", " + argument), base);
}

void Printer::print_atomic_load(const Instruction& i) { define(i, atomic_call(i, "load", atomic_component(i), "")); }

void Printer::print_atomic_store(const Instruction& i) {
  statement(atomic_call(i, "store", atomic_component(i), ", " + value(i.operand(first_value))), ";");
}

void Printer::print_compare_exchange(const Instruction& i) {
  const BaseType base = atomic_component(i);
  const std::string desired = value_as(i.operand(first_value + 1), base);
  const std::string expected = value_as(i.operand(first_value + 2), base);
  define_as(i, atomic_call(i, "compare_exchange", base, ", " + expected + ", " + desired), base);
}

}  // namespace tandem::cpu
