#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "conformance/kit/case.hpp"
#include "conformance/kit/driver_bugs.hpp"

namespace tandem::conformance {

enum class Status {
  passed,
  failed,           ///< the answer is wrong
  error,            ///< an rhi::Error or another exception came instead of an answer
  driver_bug,       ///< failed as a known driver bug says
  unexpected_pass,  ///< passed although it is a known driver bug: the entry is out of date
  unsupported       ///< did not run: the device lacks a capability or a limit is too small
};

/// "passed", "failed", "error", "driver bug", "unexpected pass", "unsupported".
std::string_view name_of(Status status);

struct Result {
  std::string name;  ///< of the case
  Status status = Status::passed;
  std::string sentence = {};  ///< why it did not pass; "" when it did
  std::string note = {};      ///< what the case noted: counts, measurements
};

struct DeviceReport {
  rhi::DeviceInfo device;
  std::vector<Result> results = {};  ///< in the order of the cases
};

struct RunOptions {
  Settings settings = {};
  std::span<const DriverBug> driver_bugs = {};
  /// The messages of the device since the last call, if any message is a fault (of a validation layer, say). A case
  /// during which it spoke fails. Empty: messages are ignored.
  std::function<std::vector<std::string>()> take_messages = {};
  std::function<void(const Result&)> on_result = {};  ///< called after each case
};

/// Runs the cases one after another.
DeviceReport run(rhi::Device& device, std::span<const Case> cases, const RunOptions& options);

/// How many results have this status.
std::size_t count(const DeviceReport& report, Status status);

/// Whether the device did all that it must: no case failed, ended in an error or passed unexpectedly, and at least one
/// passed.
bool succeeded(const DeviceReport& report);

}  // namespace tandem::conformance
