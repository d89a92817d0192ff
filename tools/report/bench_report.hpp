#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "compare/session/job.hpp"
#include "pathtracer/render/tracing_mode.hpp"
#include "rhi/device.hpp"

namespace tandem::tools {

/// What one device did in each round of a run.
struct BenchSeries {
  rhi::DeviceInfo device;
  pathtracer::TracingMode trace = pathtracer::TracingMode::query;
  std::uint32_t threads = 0;                   ///< of a CPU device; 0: all
  std::uint64_t rays = 0;                      ///< of one round
  double build_milliseconds = 0.0;             ///< of the acceleration structures, once
  std::uint64_t structure_bytes = 0;           ///< of the acceleration structures
  double compile_milliseconds = 0.0;           ///< of the shaders, in the round that warms up
  std::vector<double> milliseconds;            ///< of each round: by the device's timestamps where it has them
  std::vector<double> wall_milliseconds = {};  ///< of each round, by the host's clock
  std::optional<double> first_picture_milliseconds = {};  ///< of a program of its own, from its start on
};

/// How the rays of paths divide, counted on recorded paths.
struct RayShares {
  std::uint64_t paths = 0;
  bool is_complete = false;  ///< these are all paths of the picture
  std::uint64_t camera = 0, bounce = 0, shadow = 0;
};

/// A scene under settings, on all devices.
struct BenchRun {
  std::vector<std::pair<std::string, std::string>> varied;  ///< options and values
  compare::JobSummary job;
  std::vector<BenchSeries> series;       ///< in the order of the command line; the same number of rounds each
  std::optional<RayShares> shares = {};  ///< absent: no CPU device was measured
};

struct BenchReport {
  std::uint32_t rounds = 0;
  std::vector<BenchRun> runs;
  std::vector<std::string> left_out = {};  ///< sentences: devices that were not measured
  std::uint64_t peak_bytes = 0;            ///< the most memory that the program has had
};

/// The aligned table for people: medians, with the least and the most in brackets.
std::string table(const BenchReport& report);

/// The same for programs, with every round (docs/schema/bench.schema.json).
nlohmann::ordered_json to_json(const BenchReport& report);

/// A line for each round of each series, with a header.
std::string csv(const BenchReport& report);

/// Sentences about series whose times scatter so much that small ratios say nothing.
std::vector<std::string> noise_warnings(const BenchReport& report);

}  // namespace tandem::tools
