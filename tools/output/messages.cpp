#include "tools/output/messages.hpp"

#include <fmt/format.h>

#include <cstdio>

namespace tandem::tools {
namespace {

/// One write, so that lines of several threads do not mix.
void print_line(const std::string& text) {
  const std::string line = fmt::format("tandem: {}\n", text);
  std::fwrite(line.data(), 1, line.size(), stderr);
}

}  // namespace

void print_warnings(const std::vector<std::string>& warnings) {
  for (const std::string& warning : warnings) print_line("warning: " + warning);
}

void print_message(const rhi::Message& message) {
  if (message.severity == rhi::Severity::info) return;
  const char* const severity = message.severity == rhi::Severity::error ? "error" : "warning";
  print_line(fmt::format("{}: {}: {}", severity, message.source, message.text));
}

}  // namespace tandem::tools
