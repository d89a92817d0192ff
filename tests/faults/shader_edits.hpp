#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "rhi/shader_reflection.hpp"
#include "tests/faults/spirv_module.hpp"

/// Edits of which faults in shaders are made. Each returns whether it found anything to change.
namespace tandem::test {

using ShaderEdit = std::function<bool(SpirvModule& module, rhi::ShaderStage stage)>;

/// Writes what is used in the place of a value, and returns its id.
using ValueEdit = std::function<std::uint32_t(CodeWriter& code, std::uint32_t value)>;

/// What instructions of an opcode give, in all functions.
ShaderEdit edited_results(spv::Op opcode, ValueEdit edit);
/// The same in functions of one name.
ShaderEdit edited_results(std::string function, spv::Op opcode, ValueEdit edit);
/// What functions of one name return.
ShaderEdit edited_returns(std::string function, ValueEdit edit);
/// What calls of `callee` (as OpName has it: "det_div(f1;f1;") within functions of one name return.
ShaderEdit edited_calls(std::string function, std::string callee, ValueEdit edit);
/// What loads of a built-in variable give.
ShaderEdit edited_builtin(spv::BuiltIn builtin, ValueEdit edit);
/// Operand `index` of instructions of an opcode, in all functions.
ShaderEdit edited_operand(spv::Op opcode, std::size_t index, ValueEdit edit);
/// The same in functions of one name.
ShaderEdit edited_operand(std::string function, spv::Op opcode, std::size_t index, ValueEdit edit);
/// Instructions of an opcode are left out; `terminator` stands in their place if they end a block.
ShaderEdit without(spv::Op opcode, spv::Op terminator = spv::OpNop);

/// `value` moved by `steps` floats away from zero; zero stays.
std::uint32_t moved_by_ulp(CodeWriter& code, std::uint32_t value, std::int32_t steps);
/// `scale` times a float.
std::uint32_t scaled(CodeWriter& code, std::uint32_t value, float scale);

}  // namespace tandem::test
