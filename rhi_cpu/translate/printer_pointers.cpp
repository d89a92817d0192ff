// Pointers into buffers as values: addresses that instructions pick, compare, pass on and count from.

#include <algorithm>

#include <fmt/format.h>

#include "rhi/spirv/names.hpp"
#include "rhi_cpu/translate/printer.hpp"

namespace tandem::cpu {

using spirv_cross::SPIRBlock;
using spirv_cross::SPIRConstant;
using spirv_cross::SPIRExpression;
using spirv_cross::SPIRVariable;

bool Printer::is_pointer_value(std::uint32_t id) { return is_buffer_pointer(id) || is_shared_pointer(id); }

void Printer::set_up_pointers() {
  // Hoisted temporaries can be pointers.
  backend.native_pointers = true;
  // SPIRV-Cross would take the address of a variable that an OpPhi picks; a copy of it is a temporary.
  std::vector<std::uint32_t> blocks;
  ir.for_each_typed_id<SPIRBlock>([&](std::uint32_t id, SPIRBlock&) { blocks.push_back(id); });
  const auto copied = [this](spirv_cross::ID& pointer, SPIRBlock& block) {
    const auto* variable = maybe_get<SPIRVariable>(pointer);
    if (variable == nullptr || variable->phi_variable || !is_pointer_value(pointer)) return;
    const std::uint32_t type = variable->basetype, copy = ir.increase_bound_by(1);
    spirv_cross::Instruction instruction;
    instruction.op = spv::OpCopyObject;
    instruction.offset = static_cast<std::uint32_t>(ir.spirv.size());
    instruction.length = 3;
    ir.spirv.insert(ir.spirv.end(), {type, copy, std::uint32_t(pointer)});
    block.ops.push_back(instruction);
    pointer = copy;
  };
  for (const std::uint32_t id : blocks) {
    for (auto& phi : get<SPIRBlock>(id).phi_variables) {
      spirv_cross::ID pointer = std::uint32_t(phi.local_variable);
      copied(pointer, get<SPIRBlock>(phi.parent));
      phi.local_variable = std::uint32_t(pointer);
      pointer_values_.insert(phi.local_variable);
    }
    SPIRBlock& block = get<SPIRBlock>(id);
    // A variable's name is what it holds.
    if (maybe_get<SPIRVariable>(block.return_value) != nullptr && is_shared_pointer(block.return_value))
      copied(block.return_value, block);
    pointer_values_.insert(block.return_value);
  }
}

void Printer::check_pointer_value(std::uint32_t pointer_id, const Address& address) const {
  const Type* type = &get<Type>(pointee(expression_type_id(pointer_id)));
  while (is_array(*type)) type = &get<Type>(type->parent_type);
  const bool is_column = type->vecsize > 1 && type->columns == 1 && address.component_stride != 0;
  if (type->columns > 1 || is_column) fail("a pointer to a matrix, or to a column of a row-major one, as a value");
}

std::string Printer::pointer_value(std::uint32_t pointer_id) {
  const Address address = address_of(pointer_id);
  if (address.bytes.empty()) fail("a pointer to an array of buffers");
  check_pointer_value(pointer_id, address);
  return printed(address);
}

void Printer::print_pointer_copy(const Instruction& i) {
  const std::uint32_t pointer = i.operand(0);
  const auto* variable = maybe_get<SPIRVariable>(pointer);
  const bool is_place = addresses_.contains(pointer) || (variable != nullptr && !variable->phi_variable);
  if (!is_place || pointer_values_.contains(i.result())) return define(i, pointer_value(pointer));
  // Another name of the same place.
  const Address address = address_of(pointer);
  addresses_[i.result()] = address;
  set<SPIRExpression>(i.result(), fmt::format("({})", printed(address)), i.result_type(), true);
}

void Printer::print_pointer_access_chain(const Instruction& i) {
  const std::uint32_t pointer = i.operand(0), pointer_type = expression_type_id(pointer);
  if (is_shared_pointer(pointer)) return chain_in_variable(i);
  const std::uint32_t stride = get_decoration(pointer_type, spv::DecorationArrayStride);
  if (!is_buffer_pointer(pointer) || stride == 0) fail("OpPtrAccessChain of a pointer without ArrayStride");
  Address address = address_of(pointer);
  if (address.bytes.empty()) fail("a pointer to an array of buffers");
  // The element is a signed number.
  address.bytes += fmt::format(" + std::ptrdiff_t({}) * {}", value_with_sign(i.operand(1), Sign::as_signed), stride);
  chain_in_buffer(i, address, 2);
}

void Printer::print_pointer_relation(const Instruction& i) {
  const std::uint32_t a = i.operand(0), b = i.operand(1);
  if (is_shared_pointer(a)) {
    const char* text = i.op() == spv::OpPtrDiff ? "-" : i.op() == spv::OpPtrEqual ? "==" : "!=";
    return define(i, fmt::format("{}({} {} {})", type_name(i.result_type()), value(a), text, value(b)));
  }
  if (!is_buffer_pointer(a)) fail(rhi::instruction_name(i.op(), i.words()) + " of pointers that point into no buffer");
  // Whatever lies there, the places are compared.
  const Address place = address_of(a), other = address_of(b);
  if (place.bytes.empty() || other.bytes.empty()) fail("a pointer to an array of buffers");
  const std::string difference = fmt::format("({}) - ({})", printed(place), printed(other));
  if (i.op() != spv::OpPtrDiff) return define(i, difference + (i.op() == spv::OpPtrEqual ? " == 0" : " != 0"));
  std::uint32_t stride = get_decoration(expression_type_id(a), spv::DecorationArrayStride);
  if (stride == 0) stride = std::max(place.array_stride, other.array_stride);
  if (stride == 0) fail("OpPtrDiff of pointers without ArrayStride");
  define(i, fmt::format("{}(({}) / {})", type_name(i.result_type()), difference, stride));
}

}  // namespace tandem::cpu
