#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <optional>

#include "compare/verdict/thresholds.hpp"

namespace tandem::tools {

/// What a command line says of the thresholds of a verdict; what is absent is as the scene's file of thresholds says,
/// or as usual.
struct ThresholdOptions {
  std::optional<compare::Tier> tier;
  std::optional<double> within_1e3;
  std::optional<double> bit_equal;
  std::optional<double> mean_difference;
  std::optional<std::uint32_t> non_finite;
  std::optional<double> bias_p_value;
};

/// Declares the options on the command. `options` must outlive the parsing.
void add_threshold_options(CLI::App& command, ThresholdOptions& options);

/// Changes what the options say. Throws Error for a limit that the tier does not ask for.
void apply(const ThresholdOptions& options, compare::Thresholds& thresholds);

}  // namespace tandem::tools
