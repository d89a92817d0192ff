#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "program/record/module.hpp"
#include "tests/faults/device_edits.hpp"

/// A wrong instruction that a device has.
namespace tandem::test {

struct ShaderFault {
  std::string name;
  std::string shader;  ///< ExplainedShader::name
  std::uint32_t line;  ///< of the instruction
  spv::Op op;
  std::uint32_t function = 0;  ///< with OpExtInst: of GLSL.std.450
  /// Writes the instruction as the device has it.
  SpirvModule::Edit edit;
  std::size_t skipped = 0;  ///< instructions of that kind that come before it on the line
};

std::vector<ShaderFault> shader_faults();

/// The instruction that is wrong, by position in the module; throws where there is none.
std::size_t place_of(const ShaderFault& fault, const program::Module& module);

/// Of a device with the fault. @param module the shader's, as it is recorded: its ids stay
DeviceEdits edits_of(const ShaderFault& fault, const program::Module& module);

}  // namespace tandem::test
