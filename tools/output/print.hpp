#pragma once

#include <fmt/format.h>

#include <string_view>
#include <utility>

/// Output of the commands. Nothing here throws when it cannot be written: that must not cost a finished result. Names
/// from files may hold anything, so control characters are written as "\x1b".
namespace tandem::tools {

void print_text(std::string_view text);

/// To standard output.
template <typename... Arguments>
void print(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
  print_text(fmt::format(format, std::forward<Arguments>(arguments)...));
}

/// "tandem: ..." as one line on standard error, in one write, so that lines of several threads do not mix. A line of
/// thousands of characters is cut.
void print_error_line(std::string_view text);

/// Writes what is left; false if any of standard output could not be written.
bool finish_output();

/// Opens what the process was started without of standard input, output and error, so that no other file takes their
/// numbers. Writing to them still fails.
void reserve_standard_files();

}  // namespace tandem::tools
