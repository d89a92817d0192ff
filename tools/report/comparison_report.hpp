#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "compare/session/comparison.hpp"

namespace tandem::tools {

/// The aligned table for people, with a line break at its end.
std::string table(const compare::Comparison& comparison);

/// The same for programs; docs/schema/diff.schema.json specifies it.
nlohmann::ordered_json to_json(const compare::Comparison& comparison);

}  // namespace tandem::tools
