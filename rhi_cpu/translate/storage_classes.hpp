#pragma once

#include <spirv_cross/spirv.hpp>

/// What the translator makes of SPIR-V's storage classes.
namespace tandem::cpu {

/// Memory of the host, whose layout the SPIR-V says; a pointer into it is an address.
constexpr bool is_buffer(spv::StorageClass storage) {
  return storage == spv::StorageClassUniform || storage == spv::StorageClassStorageBuffer ||
         storage == spv::StorageClassPushConstant || storage == spv::StorageClassShaderRecordBufferKHR ||
         storage == spv::StorageClassPhysicalStorageBuffer;
}

/// A variable that is handed to the shader which is called.
constexpr bool is_payload(spv::StorageClass storage) {
  return storage == spv::StorageClassRayPayloadKHR || storage == spv::StorageClassCallableDataKHR;
}

/// A variable of the caller.
constexpr bool is_incoming_payload(spv::StorageClass storage) {
  return storage == spv::StorageClassIncomingRayPayloadKHR || storage == spv::StorageClassIncomingCallableDataKHR;
}

}  // namespace tandem::cpu
