#pragma once

#include <cstdint>
#include <span>
#include <string>

#include <spirv_cross/spirv.hpp>

/// What SPIR-V calls its instructions and enumerants, as its disassembler prints them; the number of what it does not
/// know.
namespace tandem::rhi {

/// For example "OpImageWrite".
/// @param words that follow the opcode
std::string instruction_name(spv::Op op, std::span<const std::uint32_t> words);

/// The operation that an OpSpecConstantOp applies, for example "IAdd".
/// @param words of the whole instruction
std::string folded_operation_name(std::span<const std::uint32_t> words);

std::string capability_name(std::uint32_t capability);
std::string execution_model_name(std::uint32_t model);
std::string execution_mode_name(std::uint32_t mode);
std::string storage_class_name(std::uint32_t storage);
std::string decoration_name(std::uint32_t decoration);
std::string built_in_name(std::uint32_t built_in);
std::string dimension_name(std::uint32_t dimension);               ///< of an image, for example "Cube"
std::string image_format_name(std::uint32_t format);               ///< for example "R8ui"
std::string extended_instruction_name(std::uint32_t instruction);  ///< of GLSL.std.450, for example "IMix"

}  // namespace tandem::rhi
