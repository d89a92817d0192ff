#pragma once

#include <string>
#include <vector>

#include "rhi/message.hpp"

/// What goes to standard error besides the one sentence of an error.
namespace tandem::tools {

/// A line "tandem: warning: ..." each.
void print_warnings(const std::vector<std::string>& warnings);

/// A line "tandem: note: ..." for what a user may want to know of a result that is right.
void print_note(const std::string& note);

/// Prints a device's warnings and errors, and drops what is only information. Thread-safe.
void print_message(const rhi::Message& message);

}  // namespace tandem::tools
