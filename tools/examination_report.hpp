#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "compare/examination.hpp"

namespace tandem::tools {

/// What the arbiter found, for people. @param arbiter its name
std::string table(const compare::Examination& examination, const std::string& arbiter);

/// The same for programs; docs/user-guide.md lists the keys.
nlohmann::ordered_json to_json(const compare::Examination& examination, const std::string& arbiter);

}  // namespace tandem::tools
