#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <string>

#include "tests/faults/fault.hpp"
#include "tests/faults/fault_run.hpp"

namespace tandem::test {

/// A fault and what was found of it.
struct FaultRow {
  Fault fault;
  Finding finding;
};

/// How many faults did harm, were found and classed as they should be, and how many did none and were accepted.
std::string summary(std::span<const FaultRow> rows);

/// An aligned table, with a line break at its end.
std::string text_table(std::span<const FaultRow> rows);

/// docs/results/faults.md.
std::string markdown_page(std::span<const FaultRow> rows);

nlohmann::ordered_json to_json(std::span<const FaultRow> rows);

}  // namespace tandem::test
