#include "tools/output/interruption.hpp"

#include <csignal>

namespace tandem::tools {
namespace {

// The one thing that a signal handler may touch.
volatile std::sig_atomic_t noted = 0;

extern "C" void note_interrupt(int signal) {
  noted = 1;
  std::signal(signal, SIG_DFL);
}

}  // namespace

void note_interrupts() {
  std::signal(SIGINT, note_interrupt);
  std::signal(SIGTERM, note_interrupt);
}

bool interrupted() { return noted != 0; }

}  // namespace tandem::tools
