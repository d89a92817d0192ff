#include "program/reflect/shader_interface.hpp"

#include <algorithm>
#include <exception>
#include <tuple>
#include <utility>

#include <fmt/format.h>
#include <spirv_cross/spirv_cross.hpp>

#include "rhi/entry_point.hpp"
#include "rhi/error.hpp"
#include "rhi/spirv/reflected.hpp"
#include "rhi/spirv_validation.hpp"

namespace tandem::program {
namespace {

using spirv_cross::SPIRType;
using spirv_cross::TypeID;

class LayoutReader {
 public:
  LayoutReader(const std::vector<std::uint32_t>& words, std::string label)
      : compiler_(rhi::without_composite_nulls(words)), label_(std::move(label)) {}

  void read(ShaderInterface& result) const {
    const spirv_cross::ShaderResources resources = compiler_.get_shader_resources();
    for (const auto* list : {&resources.uniform_buffers, &resources.storage_buffers})
      for (const spirv_cross::Resource& resource : *list)
        result.blocks.push_back({.set = compiler_.get_decoration(resource.id, spv::DecorationDescriptorSet),
                                 .binding = compiler_.get_decoration(resource.id, spv::DecorationBinding),
                                 .block = compiler_.get_name(resource.base_type_id),
                                 .instance = compiler_.get_name(resource.id),
                                 .type = structure(resource.base_type_id)});
    std::ranges::stable_sort(result.blocks, {},
                             [](const BlockLayout& each) { return std::tuple(each.set, each.binding); });
    if (!resources.push_constant_buffers.empty())
      result.push_constants = structure(resources.push_constant_buffers[0].base_type_id);
    if (!resources.shader_record_buffers.empty())
      result.shader_record = structure(resources.shader_record_buffers[0].base_type_id);
    for (const spirv_cross::SpecializationConstant& constant : compiler_.get_specialization_constants())
      result.constants.push_back(constant_layout(constant));
    std::ranges::sort(result.constants, {}, &ConstantLayout::id);
  }

 private:
  ConstantLayout constant_layout(const spirv_cross::SpecializationConstant& constant) const {
    const spirv_cross::SPIRConstant& value = compiler_.get_constant(constant.id);
    const SPIRType& type = compiler_.get_type(value.constant_type);
    const bool is_bool = type.basetype == SPIRType::Boolean;
    return {.id = constant.constant_id,
            .name = compiler_.get_name(constant.id),
            .type = is_bool ? ScalarType::uint32 : scalar_of(type),
            .is_bool = is_bool,
            .default_value = type.width == 64 ? value.scalar_u64() : value.scalar()};
  }

  ScalarType scalar_of(const SPIRType& type) const {
    switch (type.basetype) {
      case SPIRType::SByte:
        return ScalarType::int8;
      case SPIRType::UByte:
        return ScalarType::uint8;
      case SPIRType::Half:
        return ScalarType::float16;
      case SPIRType::Short:
        return ScalarType::int16;
      case SPIRType::UShort:
        return ScalarType::uint16;
      case SPIRType::Float:
        return ScalarType::float32;
      case SPIRType::Int:
        return ScalarType::int32;
      case SPIRType::UInt:
        return ScalarType::uint32;
      case SPIRType::Double:
        return ScalarType::float64;
      case SPIRType::Int64:
        return ScalarType::int64;
      case SPIRType::UInt64:
        return ScalarType::uint64;
      default:
        throw rhi::Error(rhi::ErrorCode::unsupported, label_, "a block has a member of a type that has no layout");
    }
  }

  std::uint64_t length_of(const SPIRType& array) const {
    if (array.array_size_literal.back()) return array.array.back();
    return compiler_.get_constant(array.array.back()).scalar();
  }

  /// @param parent and `member` have the decorations of a matrix
  ValueType value(TypeID id, TypeID parent, std::uint32_t member) const {
    const SPIRType& type = compiler_.get_type(id);
    if (type.pointer) return make_type(ScalarType::uint64);  // a buffer reference
    if (!type.array.empty()) {
      const std::uint64_t length = length_of(type);
      const auto stride = compiler_.get_decoration(id, spv::DecorationArrayStride);
      ValueType array = make_array(value(type.parent_type, parent, member), length, stride);
      return array;
    }
    if (type.basetype == SPIRType::Struct) return structure(id);
    ValueType result = make_type(scalar_of(type), type.vecsize);
    if (type.columns == 1) return result;
    result.kind = ValueType::Kind::matrix;
    result.columns = type.columns;
    result.row_major = compiler_.has_member_decoration(parent, member, spv::DecorationRowMajor);
    result.stride = compiler_.type_struct_member_matrix_stride(compiler_.get_type(parent), member);
    result.size = std::uint64_t{result.stride} * (result.row_major ? result.rows : result.columns);
    return result;
  }

  ValueType structure(TypeID id) const {
    const SPIRType& type = compiler_.get_type(id);
    ValueType result{.kind = ValueType::Kind::structure,
                     .size = compiler_.get_declared_struct_size(type),
                     .name = compiler_.get_name(id)};
    for (std::uint32_t i = 0; i < type.member_types.size(); ++i) {
      const std::string& name = compiler_.get_member_name(id, i);
      result.members.push_back({.name = name.empty() ? fmt::format("member{}", i) : name,
                                .offset = compiler_.get_member_decoration(id, i, spv::DecorationOffset),
                                .type = value(type.member_types[i], id, i)});
    }
    return result;
  }

  spirv_cross::Compiler compiler_;
  std::string label_;
};

}  // namespace

ShaderInterface interface_of(const Shader& shader) {
  rhi::check_spirv(shader.spirv, shader.name);
  const std::vector<std::uint32_t> words = rhi::with_one_entry_point(shader.spirv, shader.entry_point, shader.name);
  ShaderInterface result;
  result.reflection = rhi::reflect_valid(words, shader.name);
  try {
    LayoutReader(words, shader.name).read(result);
  } catch (const rhi::Error&) {
    throw;
  } catch (const std::exception& error) {
    throw rhi::Error(rhi::ErrorCode::invalid_argument, shader.name,
                     std::string("the SPIR-V cannot be parsed: ") + error.what());
  }
  return result;
}

bool is_called(const ShaderInterface& shader, const rhi::ShaderBinding& binding, std::string_view name) {
  if (binding.name == name) return true;
  return std::ranges::any_of(shader.blocks, [&](const BlockLayout& each) {
    if (each.set != binding.set || each.binding != binding.binding) return false;
    const bool is_only_member = each.type.members.size() == 1 && each.type.members[0].name == name;
    return each.block == name || each.instance == name || is_only_member;
  });
}

const BlockLayout* block_at(const ShaderInterface& shader, std::uint32_t set, std::uint32_t binding) {
  const auto found = std::ranges::find_if(
      shader.blocks, [&](const BlockLayout& each) { return each.set == set && each.binding == binding; });
  return found == shader.blocks.end() ? nullptr : &*found;
}

ValueType contents_type(const ValueType& block) {
  return block.members.size() == 1 && block.members[0].offset == 0 ? block.members[0].type : block;
}

}  // namespace tandem::program
