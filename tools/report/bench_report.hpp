#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "compare/session/job.hpp"
#include "pathtracer/render/tracing_mode.hpp"
#include "rhi/device.hpp"

namespace tandem::tools {

/// What one device did in each round of `tandem bench`.
struct BenchSeries {
  rhi::DeviceInfo device;
  pathtracer::TracingMode trace = pathtracer::TracingMode::query;
  std::uint64_t rays = 0;             ///< of one round
  double build_milliseconds = 0.0;    ///< of the acceleration structures, once
  double compile_milliseconds = 0.0;  ///< of the shaders, in the round that warms up
  std::vector<double> milliseconds;   ///< of each round
};

struct BenchReport {
  compare::JobSummary job;
  std::uint32_t threads = 0;        ///< of the CPU device; 0: all
  std::vector<BenchSeries> series;  ///< in the order of the command line; the same number of rounds each
};

/// The aligned table for people: medians, with the least and the most in brackets.
std::string table(const BenchReport& report);

/// The same for programs, with every round.
nlohmann::ordered_json to_json(const BenchReport& report);

}  // namespace tandem::tools
