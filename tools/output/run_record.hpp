#pragma once

#include <string>

/// When and how this program was called, for results that people keep.
namespace tandem::tools {

/// Now, in UTC: "2026-11-30 09:12 UTC".
std::string date_text();

/// The command line as a shell takes it, "tandem" for the program; "" where the system does not say.
std::string command_line();

}  // namespace tandem::tools
