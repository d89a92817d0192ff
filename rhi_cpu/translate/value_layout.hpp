#pragma once

#include <cstdint>

#include <spirv_cross/spirv_cross.hpp>

/// Types as SPIRV-Cross keeps them, and the size of their values in a kernel. `module` is where the type is from.
namespace tandem::cpu {

/// An array or a pointer to one has the array's lengths; an array of pointers and a pointer are both marked as
/// pointers, but only a pointer is one level deeper than what it is made of.
bool is_pointer(const spirv_cross::Compiler& module, const spirv_cross::SPIRType& type);
bool is_array(const spirv_cross::Compiler& module, const spirv_cross::SPIRType& type);

/// In bytes, as the C++ compiler lays a value out, which is not how a buffer does.
struct ValueLayout {
  std::uint32_t size;
  std::uint32_t alignment;
};

/// Of a type whose arrays have plain constants as lengths.
ValueLayout value_layout(const spirv_cross::Compiler& module, const spirv_cross::SPIRType& type);

}  // namespace tandem::cpu
