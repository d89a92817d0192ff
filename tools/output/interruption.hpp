#pragma once

#include <stdexcept>
#include <string>

/// Ctrl-C and SIGTERM as a request that the work in progress looks at, so that no output is left half-written.
namespace tandem::tools {

/// Ends an action because the user asked for it.
class Interrupted : public std::runtime_error {
 public:
  explicit Interrupted(const std::string& sentence = "interrupted; nothing was written")
      : std::runtime_error(sentence) {}
};

/// From now on the first interrupt is only noted; a second one ends the program at once.
void note_interrupts();

bool interrupted();

}  // namespace tandem::tools
