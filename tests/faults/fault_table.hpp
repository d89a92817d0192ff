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

/// How many harmful faults were detected and classified as declared, and how many harmless ones and controls (faults
/// called "none...") were accepted.
std::string summary(std::span<const FaultRow> rows);

/// An aligned table, with a line break at its end.
std::string text_table(std::span<const FaultRow> rows);

/// docs/results/faults.md.
std::string markdown_page(std::span<const FaultRow> rows);

nlohmann::ordered_json to_json(std::span<const FaultRow> rows);

}  // namespace tandem::test
