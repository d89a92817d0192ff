#include "base/threads.hpp"

#include <future>
#include <system_error>
#include <thread>
#include <vector>

#include <fmt/format.h>

#include "base/error.hpp"

namespace tandem {
namespace {

/// Beside one for each processor: those of the image library, of a driver, and the one that shows progress.
constexpr unsigned others = 16;

}  // namespace

void require_threads() {
  std::promise<void> end;
  const std::shared_future<void> ended(end.get_future());
  std::vector<std::thread> threads;
  std::error_code problem;
  const unsigned count = std::thread::hardware_concurrency() + others;
  while (!problem && threads.size() < count) {
    try {
      threads.emplace_back([ended] { ended.wait(); });
    } catch (const std::system_error& error) {
      problem = error.code();
    }
  }
  end.set_value();
  for (std::thread& thread : threads) thread.join();
  if (problem)
    throw Error(fmt::format("only {} of {} threads can be started: {}; a limit of processes (ulimit -u) may be too low",
                            threads.size(), count, problem.message()));
}

}  // namespace tandem
