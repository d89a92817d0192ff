#pragma once

#include <string>

#include "program/explain/explanation.hpp"

namespace tandem::program {

/// What the reader calls things.
struct ExplanationNames {
  std::string a, b;   ///< the devices
  std::string input;  ///< the script or shader
};

/// The explanation in lines of text for a terminal.
/// @param job that was explained
std::string explanation_text(const Explanation& explanation, const Job& job, const ExplanationNames& names);

}  // namespace tandem::program
