#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tools/options/comparison_options.hpp"
#include "tools/options/render_options.hpp"

namespace tandem::tools {

/// One comparison of a suite.
struct SuiteCell {
  std::string name;              ///< of its files: "cornell_box-cpu-vulkan-small"; no other cell has it
  std::string scene;             ///< the row of the table
  std::string settings;          ///< together with the devices the column
  nlohmann::ordered_json given;  ///< what the suite says of the settings
  RenderOptions render;
  ComparisonArguments comparison;
  bool report = false;  ///< whether it gets a page of its own
};

struct Suite {
  std::string title;  ///< what the file says, or its name
  std::vector<SuiteCell> cells;
};

/// Reads a suite: every scene on every pair of devices under every settings, the scenes outermost.
/// docs/schema/suite.schema.json and the user guide say what the file holds. Files that it names are relative to its
/// folder. Settings are options of `tandem diff`, checked as on the command line. Throws Error, naming file and place.
/// @param execution threads and validation of all cells
Suite read_suite(const std::filesystem::path& path, const RenderOptions& execution);

}  // namespace tandem::tools
