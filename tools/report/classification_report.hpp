#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "compare/cause/classification.hpp"

namespace tandem::tools {

/// Why pixels differ, for people: counts of classes, and the worst divergences.
std::string table(const compare::Classification& classification);

/// The same for programs; docs/guide/user-guide.md lists the keys.
nlohmann::ordered_json to_json(const compare::Classification& classification);

/// A divergence, as the list in it has them.
nlohmann::ordered_json to_json(const compare::Divergence& divergence);

}  // namespace tandem::tools
