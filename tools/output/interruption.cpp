#include "tools/output/interruption.hpp"

#include <sys/time.h>
#include <unistd.h>

#include <csignal>
#include <cstring>

#include "base/unfinished_path.hpp"

namespace tandem::tools {
namespace {

// What signal handlers may touch.
volatile std::sig_atomic_t noted = 0;
volatile std::sig_atomic_t saving = 0;
volatile std::sig_atomic_t waited = 0;

/// A program that has not ended by then waits for something that nothing can interrupt, such as a driver's compiler.
constexpr suseconds_t patience_microseconds = 1'500'000;
/// That many times as long while finished results are being saved.
constexpr int patience_for_saving = 20;
constexpr int interrupted_exit_code = 130;

[[noreturn]] void end_now() {
  remove_unfinished_paths();
  constexpr char line[] = "tandem: interrupted\n";
  [[maybe_unused]] const ssize_t written = write(STDERR_FILENO, line, sizeof line - 1);
  _exit(interrupted_exit_code);
}

void start_timer() {
  itimerval timer{};
  timer.it_value = {.tv_sec = patience_microseconds / 1'000'000, .tv_usec = patience_microseconds % 1'000'000};
  setitimer(ITIMER_REAL, &timer, nullptr);
}

extern "C" void note_interrupt(int) {
  if (noted != 0) end_now();
  noted = 1;
  start_timer();
}

extern "C" void lose_patience(int) {
  waited = waited + 1;
  if (saving == 0 || waited >= patience_for_saving) end_now();
  start_timer();
}

void handle(int signal, void (*handler)(int)) {
  struct sigaction action {};
  action.sa_handler = handler;
  action.sa_flags = SA_RESTART;
  sigaction(signal, &action, nullptr);
}

}  // namespace

void note_interrupts() {
  handle(SIGINT, note_interrupt);
  handle(SIGTERM, note_interrupt);
  handle(SIGALRM, lose_patience);
  // A reader that goes away, or a file that becomes too large, is an error of the write.
  handle(SIGPIPE, SIG_IGN);
  handle(SIGXFSZ, SIG_IGN);
}

bool interrupted() { return noted != 0; }

Saving::Saving() { saving = 1; }
Saving::~Saving() { saving = 0; }

}  // namespace tandem::tools
