#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "program/record/components.hpp"

/// The format strings of debugPrintfEXT (GL_EXT_debug_printf), as the Vulkan validation layers define them
/// ("Debug Printf", section "Debug Printf Format String").
namespace tandem::program {

/// "%8.3f", "%v3f", "%lu": how one argument is printed.
struct Conversion {
  std::string text;              ///< in front of it
  std::string flags;             ///< between % and v or the letter: flags, width, precision
  char letter = 'd';             ///< one of d i o u x X a A e E f F g G
  std::uint32_t components = 1;  ///< of a vector, printed with ", " between them

  /// As in the format, without the l of 64 bits.
  std::string name() const;
};

struct PrintFormat {
  std::vector<Conversion> conversions;
  std::string end;  ///< behind the last one
};

/// Throws tandem::Error, a sentence about the conversion at fault.
PrintFormat parse_print_format(std::string_view text);

/// Throws tandem::Error where a conversion has no argument, or one of another kind or size: a float for %d, a vector
/// for %f. Further arguments are ignored, as NonSemantic.DebugPrintf says.
/// @param arguments the components of each, which is a scalar or a vector
void check_arguments(const PrintFormat& format, std::span<const std::vector<Component>> arguments);

/// The text of these arguments. @pre check_arguments accepts them
/// @param words of all arguments, one behind the other, as append_words() makes them
std::string print_text(const PrintFormat& format, std::span<const std::vector<Component>> arguments,
                       std::span<const std::uint32_t> words);

}  // namespace tandem::program
