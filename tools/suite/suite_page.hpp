#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tools/suite/suite_run.hpp"

namespace tandem::tools {

/// One HTML page over all results, which needs no other file: a row for each scene, those first that are worst, and a
/// column for each pair of devices and settings. Pages of single comparisons are linked where results name one.
/// @param folder of the suite, from which it takes the pictures
std::string suite_page(const std::string& title, const std::vector<SuiteResult>& results,
                       const std::filesystem::path& folder);

}  // namespace tandem::tools
