#pragma once

#include <string>

#include "compare/session/comparison.hpp"

namespace tandem::tools {

/// The options with the metrics that a page shows, unless they say which: what an eye sees of a difference is a map on
/// the page.
compare::ComparisonOptions with_metrics_for_page(compare::ComparisonOptions options);

/// The page about a comparison (compare/report/page.hpp). Records paths on the session's devices, of a bounded number
/// of pixels. @param numbers the comparison as JSON
std::string report_page(compare::Session& session, const compare::Comparison& comparison, const std::string& numbers);

}  // namespace tandem::tools
