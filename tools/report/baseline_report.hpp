#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "tools/report/baseline.hpp"

namespace tandem::tools {

/// What a stored run says of today's, for people.
std::string table(const Baseline& baseline);

/// The same for programs; docs/guide/user-guide.md lists the keys.
nlohmann::ordered_json to_json(const Baseline& baseline);

}  // namespace tandem::tools
