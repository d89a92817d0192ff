// Instructions in the wide form: once for all lanes where their operands are common, in lanes where there is a way to
// say it, else from lane to lane.

#include <algorithm>
#include <iterator>
#include <string_view>

#include <fmt/format.h>

#include "rhi_cpu/translate/printer.hpp"

namespace tandem::cpu {

using spirv_cross::SPIRExpression;
using spirv_cross::SPIRType;
using spirv_cross::SPIRVariable;

namespace {

/// Functions of kernel/ that are not templates over GLM's vectors, or branch on a component.
constexpr std::string_view narrow_functions[] = {
    "determinant",      "inverse",           "refract",           "face_forward",     "quantize_to_half",
    "pack_snorm_4x8",   "pack_unorm_4x8",    "pack_snorm_2x16",   "pack_unorm_2x16",  "pack_half_2x16",
    "pack_double_2x32", "unpack_snorm_2x16", "unpack_unorm_2x16", "unpack_half_2x16", "unpack_snorm_4x8",
    "unpack_unorm_4x8", "unpack_double_2x32"};

bool is_narrow_function(std::string_view name) {
  return std::find(std::begin(narrow_functions), std::end(narrow_functions), name) != std::end(narrow_functions);
}

/// Sets a variable, until the end of its own scope.
template <typename T>
class Restored {
 public:
  Restored(T& variable, T value) : variable_(variable), before_(variable) { variable_ = std::move(value); }
  ~Restored() { variable_ = std::move(before_); }
  Restored(const Restored&) = delete;
  Restored& operator=(const Restored&) = delete;

 private:
  T& variable_;
  T before_;
};

}  // namespace

bool Printer::varies(std::uint32_t id) const { return uniformity_.varying.contains(id); }

bool Printer::has_varying_contents(std::uint32_t pointer_id) const {
  return uniformity_.varying_contents.contains(root_variable(pointer_id));
}

std::string Printer::numbers_name(BaseType base, std::uint32_t length) const {
  const std::string name = vector_name(base, length);
  return mode_ == Mode::wide ? fmt::format("k::wide_t<{}>", name) : name;
}

std::string Printer::in_mode(std::uint32_t id, std::string text) {
  if (mode_ == Mode::common) return text;
  const Type& type = type_of(id);
  const bool is_place = is_pointer(type) && !is_buffer_pointer(id);
  if (is_place || is_descriptor(type)) return text;
  if (mode_ == Mode::wide) return varies(id) ? text : fmt::format("k::spread({})", text);
  return varies(id) && id != lane_result_ ? fmt::format("k::lane({}, lane)", text) : text;
}

void Printer::define_wide(std::uint32_t type_id, std::uint32_t id, const std::string& text) {
  const std::string name = fmt::format("v_{}", id);
  if (mode_ == Mode::lane && is_descriptor(get<Type>(type_id))) {
    // What the text says of a lane can be said wherever the descriptor is used.
    set<SPIRExpression>(id, fmt::format("({})", text), type_id, true);
    return;
  }
  if (mode_ == Mode::lane) {
    statement(narrow_name(get<Type>(type_id)), " l_", id, " = ", text, ";");
    set<SPIRExpression>(id, fmt::format("l_{}", id), type_id, true);
    return;
  }
  if (!escapes_.contains(id))
    statement(type_name(type_id), " ", name, " = ", text, ";");
  else if (mode_ == Mode::wide)
    statement("k::assign(", mask_, ", ", name, ", ", type_name(type_id), "(", text, "));");
  else
    statement(name, " = ", text, ";");
  set<SPIRExpression>(id, name, type_id, true);
}

bool Printer::is_wide_operation(const Instruction& i) {
  if (const Operation* operation = find_operation(i.op())) {
    switch (operation->shape) {
      case Shape::infix:
      case Shape::prefix:
      case Shape::relation:
      case Shape::shift:
      case Shape::ray_query_getter:
      case Shape::statement:
        return true;
      case Shape::conversion:
        return get<Type>(i.result_type()).basetype != SPIRType::Half ||
               type_of(i.operand(0)).basetype != SPIRType::Half;
      case Shape::call:
        return !is_narrow_function(operation->text);
      default:
        return false;
    }
  }
  switch (i.op()) {
    case spv::OpCompositeConstruct:
    case spv::OpCompositeExtract:
    case spv::OpCompositeInsert:
    case spv::OpVectorShuffle:
    case spv::OpCopyObject:
    case spv::OpExpectKHR:
      return true;
    case spv::OpBitcast: {
      const Type &to = get<Type>(i.result_type()), &from = type_of(i.operand(0));
      return !is_pointer(to) && !is_pointer(from) && to.width == from.width && to.basetype != SPIRType::Half &&
             from.basetype != SPIRType::Half;
    }
    case spv::OpExtInst: {
      const ExtendedInstruction* extended = find_extended(i.operand(1));
      const bool splits = extended == nullptr ||
                          (extended->shape != ExtendedShape::function && extended->shape != ExtendedShape::bit_search);
      if (splits || is_narrow_function(extended->function)) return false;
      // Their twins for plain numbers go by comparisons.
      const bool is_scalar = type_of(i.operand(2)).vecsize == 1;
      return !is_scalar || (extended->instruction != GLSLstd450Length && extended->instruction != GLSLstd450Normalize &&
                            extended->instruction != GLSLstd450Reflect && extended->instruction != GLSLstd450Distance);
    }
    case spv::OpControlBarrier:
      return true;
    case spv::OpImageRead:
    case spv::OpImageWrite:
    case spv::OpImageFetch:
    case spv::OpImageGather:
    case spv::OpImageSampleExplicitLod:
    case spv::OpImageSampleProjExplicitLod:
      return is_wide_image_operation(i);
    default:
      return is_subgroup_operation(i.op()) && !is_ballot_query(i.op());
  }
}

void Printer::print_wide_instruction(const Instruction& i) {
  switch (i.op()) {
    case spv::OpNop:
    case spv::OpNoLine:
    case spv::OpLine:
    case spv::OpAssumeTrueKHR:
      return;
    case spv::OpAccessChain:
    case spv::OpInBoundsAccessChain:
      return print_wide_chain(i);
    case spv::OpPtrAccessChain: {
      const Mode differs = is_buffer_pointer(i.operand(0)) ? Mode::wide : Mode::lane;
      const Restored mode(mode_, varies(i.result()) ? differs : Mode::common);
      return print_pointer_access_chain(i);
    }
    case spv::OpLoad:
      return print_wide_load(i);
    case spv::OpStore:
      return print_wide_store(i);
    case spv::OpFunctionCall:
      return print_wide_call(i);
    default:
      break;
  }
  if (i.has_result() && varies(i.result()) && is_descriptor(get<Type>(i.result_type()))) {
    const Restored mode(mode_, Mode::lane);
    return print_instruction(i);
  }
  bool is_common = !i.has_result() || !varies(i.result());
  for (const std::uint32_t word : i.ids()) {
    is_common &= !varies(word);
    // A result that depends on a variable varies already; here a literal may look like the id of one.
    if (const auto* variable = i.has_result() ? nullptr : maybe_get<SPIRVariable>(root_variable(word)))
      is_common &= !uniformity_.varying_contents.contains(variable->self);
  }
  if (is_common) {
    const Restored mode(mode_, Mode::common);
    return print_instruction(i);
  }
  if (is_wide_operation(i)) {
    const Restored mode(mode_, Mode::wide);
    return print_instruction(i);
  }
  print_by_lane(i, [&] { print_instruction(i); });
}

void Printer::print_by_lane(const Instruction& i, const std::function<void()>& print) {
  const Type* type = i.has_result() ? &get<Type>(i.result_type()) : nullptr;
  const bool has_value =
      type != nullptr && type->basetype != SPIRType::Void && (!is_pointer(*type) || is_buffer(type->storage));
  const std::string name = has_value ? fmt::format("v_{}", i.result()) : "";
  if (has_value && !escapes_.contains(i.result()))
    statement("k::wide_t<", narrow_name(get<Type>(i.result_type())), "> ", name, ";");
  statement("for (const int lane : k::EachLane(", mask_, ")) {");
  {
    const Restored mode(mode_, Mode::lane);
    const Restored result(lane_result_, i.has_result() ? i.result() : 0);
    print();
  }
  if (has_value) {
    statement("k::set_lane(", name, ", lane, ", to_expression(i.result()), ");");
    set<SPIRExpression>(i.result(), name, i.result_type(), true);
  }
  statement("}");
}

void Printer::print_wide_chain(const Instruction& i) {
  if (!varies(i.result())) {
    const Restored mode(mode_, Mode::common);
    return print_access_chain(i);
  }
  if (!is_buffer_pointer(i.operand(0))) {
    keep_shared_offsets(i);
    const Restored mode(mode_, Mode::lane);
    return print_access_chain(i);
  }
  // Where the array of buffers is indexed.
  bool is_one_buffer = true;
  if (address_of(i.operand(0)).bytes.empty()) {
    std::size_t k = 1;
    for (const Type* type = &get<Type>(pointee(expression_type_id(i.operand(0))));
         is_array(*type) && k < i.operand_count(); type = &get<Type>(type->parent_type))
      is_one_buffer &= !varies(i.operand(k++));
  }
  const Restored mode(mode_, is_one_buffer ? Mode::wide : Mode::lane);
  print_access_chain(i);
}

void Printer::keep_addresses(std::uint32_t id, Address& address) {
  const std::string name = fmt::format("a_{}", id);
  if (escapes_.contains(id))
    statement("k::assign(", mask_, ", ", name, ", k::Addresses(", address.bytes, "));");
  else
    statement("const k::Addresses ", name, " = ", address.bytes, ";");
  address.bytes = name;
  address.varies = true;
}

void Printer::print_wide_load(const Instruction& i) {
  const std::uint32_t pointer = i.operand(0);
  const Type& type = get<Type>(i.result_type());
  if (is_buffer_pointer(pointer)) {
    if (!varies(pointer)) {
      // Where it escapes, lanes keep what they had when they left the loop.
      const Restored mode(mode_, Mode::common);
      const std::string text = guarded_load(i.result_type(), address_of(pointer));
      if (!varies(i.result())) return define(i, text);
      mode_ = Mode::wide;
      return define(i, fmt::format("k::spread({})", text));
    }
    Address address = address_of(pointer);
    if (address.by_lane) return print_by_lane(i, [&] { print_load(i); });
    const std::string addresses = address.bytes;
    std::string text;
    {
      const Restored mode(mode_, Mode::common);
      address.bytes = "at";
      address.varies = false;
      text = guarded_load(i.result_type(), address);
    }
    const Restored mode(mode_, Mode::wide);
    const std::string read = fmt::format("[&](const std::byte* at) {{ return {}; }}", text);
    if (!has_register(type))
      return define(i, fmt::format("k::gather(k::readable({}, {}), {})", mask_, addresses, read));
    // The lambda has the offset.
    address.bytes = addresses;
    const std::string first = printed(address);
    if (address.offset != 0)
      return define(i,
                    fmt::format("k::gather_numbers<{}>({}, k::Addresses({}), {}, [&](const std::byte* from) {{ const "
                                "std::byte* at = from - {}; return {}; }})",
                                narrow_name(type), mask_, first, bounds(address), address.offset, text));
    return define(i, fmt::format("k::gather_numbers<{}>({}, {}, {}, {})", narrow_name(type), mask_, first,
                                 bounds(address), read));
  }
  if (is_descriptor(type) || type_is_opaque_value(type)) {
    const Restored mode(mode_, varies(pointer) ? Mode::lane : Mode::common);
    return print_load(i);
  }
  if (const auto shared = shared_offsets_.find(pointer); shared != shared_offsets_.end()) {
    const Restored mode(mode_, Mode::wide);
    return define(i, fmt::format("k::load_shared<{}>({}, {})", narrow_name(type), mask_, shared->second));
  }
  if (varies(pointer)) {
    return print_by_lane(i, [&] {
      const std::string place = place_at(pointer);
      define(i, has_varying_contents(pointer) ? fmt::format("k::lane({}, lane)", place) : place);
    });
  }
  const bool is_wide_place = has_varying_contents(pointer);
  if (!is_wide_place && varies(i.result())) {
    const Restored mode(mode_, Mode::wide);
    return define(i, fmt::format("k::spread({})", place_at(pointer)));
  }
  const Restored mode(mode_, is_wide_place ? Mode::wide : Mode::common);
  define(i, place_at(pointer));
}

bool Printer::has_register(const Type& type) const {
  return !is_array(type) && !is_pointer(type) && type.vecsize == 1 && type.columns == 1 &&
         (is_integer(type.basetype) || type.basetype == SPIRType::Float || type.basetype == SPIRType::Double);
}

std::string Printer::bounds(const Address& address) const {
  return is_guarded(address) ? fmt::format("k::Bounds{{{}, {}}}", address.data, address.size) : "k::Bounds{}";
}

void Printer::print_store_in_rows(const Instruction& i) {
  const std::uint32_t pointer = i.operand(0);
  const Type& type = type_of(i.operand(1));
  const Address address = address_of(pointer);
  if (address.by_lane || !has_register(type)) return;
  const Restored mode(mode_, Mode::wide);
  statement("if (!k::stored_in_rows<", narrow_name(type), ">(", mask_, ", k::Addresses(", printed(address), "), ",
            bounds(address), ", ", value(i.operand(1)), "))");
}

void Printer::print_wide_store(const Instruction& i) {
  const std::uint32_t pointer = i.operand(0), stored = i.operand(1);
  const bool differs = varies(pointer) || varies(stored);
  if (is_buffer_pointer(pointer)) {
    if (varies(pointer)) print_store_in_rows(i);
    if (differs) return print_by_lane(i, [&] { print_store(i); });
    const Restored mode(mode_, Mode::common);
    return print_store(i);
  }
  if (const auto shared = shared_offsets_.find(pointer); shared != shared_offsets_.end()) {
    const Restored mode(mode_, Mode::wide);
    return statement("k::store_shared<", narrow_name(type_of(stored)), ">(", mask_, ", ", shared->second, ", ",
                     value(stored), ");");
  }
  if (varies(pointer))
    return print_by_lane(i, [&] {
      if (has_varying_contents(pointer))
        statement("k::set_lane(", place_at(pointer), ", lane, ", value(stored), ");");
      else
        statement(place_at(pointer), " = ", value(stored), ";");
    });
  const bool is_wide_place = has_varying_contents(pointer);
  // Memory that lanes share: the last one to write leaves its value.
  if (!is_wide_place && varies(stored))
    return print_by_lane(i, [&] { statement(place_at(pointer), " = ", value(stored), ";"); });
  const Restored mode(mode_, is_wide_place ? Mode::wide : Mode::common);
  if (is_wide_place)
    statement("k::assign(", mask_, ", ", place_at(pointer), ", ", value(stored), ");");
  else
    statement(place_at(pointer), " = ", value(stored), ";");
}

void Printer::print_wide_call(const Instruction& i) {
  const std::uint32_t function = i.operand(0);
  const auto& parameters = get<spirv_cross::SPIRFunction>(function).arguments;
  std::string arguments = mask_;
  for (std::size_t k = 1; k < i.operand_count(); ++k) {
    const std::uint32_t argument = i.operand(k);
    const Type& type = type_of(argument);
    arguments += ", ";
    const Restored mode(mode_, varies(parameters[k - 1].id) ? Mode::wide : Mode::common);
    if (is_pointer(type) && type.storage == spv::StorageClassUniformConstant) {
      if (varies(argument)) fail("a descriptor that differs between invocations as argument, in the wide form");
      arguments += descriptor_value(argument);
    } else if (is_buffer_pointer(argument)) {
      const std::string text = pointer_value(argument);
      arguments += mode_ == Mode::wide ? fmt::format("k::wide_t<std::byte*>({})", text) : text;
    } else if (is_pointer(type)) {
      if (varies(argument)) fail("a place that differs between invocations as argument, in the wide form");
      arguments += is_shared_pointer(type) ? value(argument) : to_expression(argument);
    } else {
      arguments += value(argument);
    }
  }
  const std::string text = fmt::format("{}({})", to_name(function), arguments);
  if (get<Type>(i.result_type()).basetype == SPIRType::Void) return statement(text, ";");
  const bool returns_lanes = uniformity_.varying_functions.contains(function);
  const Restored mode(mode_, varies(i.result()) ? Mode::wide : Mode::common);
  define(i, returns_lanes || !varies(i.result()) ? text : fmt::format("k::spread({})", text));
}

}  // namespace tandem::cpu
