#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include <doctest/doctest.h>

namespace tandem::test {

/// What a run of a test program skipped, and how many cases ran on each device.
class RunSummary {
 public:
  static RunSummary& of_this_run();

  /// @param name as doctest has it: the pointer is what finds the case again
  /// @param device_index index into device_names()
  void add_device_case(const char* name, std::size_t device_index);

  void filtered_out(const char* name);
  void started(const char* name);
  /// The case that runs, or this run of its subcases, ends here on purpose.
  void skip(const std::string& reason);
  void ended();

  /// Lines for people: how many cases were skipped and why; empty if none was.
  std::string skips() const;
  /// A sentence for each device that has cases, none of which a filter left out, and ran none of them.
  /// @param names device_names()
  std::vector<std::string> idle_devices(const std::vector<std::string>& names) const;
  /// Cases were to run, and each of them was skipped.
  bool skipped_all() const { return executed_ == 0 && !skipped_.empty(); }

 private:
  struct DeviceCount {
    std::size_t registered = 0;
    std::size_t filtered_out = 0;
    std::size_t executed = 0;
  };
  DeviceCount* device_of(const char* name);

  std::map<const char*, std::size_t> device_cases_;
  std::map<std::size_t, DeviceCount> devices_;
  std::map<std::string, std::vector<std::string>> skipped_;  ///< by reason: the cases
  const char* current_ = nullptr;
  bool current_is_skipped_ = false;
  bool any_started_ = false;
  std::size_t executed_ = 0;
};

}  // namespace tandem::test

/// Ends the test case, which then counts as skipped and not as passed. The reason is printed with the case, and once
/// more at the end of the run. Only in the body of a test case itself, not in a function that it calls.
#define TANDEM_SKIP(reason)                                             \
  do {                                                                  \
    const std::string tandem_skip_reason = (reason);                    \
    ::tandem::test::RunSummary::of_this_run().skip(tandem_skip_reason); \
    MESSAGE("skipped: " << tandem_skip_reason);                         \
    return;                                                             \
  } while (false)
