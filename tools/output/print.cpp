#include "tools/output/print.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <iostream>
#include <string>

#include "base/printable.hpp"

namespace tandem::tools {
namespace {

constexpr std::size_t longest_line = 4000;

}  // namespace

void print_text(std::string_view text) {
  const std::string line = printable(text, "\n\t");
  std::fwrite(line.data(), 1, line.size(), stdout);
}

void print_error_line(std::string_view text) {
  const std::string line = fmt::format("tandem: {}\n", shortened(text, longest_line));
  std::fwrite(line.data(), 1, line.size(), stderr);
}

bool finish_output() {
  std::cout.flush();
  const bool flushed = std::fflush(stdout) == 0;
  return flushed && std::ferror(stdout) == 0 && std::cout.good();
}

void reserve_standard_files() {
  for (const int file : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    // The lowest free number is the one that is missing. Read-only, so that a write fails.
    if (fcntl(file, F_GETFD) == -1 && errno == EBADF) open("/dev/null", O_RDONLY);
}

}  // namespace tandem::tools
