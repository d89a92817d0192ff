#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "compare/probe/probing.hpp"

namespace tandem::tools {

/// What probes found, for people.
std::string table(const compare::Probing& probing);

/// The same for programs; docs/guide/user-guide.md lists the keys.
nlohmann::ordered_json to_json(const compare::Probing& probing);

}  // namespace tandem::tools
