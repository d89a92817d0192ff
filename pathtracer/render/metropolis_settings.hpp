#pragma once

#include <cstdint>

namespace tandem::pathtracer {

/// Of Integrator::metropolis. The picture depends on all of them, so they are the same on every device.
struct MetropolisSettings {
  /// Few, and therefore long: a chain shows little but the surroundings of its first path until a large step succeeds.
  std::uint32_t chains = 512;
  /// Paths of their own, half of which say how bright the picture is about, while the chains begin with the others.
  std::uint32_t bootstrap_paths = 524288;
  float large_step = 0.3f;  ///< probability that a proposal is a path of its own

  bool operator==(const MetropolisSettings&) const = default;
};

}  // namespace tandem::pathtracer
