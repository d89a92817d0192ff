#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "program/print/print_format.hpp"

/// Shaders that print by debugPrintfEXT (NonSemantic.DebugPrintf), rewritten so that every device prints the same: what
/// is printed goes into a storage buffer, and is made text by the host (decision 27).
///
/// The buffer, in words: the header (PrintHeader), then slots of header_slot_words words, one for each call that was
/// executed: the number of the call + 1, the invocation (x, y, z), the words of the arguments. One slot more takes what
/// finds no place.
namespace tandem::program {

enum PrintHeader : std::uint32_t {
  print_header_count,       ///< calls that were executed; stays at 2^31
  print_header_capacity,    ///< slots, without the last one
  print_header_slot_words,  ///< of the longest call
  print_header_words
};

/// A debugPrintfEXT of a shader.
struct PrintCall {
  std::string place;   ///< "noise.comp:12", or the shader's name where it has no line numbers
  std::string source;  ///< the format as the shader has it
  PrintFormat format;
  std::vector<std::vector<Component>> arguments;
  std::uint32_t slot_words = 0;
};

/// Whether the module imports NonSemantic.DebugPrintf. It need not be valid.
bool prints(std::span<const std::uint32_t> spirv);

/// The module without them; itself where it has none. Throws rhi::Error for SPIR-V that cannot be read.
std::vector<std::uint32_t> without_prints(std::span<const std::uint32_t> spirv, std::string_view label);

struct PrintPlace {
  std::uint32_t set = 0, binding = 0;  ///< of the buffer, which the module does not use
  std::uint32_t first_call = 0;        ///< the number of the module's first call
};

struct PrintingShader {
  std::vector<std::uint32_t> spirv;
  std::vector<PrintCall> calls;
};

/// @param spirv of one entry point  @param label the shader's name
/// Throws rhi::Error(invalid_argument), which names the line, for a format that is wrong or does not fit its arguments.
PrintingShader with_print_buffer(std::span<const std::uint32_t> spirv, std::string_view label, const PrintPlace& place);

}  // namespace tandem::program
