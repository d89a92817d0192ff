#pragma once

#include <cstdint>
#include <string>

#include "program/record/module.hpp"

/// What an instruction is called, and where it comes from.
namespace tandem::program {

/// A line of the shader that a module was compiled from.
struct SourcePlace {
  std::string file;        ///< "" where the module does not say
  std::uint32_t line = 0;  ///< from 1 on; 0 where the module does not say
  std::string text;        ///< of the line, without blanks around it; "" where the module does not have it
};

/// Of the instruction at a position in the module.
SourcePlace source_of(const Module& module, std::size_t instruction);

/// What an id is called: its OpName, that of the variable it is loaded from, or its number ("%42").
std::string name_of(const Module& module, std::uint32_t id);

/// The operation with the names of its operands: "OpFSub a, %43", "Sqrt x".
std::string describe_instruction(const Module& module, std::size_t instruction);

}  // namespace tandem::program
