#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <cstdio>
#include <exception>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "devices/devices.hpp"
#include "tests/faults/fault.hpp"
#include "tests/faults/fault_run.hpp"
#include "tests/faults/fault_table.hpp"

/// tandem_faults: puts faults into a device, one after the other, and says what a comparison finds of each. Exit code
/// 0: all that it should; 1: something else; 2: it could not be tried.
namespace {

using namespace tandem;
using namespace tandem::test;

struct Options {
  std::string device = "cpu";
  std::string arbiter = "cpu-exact";
  std::string format = "text";
  std::vector<std::string> only;
  std::size_t part = 1;
  std::size_t parts = 1;
};

/// Throws CLI::ValidationError for a name that no fault has.
std::vector<Fault> chosen_faults(const std::vector<std::string>& only) {
  std::vector<Fault> all = all_faults();
  if (only.empty()) return all;
  std::vector<Fault> chosen;
  for (const std::string& name : only) {
    const auto found = std::ranges::find(all, name, &Fault::name);
    if (found == all.end()) throw CLI::ValidationError("--only", fmt::format("no fault is named {}", name));
    chosen.push_back(*found);
  }
  return chosen;
}

/// Every fault is run by one of several threads, each with devices of its own: most of the time goes into compiling.
class Crew {
 public:
  explicit Crew(const Options& options, std::vector<Fault> faults) : options_(options) {
    for (Fault& fault : faults) rows_.push_back({std::move(fault), {}});
  }

  std::vector<FaultRow> run() {
    std::vector<std::thread> threads;
    for (unsigned i = 0; i < std::max(1u, std::thread::hardware_concurrency()); ++i)
      threads.emplace_back([this] { work(); });
    for (std::thread& thread : threads) thread.join();
    if (failure_) std::rethrow_exception(failure_);
    return std::move(rows_);
  }

 private:
  void work() {
    try {
      FaultRunner runner(create_device({.name = options_.device}), create_device({.name = options_.arbiter}));
      for (std::size_t i = next_++; i < rows_.size(); i = next_++) {
        FaultRow& row = rows_[i];
        row.finding = runner.run(row.fault);
        fmt::print(stderr, "{:.1f} s {}{}\n", row.finding.seconds, row.fault.name,
                   row.finding.problem.empty() ? "" : ": " + row.finding.problem);
      }
    } catch (...) {
      const std::lock_guard lock(mutex_);
      failure_ = std::current_exception();
      next_ = rows_.size();
    }
  }

  const Options& options_;
  std::vector<FaultRow> rows_;
  std::atomic<std::size_t> next_ = 0;
  std::mutex mutex_;
  std::exception_ptr failure_;
};

/// Every parts-th fault, so that each part has slow ones and fast ones.
std::vector<Fault> part_of(const std::vector<Fault>& faults, std::size_t part, std::size_t parts) {
  std::vector<Fault> result;
  for (std::size_t i = part - 1; i < faults.size(); i += parts) result.push_back(faults[i]);
  return result;
}

int run(const Options& options) {
  const std::vector<Fault> faults = part_of(chosen_faults(options.only), options.part, options.parts);
  const std::vector<FaultRow> rows = Crew(options, faults).run();
  if (options.format == "json")
    fmt::print("{}\n", to_json(rows).dump(2));
  else if (options.format == "markdown")
    fmt::print("{}", markdown_page(rows));
  else
    fmt::print("{}\n{}\n", text_table(rows), summary(rows));
  const bool all_right = std::ranges::all_of(rows, [](const FaultRow& row) { return row.finding.problem.empty(); });
  return all_right ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app("Puts faults into a device, one after the other, and says what a comparison finds of each.");
  app.add_option("--device", options.device, "the device that gets the faults")->capture_default_str();
  app.add_option("--arbiter", options.arbiter, "a device that traces exactly")->capture_default_str();
  app.add_option("--format", options.format, "of what is printed")
      ->check(CLI::IsMember({"text", "json", "markdown"}))
      ->capture_default_str();
  app.add_option("--only", options.only, "names of faults");
  app.add_option("--parts", options.parts, "into how many parts the faults are divided")->check(CLI::PositiveNumber);
  app.add_option("--part", options.part, "which of them is run")->check(CLI::PositiveNumber);
  try {
    app.parse(argc, argv);
    return run(options);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 2;
  }
}
