#pragma once

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "rhi/device.hpp"
#include "tools/output/junit.hpp"
#include "tools/suite/suite.hpp"

/// Cells of a suite, one after the other, each with its result in files of its own, so that what has been done once is
/// not done again.
namespace tandem::tools {

/// What came of a cell. `json` is its file, and all that a page or a report needs:
/// name, scene, a, b, settings (name), state (agree, explained, differ, failed), reasons (or why there is no verdict),
/// date (when it was compared), seconds (of the whole cell), report (of `tandem diff`; null when it failed), picture
/// and difference (files, relative to the folder; likewise), page (its own, where it was asked for), key (of all that
/// the result depends on).
struct SuiteResult {
  nlohmann::ordered_json json;
  bool reused = false;  ///< from an earlier run

  bool agrees() const { return json.at("state") == "agree"; }
  bool failed() const { return json.at("state") == "failed"; }
};

/// Runs cells, with devices that are opened once, into a folder.
class SuiteRun {
 public:
  /// @param fresh take nothing over
  SuiteRun(std::filesystem::path folder, bool fresh);

  /// Takes over what the folder has of the cell, if its key is the same and it did not fail; else compares, and writes
  /// the pictures, then the result. A device or a scene that fails is a result. Throws Cancelled, and
  /// Error when a file cannot be written.
  SuiteResult run(const SuiteCell& cell);

 private:
  /// A device, and its programs for all cells.
  struct OpenDevice {
    rhi::DeviceHandle handle;
    pathtracer::ProgramStoreHandle programs;
  };

  const OpenDevice& device(const std::string& name, const RenderOptions& options);
  SuiteResult try_run(const SuiteCell& cell, compare::Comparison& comparison, std::string& page);

  std::filesystem::path folder_;
  bool fresh_;
  std::string program_;
  std::map<std::string, OpenDevice> devices_;
};

/// Where the cells' files are, in the folder of a suite.
inline constexpr const char* suite_cells_folder = "cells";

/// The worst of all; a cell that failed counts as one that differs.
compare::Outcome outcome_of(const std::vector<SuiteResult>& results);

/// All results without their keys, with a verdict and counts.
nlohmann::ordered_json to_json(const std::vector<SuiteResult>& results);

/// One case for each.
std::vector<JunitCase> junit_cases(const std::vector<SuiteResult>& results);

}  // namespace tandem::tools
