#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tools/bench/plan.hpp"
#include "tools/report/bench_report.hpp"

namespace tandem::tools {

struct MeasureOptions {
  std::vector<std::string> devices;
  std::uint32_t rounds = 5;  ///< after one that warms up
  /// A device whose first picture takes longer than this is left out from there on, which a driver's compiler may
  /// cause; absent: first pictures are not measured.
  std::optional<std::chrono::milliseconds> first_picture_limit = {};
};

/// Renders every configuration on every device. Those of one scene take turns within a round, device by device, so that
/// a machine that becomes slower or faster does so for all of them. Throws Error, also where every device is left out,
/// rhi::Error, and Cancelled.
/// @param configurations of one scene follow each other
BenchReport measure(std::span<const Configuration> configurations, const MeasureOptions& options);

}  // namespace tandem::tools
