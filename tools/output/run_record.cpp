#include "tools/output/run_record.hpp"

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <ctime>
#include <string_view>

#include <fmt/chrono.h>
#include <fmt/format.h>

#include "base/error.hpp"
#include "base/input_file.hpp"

namespace tandem::tools {
namespace {

/// The word as a POSIX shell reads it back.
std::string quoted(std::string_view word) {
  constexpr std::string_view harmless = "-_./,:=+@%";
  const auto is_harmless = [&](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
           harmless.find(c) != std::string_view::npos;
  };
  if (!word.empty() && std::ranges::all_of(word, is_harmless)) return std::string(word);
  std::string text = "'";
  for (const char c : word) text += c == '\'' ? "'\\''" : std::string(1, c);
  return text + "'";
}

}  // namespace

std::string date_text() {
  const std::time_t now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  return fmt::format("{:%Y-%m-%d %H:%M} UTC", fmt::gmtime(now));
}

std::string command_line() {
  constexpr std::uint64_t most_bytes = std::uint64_t{1} << 24;  // Linux takes a quarter of the stack at most
  std::string words;
  try {
    words = read_bytes("/proc/self/cmdline", most_bytes);
  } catch (const Error&) {
    return {};
  }
  std::string line = "tandem";
  std::size_t begin = words.find('\0');
  while (begin != std::string::npos && begin + 1 < words.size()) {
    const std::size_t end = words.find('\0', begin + 1);
    line += " " + quoted(std::string_view(words).substr(begin + 1, end - begin - 1));
    begin = end;
  }
  return line;
}

}  // namespace tandem::tools
