#pragma once

#include <string>

#include "tools/report/bench_report.hpp"

namespace tandem::tools {

/// A page with the plots and tables of a report, which refers to no other file and to no address. UTF-8. For each
/// option that varies, a scene has a plot of its frame times; without one, the scenes stand side by side.
/// @param command that made it, as a person would type it; @param numbers the report as JSON, to be kept in the page
std::string bench_page(const BenchReport& report, const std::string& command, const std::string& numbers);

}  // namespace tandem::tools
