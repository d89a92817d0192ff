#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "compare/cause/classification.hpp"
#include "compare/cause/difference_class.hpp"
#include "rhi/device.hpp"
#include "tests/faults/fault.hpp"

namespace tandem::test {

/// What a comparison says of a device with a fault.
struct Finding {
  Finder found_by = Finder::nobody;               ///< the first to see a mismatch, or else any difference
  std::optional<compare::DifferenceClass> worst;  ///< of all that was found
  std::string event;                              ///< where most paths part: its kind, or the trial of a probe
  std::string field;                              ///< likewise
  std::optional<std::uint32_t> segment;           ///< the first on which a path parts
  std::string sentence;                           ///< of one such place, for people
  std::uint64_t differing_pixels = 0;
  std::string problem;  ///< what is not as the fault declares; empty: all is
  double seconds = 0;
};

/// Runs faults, one after the other, on faulty devices around one that has none.
class FaultRunner {
 public:
  /// @param device with the faults around it, and the reference without @param arbiter traces exactly
  FaultRunner(rhi::DeviceHandle device, rhi::DeviceHandle arbiter);
  ~FaultRunner();

  /// Compares the device with and without the fault: the picture, paths all over it, and probes until something is
  /// found.
  Finding run(const Fault& fault);

 private:
  struct Reference;
  Reference& reference(const std::string& scene, pathtracer::TracingMode form);

  rhi::DeviceHandle device_, arbiter_;
  std::map<std::pair<std::string, pathtracer::TracingMode>, std::unique_ptr<Reference>> references_;
};

}  // namespace tandem::test
