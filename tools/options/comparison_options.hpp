#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "compare/session/comparison.hpp"
#include "tools/options/render_options.hpp"
#include "tools/options/threshold_options.hpp"

/// What diff, gallery, suite and matrix share: which devices are compared, and how.
namespace tandem::tools {

struct ComparisonArguments {
  std::string a = "cpu";                  ///< the first device, the reference
  std::string b = "vulkan";               ///< the second
  std::string arbiter = "cpu-exact";      ///< the device that knows the answers to rays, where paths are classified
  compare::ComparisonOptions comparison;  ///< its thresholds: where neither `thresholds` nor the scene says otherwise
  ThresholdOptions thresholds;
};

/// Declares the options on the command, all but the devices a and b. `arguments` must outlive the parsing.
void add_comparison_options(CLI::App& command, ComparisonArguments& arguments);

/// The options of a comparison of this scene: thresholds are those of the arguments, else of the scene's file, else the
/// usual ones; a tracing mode that is not given for one device is the one for both. Throws Error.
compare::ComparisonOptions comparison_options(const ComparisonArguments& arguments,
                                              const RenderOptions& render_options);

/// Opens the devices, the arbiter too where paths are classified. Throws rhi::Error for a device that is not there.
compare::ComparedDevices open_devices(const ComparisonArguments& arguments, const RenderOptions& render_options);

}  // namespace tandem::tools
