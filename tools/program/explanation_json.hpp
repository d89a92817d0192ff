#pragma once

#include <nlohmann/json.hpp>

#include "program/explain/explanation.hpp"
#include "program/explain/text.hpp"

namespace tandem::tools::program_run {

/// What explanation_text() says, for programs: the outputs, the instructions that differ in lockstep with their
/// classes, and the first difference of each recorded invocation.
nlohmann::ordered_json to_json(const program::Explanation& explanation, const program::Job& job,
                               const program::ExplanationNames& names);

}  // namespace tandem::tools::program_run
