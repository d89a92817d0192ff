#include "tools/program/printed_text.hpp"

#include <fmt/format.h>

#include "base/printable.hpp"

namespace tandem::tools::program_run {

std::string printed_text(const program::PrintedLines& lines, std::string_view front) {
  std::string text;
  for (const program::PrintedLine& line : lines.lines)
    text += fmt::format("{}[{},{},{}] {}\n", front, line.invocation[0], line.invocation[1], line.invocation[2],
                        printable(line.text, "\n\t"));
  if (lines.left_out > 0) text += fmt::format("{}... and {} more lines, which found no place\n", front, lines.left_out);
  return text;
}

}  // namespace tandem::tools::program_run
