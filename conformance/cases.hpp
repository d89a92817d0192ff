#pragma once

#include <vector>

#include "conformance/case.hpp"

/// The groups, in the order of the report: each function appends its cases.
namespace tandem::conformance {

using Cases = std::vector<Case>;

void add_ray_query_builtin_cases(Cases& cases);

}  // namespace tandem::conformance
