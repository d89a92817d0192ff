#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "rhi_cpu/translate/names/identifiers.hpp"
#include "rhi_cpu/translate/printer.hpp"

namespace tandem::cpu {

using spirv_cross::SPIRConstant;
using spirv_cross::SPIRType;

std::uint32_t Printer::array_length(const Type& type) const {
  if (!type.array_size_literal.back()) fail("an array whose length is no plain constant");
  return type.array.back();
}

bool Printer::is_opaque(const Type& type) const { return type.basetype == SPIRType::RayQuery || is_descriptor(type); }

bool Printer::has_halves() const {
  bool found = false;
  ir.for_each_typed_id<Type>([&](std::uint32_t, const Type& type) { found |= type.basetype == Type::Half; });
  return found;
}

std::string Printer::type_name(const Type& type) {
  return mode_ == Mode::wide ? fmt::format("k::wide_t<{}>", narrow_name(type)) : narrow_name(type);
}

std::string Printer::narrow_name(const Type& type) {
  if (is_shared_pointer(type)) return narrow_name(get<Type>(type.parent_type)) + "*";
  if (is_pointer(type)) {
    const bool is_writable =
        type.storage != spv::StorageClassPushConstant && type.storage != spv::StorageClassShaderRecordBufferKHR;
    if (!is_in_memory(type.storage) || !is_writable) fail("a pointer as a value");
    return "std::byte*";
  }
  if (is_array(type))
    return fmt::format("k::Array<{}, {}>", narrow_name(get<Type>(type.parent_type)), array_length(type));
  switch (type.basetype) {
    case SPIRType::Struct:
      return struct_name(type);
    case SPIRType::RayQuery:
      return "k::rayQueryEXT";
    case SPIRType::AccelerationStructure:
      return "k::accelerationStructureEXT";
    case SPIRType::Image:
    case SPIRType::Sampler:
    case SPIRType::SampledImage:
      return is_combined(type) ? "k::SampledImage" : fmt::format("const {}*", descriptor_target(type));
    default:
      break;
  }
  if (type.columns == 1) return vector_name(type.basetype, type.vecsize);
  if (type.basetype == SPIRType::Float) return fmt::format("k::mat{}x{}", type.columns, type.vecsize);
  return fmt::format("k::matrix<{}, {}, {}>", type.columns, type.vecsize, scalar_name(type.basetype));
}

std::vector<std::string> Printer::member_names(const Type& type) const {
  std::vector<std::string> names;
  for (std::uint32_t i = 0; i < type.member_types.size(); ++i) {
    const std::string& given = get_member_name(type.self, i);
    std::string name = given.empty() ? fmt::format("member{}", i) : identifier(given);
    while (std::find(names.begin(), names.end(), name) != names.end()) name += std::to_string(i);
    names.push_back(std::move(name));
  }
  return names;
}

std::string Printer::struct_name(const Type& type) {
  const std::uint32_t id = type.self;
  if (const auto known = struct_names_.find(id); known != struct_names_.end()) return known->second;

  // GLSL's one struct is one SPIR-V type per memory layout; as a value they are the same C++ type.
  const std::vector<std::string> names = member_names(type);
  std::string members;
  for (std::uint32_t i = 0; i < names.size(); ++i)
    members += fmt::format("  {} {};\n", narrow_name(get<Type>(type.member_types[i])), names[i]);
  const std::string& given = get_name(id);
  std::string base = given.empty() ? "" : "_" + given;
  const auto [place, inserted] = structs_.try_emplace(base + members, fmt::format("struct{}_{}", base, id));
  if (inserted && !is_wide()) struct_declarations_ += fmt::format("struct {} {{\n{}}};\n\n", place->second, members);
  if (inserted && is_wide()) struct_declarations_ += wide_struct(place->second, members, type);
  return struct_names_[id] = place->second;
}

std::string Printer::wide_struct(const std::string& name, const std::string& members, const Type& type) {
  const std::vector<std::string> names = member_names(type);
  std::string wide, lane, set_lane, select;
  for (std::uint32_t i = 0; i < names.size(); ++i) {
    wide += fmt::format("  k::wide_t<{}> {};\n", narrow_name(get<Type>(type.member_types[i])), names[i]);
    lane += fmt::format("{}k::lane({}, lane_)", i == 0 ? "" : ", ", names[i]);
    set_lane += fmt::format(" k::set_lane({0}, lane_, value_.{0});", names[i]);
    select += fmt::format("{0}k::select(mask_, a_.{1}, b_.{1})", i == 0 ? "" : ", ", names[i]);
  }
  return fmt::format(
      "struct {0}_wide;\nstruct {0} {{\n  using Wide = {0}_wide;\n{1}}};\nstruct {0}_wide {{\n  using Narrow = "
      "{0};\n{2}"
      "  {0} lane(int lane_) const {{ return {{{3}}}; }}\n"
      "  void set_lane(int lane_, const {0}& value_) {{{4} }}\n"
      "  static {0}_wide select(k::Mask mask_, const {0}_wide& a_, const {0}_wide& b_) {{ return {{{5}}}; }}\n}};\n\n",
      name, members, wide, lane, set_lane, select);
}

std::string Printer::scalar_text(const SPIRConstant& constant, BaseType base, std::uint32_t column,
                                 std::uint32_t row) const {
  const auto number = [](auto x, const char* suffix) {
    if (std::isnan(x) || std::isinf(x)) return std::string();
    std::string text = fmt::format("{}", x);
    if (text.find_first_of(".e") == std::string::npos) text += ".0";
    text += suffix;
    return std::signbit(x) ? "(" + text + ")" : text;
  };
  const auto signed_number = [](std::int64_t x) { return x < 0 ? fmt::format("({})", x) : fmt::format("{}", x); };
  switch (base) {
    case SPIRType::Boolean:
      return constant.scalar(column, row) != 0 ? "true" : "false";
    case SPIRType::SByte:
      return fmt::format("std::int8_t({})", constant.scalar_i8(column, row));
    case SPIRType::UByte:
      return fmt::format("std::uint8_t({})", constant.scalar_u8(column, row));
    case SPIRType::Short:
      return fmt::format("std::int16_t({})", constant.scalar_i16(column, row));
    case SPIRType::UShort:
      return fmt::format("std::uint16_t({})", constant.scalar_u16(column, row));
    case SPIRType::Int:
      if (constant.scalar_i32(column, row) == INT32_MIN) return "(-2147483647 - 1)";
      return signed_number(constant.scalar_i32(column, row));
    case SPIRType::UInt:
      return fmt::format("{}u", constant.scalar(column, row));
    case SPIRType::Int64:
      if (constant.scalar_i64(column, row) == INT64_MIN) return "std::int64_t(-9223372036854775807 - 1)";
      return fmt::format("std::int64_t({})", constant.scalar_i64(column, row));
    case SPIRType::UInt64:
      return fmt::format("std::uint64_t({}u)", constant.scalar_u64(column, row));
    case SPIRType::Half:
      return fmt::format("k::half::from_bits({:#x})", constant.scalar_u16(column, row));
    case SPIRType::Float: {
      const std::string text = number(constant.scalar_f32(column, row), "f");
      return !text.empty() ? text : fmt::format("k::bit_cast<float>({:#x}u)", constant.scalar(column, row));
    }
    case SPIRType::Double: {
      const std::string text = number(constant.scalar_f64(column, row), "");
      return !text.empty() ? text
                           : fmt::format("k::bit_cast<double>(std::uint64_t({:#x}))", constant.scalar_u64(column, row));
    }
    default:
      fail("a constant of " + scalar_name(base));
  }
}

std::string Printer::constant_text(const SPIRConstant& constant) {
  const Type& type = get<Type>(constant.constant_type);
  if (is_pointer(type)) return fmt::format("static_cast<{}>(nullptr)", type_name(type));
  if (type.vecsize == 1 && type.columns == 1) return scalar_text(constant, type.basetype, 0, 0);
  std::string elements;
  for (std::uint32_t column = 0; column < type.columns; ++column)
    for (std::uint32_t row = 0; row < type.vecsize; ++row)
      elements += (elements.empty() ? "" : ", ") + scalar_text(constant, type.basetype, column, row);
  return fmt::format("{}({})", type_name(type), elements);
}

std::string Printer::constant_initializer(const SPIRConstant& constant) {
  const Type& type = get<Type>(constant.constant_type);
  if (is_pointer(type) || (!is_array(type) && type.basetype != SPIRType::Struct)) return constant_text(constant);
  std::string elements;
  for (const auto& id : constant.subconstants)
    elements += (elements.empty() ? "" : ", ") + constant_initializer(get<SPIRConstant>(id));
  return fmt::format("{}{{{}}}", type_name(type), is_array(type) ? "{" + elements + "}" : elements);
}

const SPIRType& Printer::element_type(const Type& type, std::uint32_t index) const {
  if (is_array(type) || type.basetype != SPIRType::Struct) return get<Type>(type.parent_type);
  return get<Type>(type.member_types[index]);
}

std::string Printer::element(const std::string& composite, const Type& type, std::uint32_t index) const {
  if (is_array(type) || (type.basetype != SPIRType::Struct && type.columns > 1))
    return fmt::format("{}[{}]", composite, index);
  if (type.basetype == SPIRType::Struct) return fmt::format("{}.{}", composite, member_names(type).at(index));
  // No rule of SPIR-V forbids such a constant.
  if (index >= type.vecsize) fail(fmt::format("component {} of a vector of {}", index, type.vecsize));
  return fmt::format("{}.{}", composite, "xyzw"[index]);
}

}  // namespace tandem::cpu
