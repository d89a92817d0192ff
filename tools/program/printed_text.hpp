#pragma once

#include <string>
#include <string_view>

#include "program/print/printing_job.hpp"

namespace tandem::tools::program_run {

/// A line for each that shaders have printed, "cpu: [3,0,0] x = 1.5", and one that says how many are left out.
/// @param front stands in front of each
std::string printed_text(const program::PrintedLines& lines, std::string_view front);

}  // namespace tandem::tools::program_run
