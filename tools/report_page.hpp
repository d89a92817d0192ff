#pragma once

#include <string>

#include "tools/comparison.hpp"
#include "tools/diff_report.hpp"

namespace tandem::tools {

/// The page about a comparison (compare/report/page.hpp). Records paths on its devices, of a bounded number of pixels.
std::string report_page(Comparison& comparison, const DiffReport& report);

}  // namespace tandem::tools
