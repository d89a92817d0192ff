#pragma once

#include <exception>

/// Ctrl-C and SIGTERM as a request that the work in progress looks at, so that no output is left half-written.
namespace tandem::tools {

/// Ends an action because the user asked for it.
class Interrupted : public std::exception {
 public:
  const char* what() const noexcept override { return "interrupted; nothing was written"; }
};

/// From now on the first interrupt is only noted; a second one ends the program at once.
void note_interrupts();

bool interrupted();

}  // namespace tandem::tools
