#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace tandem::conformance {

/// A case that fails on a driver because the driver is wrong. It runs all the same: when it fails as `failure` says,
/// the result is "driver bug". When it passes with the version that is listed, the entry is wrong and the run fails;
/// when it passes with another version, the bug has been mended.
struct DriverBug {
  std::string driver;    ///< how rhi::DeviceInfo::driver begins, before the version
  std::string version;   ///< that it was seen with: how the rest begins, after a blank
  std::string name;      ///< of the case
  std::string failure;   ///< part of the sentence that the case fails with
  std::string reason;    ///< what the driver does wrong
  std::string evidence;  ///< why it is the driver that is wrong: the specification, or what cpu-exact answers
};

/// The entries of a text like known_driver_bugs.json. Throws std::invalid_argument with one sentence when it is not
/// JSON, or an entry lacks a member or has an empty one.
std::vector<DriverBug> parse_driver_bugs(std::string_view json);

/// Those of known_driver_bugs.json, which is part of the program.
const std::vector<DriverBug>& known_driver_bugs();

/// The entry for this driver, of whatever version, and case, or null.
const DriverBug* find_driver_bug(std::span<const DriverBug> bugs, std::string_view driver, std::string_view case_name);

/// Whether `driver`, an rhi::DeviceInfo::driver, is of the version that the bug was seen with.
bool is_seen_version(const DriverBug& bug, std::string_view driver);

}  // namespace tandem::conformance
