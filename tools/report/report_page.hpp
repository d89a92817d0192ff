#pragma once

#include <string>

#include "tools/comparison.hpp"
#include "tools/report/diff_report.hpp"

namespace tandem::tools {

/// The options with the metrics that a page shows, unless they say which: what an eye sees of a difference is a map on
/// the page.
ComparisonOptions with_metrics_for_page(ComparisonOptions options);

/// The page about a comparison (compare/report/page.hpp). Records paths on its devices, of a bounded number of pixels.
std::string report_page(Comparison& comparison, const DiffReport& report);

}  // namespace tandem::tools
