#include "rhi_cpu/translate/value_layout.hpp"

#include <algorithm>

namespace tandem::cpu {

using spirv_cross::Compiler;
using spirv_cross::SPIRType;

namespace {

std::uint32_t aligned(std::uint32_t size, std::uint32_t alignment) {
  return (size + alignment - 1) / alignment * alignment;
}

}  // namespace

bool is_pointer(const Compiler& module, const SPIRType& type) {
  return type.pointer && type.pointer_depth > module.get_type(type.parent_type).pointer_depth;
}

bool is_array(const Compiler& module, const SPIRType& type) { return !type.array.empty() && !is_pointer(module, type); }

ValueLayout value_layout(const Compiler& module, const SPIRType& type) {
  if (is_array(module, type)) {
    const ValueLayout element = value_layout(module, module.get_type(type.parent_type));
    return {.size = element.size * type.array.back(), .alignment = element.alignment};
  }
  if (is_pointer(module, type)) return {.size = sizeof(void*), .alignment = sizeof(void*)};
  if (type.basetype != SPIRType::Struct) {
    const std::uint32_t scalar = type.basetype == SPIRType::Boolean ? 1 : type.width / 8;
    return {.size = scalar * type.vecsize * type.columns, .alignment = scalar};
  }
  ValueLayout result = {.size = 0, .alignment = 1};
  for (const auto& id : type.member_types) {
    const ValueLayout member = value_layout(module, module.get_type(id));
    result.size = aligned(result.size, member.alignment) + member.size;
    result.alignment = std::max(result.alignment, member.alignment);
  }
  result.size = aligned(result.size, result.alignment);
  return result;
}

}  // namespace tandem::cpu
