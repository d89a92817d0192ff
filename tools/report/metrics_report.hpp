#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "compare/metrics/detailed_metrics.hpp"

namespace tandem::tools {

/// The rows of the diff's table, for people: docs/guide/metrics.md explains them. Of the regions, all that
/// differ are listed where FLIP was measured, else the worst.
std::string table(const compare::DetailedMetrics& metrics);

/// The same for programs; docs/guide/metrics.md lists the keys.
nlohmann::ordered_json to_json(const compare::DetailedMetrics& metrics);

}  // namespace tandem::tools
