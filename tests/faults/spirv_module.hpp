#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <span>
#include <string_view>
#include <vector>

#include <spirv/unified1/GLSL.std.450.h>
#include <spirv/unified1/spirv.hpp>

/// SPIR-V that can be changed: what a compiler or a driver with a bug makes of a shader.
namespace tandem::test {

/// One instruction of a module; the operands are the words behind its first one.
struct Instruction {
  spv::Op opcode = spv::OpNop;
  std::vector<std::uint32_t> operands;

  std::uint32_t type() const;    ///< id of the result's type, 0 where there is none
  std::uint32_t result() const;  ///< id of the result, 0 where there is none
  void set_result(std::uint32_t id);
};

class CodeWriter;

/// A module. Line numbers are left out: they are of no use to changed code.
class SpirvModule {
 public:
  /// Throws rhi::Error(invalid_argument) when the words are no SPIR-V module.
  explicit SpirvModule(std::span<const std::uint32_t> words);
  std::vector<std::uint32_t> words() const;

  /// Handed one instruction after another, an edit writes what stands in its place: usually the instruction itself, and
  /// something before or behind it. The blocks of a function must stay well formed.
  using Edit = std::function<void(Instruction instruction, CodeWriter& code)>;
  /// Edits every function that was called so in GLSL, all overloads; false where the module has none.
  bool edit_function(std::string_view name, const Edit& edit);
  /// Edits all functions.
  void edit_functions(const Edit& edit);

  /// Ids of types and constants, declared where the module does not have them yet.
  std::uint32_t float_type(std::uint32_t width = 32);
  std::uint32_t bool_type();
  std::uint32_t uint_type();
  std::uint32_t int_type();
  std::uint32_t constant(float value);
  std::uint32_t constant(std::uint32_t value);
  std::uint32_t constant(std::int32_t value);

  /// The type of a value, 0 for ids that are none.
  std::uint32_t type_of(std::uint32_t value) const;
  /// The type of the columns of a matrix type.
  std::uint32_t column_type(std::uint32_t matrix_type) const;
  bool has_name(std::uint32_t id, std::string_view name) const;  ///< by OpName
  /// The built-in of spv::BuiltIn that a variable is decorated as, or -1.
  int builtin_of(std::uint32_t variable) const;

  std::uint32_t new_id() { return bound_++; }
  void require(spv::Capability capability);

 private:
  friend class CodeWriter;

  std::uint32_t global(spv::Op opcode, const std::vector<std::uint32_t>& operands);
  std::uint32_t constant(std::uint32_t type, std::uint32_t bits);
  void edit_range(std::vector<Instruction>& written, std::size_t begin, std::size_t end, const Edit& edit);
  std::uint32_t extended_instructions() const;

  std::uint32_t version_ = 0;
  std::uint32_t bound_ = 0;
  std::vector<Instruction> head_;                 ///< up to the first type: capabilities, names, decorations
  std::vector<Instruction> globals_;              ///< types, constants, variables
  std::vector<Instruction> functions_;            ///< to the end
  std::map<std::uint32_t, std::uint32_t> types_;  ///< of values, by id
};

/// Writes instructions into a function that is being edited.
class CodeWriter {
 public:
  CodeWriter(SpirvModule& module, std::vector<Instruction>& written) : module_(module), written_(written) {}

  void put(Instruction instruction);
  /// A new value of an instruction whose first two operands are its type and its result.
  std::uint32_t value(spv::Op opcode, std::uint32_t type, std::vector<std::uint32_t> operands);
  /// A new value of an instruction of GLSL.std.450.
  std::uint32_t extended(GLSLstd450 function, std::uint32_t type, std::vector<std::uint32_t> operands);
  /// Puts `instruction`, but hands its result to nobody but `change`, which writes what all others get instead.
  void put_changed(Instruction instruction, const std::function<std::uint32_t(std::uint32_t result)>& change);

  SpirvModule& module() noexcept { return module_; }

 private:
  SpirvModule& module_;
  std::vector<Instruction>& written_;
};

}  // namespace tandem::test
