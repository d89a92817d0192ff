#pragma once

/// Ctrl-C and SIGTERM as a request that the work in progress looks at, so that no output is left half-written.
namespace tandem::tools {

/// From now on the first interrupt is noted. If the program has not ended a second later, because it is in a place that
/// does not look (a driver's compiler, a file that does not open), or at a second interrupt, it ends at once with exit
/// code 130, and temporary files are removed. A closed pipe and a file that is too large fail the write and nothing
/// more.
void note_interrupts();

bool interrupted();

/// While it lives, finished results are being saved, which a first interrupt does not cut short for half a minute.
class Saving {
 public:
  Saving();
  ~Saving();
  Saving(const Saving&) = delete;
  Saving& operator=(const Saving&) = delete;
};

}  // namespace tandem::tools
