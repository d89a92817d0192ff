#include "tools/output/messages.hpp"

#include "tools/output/print.hpp"

#include <fmt/format.h>

namespace tandem::tools {

void print_warnings(const std::vector<std::string>& warnings) {
  for (const std::string& warning : warnings) print_error_line("warning: " + warning);
}

void print_note(const std::string& note) { print_error_line("note: " + note); }

void print_message(const rhi::Message& message) {
  if (message.severity == rhi::Severity::info) return;
  const char* const severity = message.severity == rhi::Severity::error ? "error" : "warning";
  print_error_line(fmt::format("{}: {}: {}", severity, message.source, message.text));
}

}  // namespace tandem::tools
