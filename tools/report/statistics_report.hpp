#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "compare/session/batches.hpp"

namespace tandem::tools {

/// For people.
std::string table(const compare::Statistics& statistics);

/// For programs; docs/guide/user-guide.md lists the keys.
nlohmann::ordered_json to_json(const compare::Statistics& statistics);

}  // namespace tandem::tools
