#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "program/amber/script.hpp"
#include "program/print/printing_job.hpp"
#include "rhi/device.hpp"

namespace tandem::program::amber {

/// Sets the subgroup sizes that depend on the device.
void adapt(Script& script, const rhi::DeviceInfo& device);

enum class Outcome : std::uint8_t {
  passed,
  failed,   ///< an expectation is not met, or the device failed
  skipped,  ///< the device lacks what the script needs
  error     ///< the script is wrong
};

struct Result {
  Outcome outcome = Outcome::passed;
  std::vector<std::string> reasons = {};   ///< sentences without a full stop; none where it passed
  std::vector<PrintedLines> printed = {};  ///< by debugPrintfEXT, of each command that has printed
};

/// Compiles the script's shaders and takes its steps on the device. All expectations are looked at, of those that fail
/// the first few are told. Of each command at most 1000 lines of debugPrintfEXT are kept. Throws only what is no fault
/// of the script or the device, such as std::bad_alloc.
Result run(const Script& script, rhi::Device& device);

}  // namespace tandem::program::amber
