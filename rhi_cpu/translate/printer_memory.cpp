#include <utility>

#include <fmt/format.h>

#include "rhi_cpu/translate/printer.hpp"

namespace tandem::cpu {

using spirv_cross::SPIRConstant;
using spirv_cross::SPIRExpression;
using spirv_cross::SPIRType;
using spirv_cross::SPIRVariable;

namespace {

std::uint32_t scalar_size(const SPIRType& type) { return type.width / 8; }

}  // namespace

bool Printer::is_buffer_pointer(std::uint32_t id) {
  return is_in_memory(type_of(id).storage) && is_pointer(type_of(id));
}

std::uint32_t Printer::matrix_stride(std::uint32_t struct_type_id, std::uint32_t member) const {
  if (!has_member_decoration(struct_type_id, member, spv::DecorationMatrixStride)) return 0;
  return type_struct_member_matrix_stride(get<Type>(struct_type_id), member);
}

std::uint32_t Printer::pointee(std::uint32_t pointer_type_id) const { return get<Type>(pointer_type_id).parent_type; }

Address Printer::address_of(std::uint32_t pointer_id) {
  if (const auto known = addresses_.find(pointer_id); known != addresses_.end()) {
    Address address = known->second;
    if (address.varies && mode_ == Mode::lane) address.bytes = fmt::format("k::lane({}, lane)", address.bytes);
    return address;
  }
  const auto* variable = maybe_get<SPIRVariable>(pointer_id);
  if (variable == nullptr || variable->phi_variable) return address_in(pointer_id);
  const auto known = [](const char* name, std::uint32_t size) {
    return Address{.bytes = name, .resource = "", .data = name, .size = std::to_string(size)};
  };
  if (variable->storage == spv::StorageClassPushConstant)
    return known("push_constants", reflection_.push_constant_size);
  if (variable->storage == spv::StorageClassShaderRecordBufferKHR)
    return known("shader_record", reflection_.shader_record_size);
  const std::string name = to_name(pointer_id);
  if (variable->storage == spv::StorageClassWorkgroup && variable->parameter == nullptr)
    return known(name.c_str(), workgroup_memory_);
  if (is_array(get<Type>(pointee(variable->basetype)))) return {.bytes = "", .resource = name};
  const bool is_bound = binding_of(pointer_id) != nullptr;
  return {.bytes = name,
          .resource = fmt::format("resources[{}]", first_resource_of(pointer_id)),
          .data = is_bound ? name : "",
          .size = name + "_size"};
}

Address Printer::address_in(std::uint32_t pointer_id) {
  const auto* phi = is_wide() ? maybe_get<SPIRVariable>(pointer_id) : nullptr;
  const std::string text = phi != nullptr ? fmt::format("v_{}", pointer_id) : to_expression(pointer_id);
  const bool differs = is_wide() && varies(pointer_id);
  return {.bytes = differs && mode_ == Mode::lane ? fmt::format("k::lane({}, lane)", text) : text,
          .resource = "",
          .varies = differs};
}

std::string Printer::printed(const Address& address) const {
  return address.offset == 0 ? address.bytes : fmt::format("{} + {}", address.bytes, address.offset);
}

void Printer::index_address(Address& address, std::uint32_t index_id, std::uint32_t stride) {
  if (const auto* constant = maybe_get<SPIRConstant>(index_id))
    address.offset += constant->scalar() * stride;
  else
    address.bytes += fmt::format(" + {}({}) * {}", mode_ == Mode::wide ? "k::Lanes<std::uint64_t>" : "std::size_t",
                                 value(index_id), stride);
}

void Printer::print_access_chain(const Instruction& i) {
  if (is_buffer_pointer(i.operand(0)))
    chain_in_buffer(i, address_of(i.operand(0)), 1);
  else
    chain_in_variable(i);
}

void Printer::chain_in_buffer(const Instruction& i, Address address, std::size_t first_index) {
  std::uint32_t type_id = pointee(expression_type_id(i.operand(0)));
  std::size_t k = first_index;
  if (address.bytes.empty() && k < i.operand_count()) {
    address.resource = descriptor_element(i, k, type_id);
    address.bytes = address.data = address.resource + ".data";
    address.size = address.resource + ".size";
  }
  const Type* type = &get<Type>(type_id);
  if (mode_ == Mode::lane) address.by_lane = true;
  for (; k < i.operand_count(); ++k) {
    const std::uint32_t index = i.operand(k);
    address.array_stride = is_array(*type) ? get_decoration(type_id, spv::DecorationArrayStride) : 0;
    if (is_array(*type)) {
      index_address(address, index, address.array_stride);
      type_id = type->parent_type;
    } else if (type->basetype == SPIRType::Struct) {
      const std::uint32_t member = get<SPIRConstant>(index).scalar();
      const std::uint32_t self = type->self;
      address.offset += get_member_decoration(self, member, spv::DecorationOffset);
      address.matrix_stride = matrix_stride(self, member);
      address.row_major = has_member_decoration(self, member, spv::DecorationRowMajor);
      type_id = type->member_types[member];
    } else if (type->columns > 1) {
      index_address(address, index, address.row_major ? scalar_size(*type) : address.matrix_stride);
      address.component_stride = address.row_major ? address.matrix_stride : 0;
      type_id = type->parent_type;
    } else {
      index_address(address, index, address.component_stride != 0 ? address.component_stride : scalar_size(*type));
      type_id = type->parent_type;
    }
    type = &get<Type>(type_id);
  }
  if (mode_ == Mode::wide) keep_addresses(i.result(), address);
  addresses_[i.result()] = address;
  set<SPIRExpression>(i.result(), fmt::format("({})", printed(address)), i.result_type(), true);
  if (pointer_values_.contains(i.result())) check_pointer_value(i.result(), address);
}

void Printer::chain_in_variable(const Instruction& i) {
  const std::uint32_t base = i.operand(0);
  std::uint32_t type_id = pointee(expression_type_id(base));
  std::string text = place_at(base);
  std::size_t k = 1;
  if (type_of(base).storage == spv::StorageClassUniformConstant && is_array(get<Type>(type_id)))
    text = descriptor_element(i, k, type_id);
  if (i.op() == spv::OpPtrAccessChain)
    text = fmt::format("{}[std::ptrdiff_t({})]", value(base), value_with_sign(i.operand(k++), Sign::as_signed));
  const Type* type = &get<Type>(type_id);
  for (; k < i.operand_count(); ++k) {
    const auto* constant = maybe_get<SPIRConstant>(i.operand(k));
    const std::uint32_t index = constant != nullptr ? constant->scalar() : 0;
    text = constant != nullptr ? element(text, *type, index)
                               : fmt::format("{}[{}]", text, index_inside(*type, value(i.operand(k))));
    type = &element_type(*type, index);
  }
  if (is_shared_pointer(get<Type>(i.result_type()))) text = fmt::format("(&{})", text);
  // Where an OpPhi takes it, what it depends on may have changed.
  if (pointer_values_.contains(i.result())) return define(i, text);
  set<SPIRExpression>(i.result(), text, i.result_type(), true);
}

std::string Printer::descriptor_element(const Instruction& i, std::size_t& k, std::uint32_t& type_id) {
  // An array of arrays is flattened in the order in which its elements are bound. In lanes, print_wide_chain has seen
  // to it that all have the same index.
  const Mode before = std::exchange(mode_, mode_ == Mode::wide ? Mode::common : mode_);
  std::string index;
  for (; is_array(get<Type>(type_id)); ++k, type_id = get<Type>(type_id).parent_type) {
    if (k == i.operand_count()) fail("a pointer to an array of descriptors");
    const std::string next = value(i.operand(k));
    index = index.empty() ? fmt::format("std::size_t({})", next)
                          : fmt::format("({} * {} + {})", index, array_length(get<Type>(type_id)), next);
  }
  mode_ = before;
  const std::string array = to_name(i.operand(0));
  if (!options_.robust) return fmt::format("{}[{}]", array, index);
  return fmt::format("k::element({}, {}, {})", array, descriptor_count(i.operand(0)), index);
}

std::string Printer::load_text(std::uint32_t type_id, const Address& address) {
  const Type& type = get<Type>(type_id);
  const std::string name = type_name(type);
  if (type.columns > 1 && address.matrix_stride == 0) fail("a matrix behind a pointer that does not say its stride");
  if (is_array(type)) {
    const Address element = {
        .bytes = "element", .resource = "", .matrix_stride = address.matrix_stride, .row_major = address.row_major};
    return fmt::format("k::load_array<{}, {}>({}, [](const std::byte* element) {{ return {}; }})", name,
                       get_decoration(type_id, spv::DecorationArrayStride), printed(address),
                       load_text(type.parent_type, element));
  }
  if (is_pointer(type)) return fmt::format("k::load<{}>({})", name, printed(address));
  if (type.basetype == SPIRType::Struct) return fmt::format("load_{}({})", std::uint32_t(type.self), printed(address));
  if (type.columns > 1)
    return fmt::format("k::load_matrix<{}, {}, {}>({})", name, address.matrix_stride, address.row_major,
                       printed(address));
  if (type.vecsize > 1 && address.component_stride != 0)
    return fmt::format("k::load_strided<{}, {}>({})", name, address.component_stride, printed(address));
  return fmt::format("k::load<{}>({})", name, printed(address));
}

std::string Printer::store_text(std::uint32_t type_id, const Address& address, const std::string& value) {
  const Type& type = get<Type>(type_id);
  if (is_array(type)) {
    const Address element = {
        .bytes = "element", .resource = "", .matrix_stride = address.matrix_stride, .row_major = address.row_major};
    return fmt::format("k::store_array<{}, {}>({}, {}, [](std::byte* element, const auto& item) {{ {}; }})",
                       type_name(type), get_decoration(type_id, spv::DecorationArrayStride), printed(address), value,
                       store_text(type.parent_type, element, "item"));
  }
  if (is_pointer(type)) return fmt::format("k::store<{}>({}, {})", type_name(type), printed(address), value);
  if (type.basetype == SPIRType::Struct)
    return fmt::format("store_{}({}, {})", std::uint32_t(type.self), printed(address), value);
  if (type.columns > 1)
    return fmt::format("k::store_matrix<{}, {}, {}>({}, {})", type_name(type), address.matrix_stride, address.row_major,
                       printed(address), value);
  if (type.vecsize > 1 && address.component_stride != 0)
    return fmt::format("k::store_strided<{}, {}>({}, {})", type_name(type), address.component_stride, printed(address),
                       value);
  return fmt::format("k::store<{}>({}, {})", type_name(type), printed(address), value);
}

void Printer::print_struct_memory(std::uint32_t struct_type_id) {
  const Type& type = get<Type>(struct_type_id);
  const std::vector<std::string> names = member_names(type);
  std::string loads, stores;
  for (std::uint32_t i = 0; i < names.size(); ++i) {
    const Address address = {.bytes = "address",
                             .resource = "",
                             .offset = get_member_decoration(struct_type_id, i, spv::DecorationOffset),
                             .matrix_stride = matrix_stride(struct_type_id, i),
                             .row_major = has_member_decoration(struct_type_id, i, spv::DecorationRowMajor)};
    loads += fmt::format("{}\n      {}", i == 0 ? "" : ",", load_text(type.member_types[i], address));
    stores += fmt::format("  {};\n", store_text(type.member_types[i], address, "value." + names[i]));
  }
  const std::string name = struct_name(type);
  statement("inline ", name, " load_", struct_type_id, "(const std::byte* address) {\n  return {", loads, "};\n}");
  statement("inline void store_", struct_type_id, "(std::byte* address, const ", name, "& value) {\n", stores, "}");
  statement("");
}

void Printer::print_struct_memory_functions() {
  // Ids are in order of declaration, and SPIR-V declares a struct after those it contains.
  ir.for_each_typed_id<SPIRType>([&](std::uint32_t id, const Type& type) {
    if (type.basetype != SPIRType::Struct || is_pointer(type) || is_array(type) || std::uint32_t(type.self) != id)
      return;
    if (type.member_types.empty()) return;
    for (std::uint32_t i = 0; i < type.member_types.size(); ++i) {
      const Type& member = get<Type>(type.member_types[i]);
      if (!has_member_decoration(id, i, spv::DecorationOffset) || is_runtime_array(member)) return;
    }
    print_struct_memory(id);
  });
}

void Printer::print_load(const Instruction& i) {
  const std::uint32_t pointer = i.operand(0);
  const Type& type = get<Type>(i.result_type());
  if (is_buffer_pointer(pointer))
    define(i, guarded_load(i.result_type(), address_of(pointer)));
  else if (type_is_opaque_value(type) && !is_array(type))
    // SPIRV-Cross hoists none of these; what the text says can be said wherever the value is used.
    set<SPIRExpression>(i.result(), fmt::format("({})", descriptor_value(pointer)), i.result_type(), true);
  else if (is_descriptor(type) && !is_array(type))
    define(i, descriptor_value(pointer));
  else
    define(i, place_at(pointer));
}

void Printer::print_store(const Instruction& i) { print_store_to(i.operand(0), value(i.operand(1))); }

void Printer::print_copy_memory(const Instruction& i) {
  const std::uint32_t to = i.operand(0), from = i.operand(1);
  if (is_buffer_pointer(from))
    print_store_to(to, guarded_load(pointee(expression_type_id(from)), address_of(from)));
  else
    print_store_to(to, place_at(from));
}

void Printer::print_store_to(std::uint32_t pointer_id, const std::string& text) {
  if (is_buffer_pointer(pointer_id))
    statement(guarded_store(pointee(expression_type_id(pointer_id)), address_of(pointer_id), text), ";");
  else
    statement(place_at(pointer_id), " = ", text, ";");
}

void Printer::print_array_length(const Instruction& i) {
  const std::uint32_t pointer = i.operand(0), member = i.operand(1);
  const Address address = address_of(pointer);
  if (address.resource.empty()) fail("OpArrayLength of a buffer that is a function parameter");
  const Type& type = get<Type>(pointee(expression_type_id(pointer)));
  define(i, fmt::format("k::runtime_array_length({}.size, {}, {})", address.resource,
                        get_member_decoration(type.self, member, spv::DecorationOffset),
                        get_decoration(type.member_types[member], spv::DecorationArrayStride)));
}

}  // namespace tandem::cpu
