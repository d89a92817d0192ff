#pragma once

/// Ctrl-C and SIGTERM as a request that the work in progress looks at, so that no output is left half-written.
namespace tandem::tools {

/// From now on the first interrupt is only noted; a second one ends the program at once.
void note_interrupts();

bool interrupted();

}  // namespace tandem::tools
