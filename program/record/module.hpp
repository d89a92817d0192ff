#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include <spirv_cross/spirv.hpp>

/// SPIR-V as a list of instructions that knows which words are ids: what is recorded, and what differences are
/// explained with.
namespace tandem::program {

/// Where the front end says that an instruction comes from: OpLine. line 0: it does not say.
struct SourceLine {
  std::uint32_t file = 0;  ///< the id of an OpString
  std::uint32_t line = 0;
  std::uint32_t column = 0;

  bool operator==(const SourceLine&) const = default;
};

struct Instruction {
  spv::Op op = spv::OpNop;
  std::vector<std::uint32_t> words;          ///< with the first one
  std::uint32_t type = 0;                    ///< the result type's id, 0 without one
  std::uint32_t result = 0;                  ///< 0 without one
  std::vector<std::uint16_t> used_ids = {};  ///< positions in `words` of ids that it uses, but for the type
  SourceLine line = {};
};

struct Module {
  std::array<std::uint32_t, 5> header = {};
  std::vector<Instruction> instructions;                       ///< in their order, OpLine and the like included
  std::size_t first_global = 0;                                ///< the first type, constant or variable
  std::size_t first_function = 0;                              ///< the first OpFunction
  std::unordered_map<std::uint32_t, std::size_t> definitions;  ///< the instruction that makes an id
  std::unordered_map<std::uint32_t, std::string> names;        ///< OpName
};

/// Reads a valid module of one entry point. Throws rhi::Error(unsupported), which names `label`, for what SPIRV-Tools
/// does not know.
Module parse_module(std::span<const std::uint32_t> spirv, std::string_view label);

/// The instruction that makes the id. @pre there is one
const Instruction& definition(const Module& module, std::uint32_t id);

/// The text of an OpString; "" for any other id.
std::string string_of(const Module& module, std::uint32_t id);

/// The module with all specialisation constants replaced by plain ones: those of `values` have these bits, the others
/// their defaults.
std::vector<std::uint32_t> with_fixed_constants(
    std::span<const std::uint32_t> spirv, const std::unordered_map<std::uint32_t, std::vector<std::uint32_t>>& values,
    std::string_view label);

}  // namespace tandem::program
