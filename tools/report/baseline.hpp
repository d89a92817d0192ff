#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "compare/metrics/metrics.hpp"
#include "compare/session/comparison.hpp"
#include "compare/verdict/verdict.hpp"
#include "pathtracer/image/image.hpp"
#include "pathtracer/scene/camera.hpp"

/// A comparison of today with one that `tandem diff --out` stored.
namespace tandem::tools {

/// The name of the file beside a.exr and b.exr.
inline constexpr const char* stored_report = "diff.json";

/// What `tandem diff --out` left in its folder.
struct StoredRun {
  std::filesystem::path folder;
  pathtracer::Image a, b;  ///< to the last bit
  nlohmann::json report;   ///< of diff.json
};

/// Throws Error, naming the file, when the folder holds no whole run.
StoredRun read_stored_run(const std::filesystem::path& folder);

/// Throws Error unless the run shows the same content of a scene under the same settings, in a tier that
/// compares the same samples.
/// @param camera,background those in use
void check_same_job(const StoredRun& run, const compare::JobSummary& job, const pathtracer::Camera& camera,
                    const glm::vec3& background);

/// A picture of today against the stored one, which is image a of the metrics.
struct BaselineSide {
  compare::Metrics metrics;
  compare::Verdict verdict;
  double milliseconds_before = 0;
  double milliseconds_now = 0;
};

/// What is not as it was: a device's driver, the version, the verdict, ...
struct BaselineChange {
  std::string what;
  std::string before;
  std::string now;
};

struct Baseline {
  std::string folder;
  BaselineSide a, b;
  std::vector<BaselineChange> changes;  ///< but the times, which never stay the same

  compare::Outcome outcome() const { return compare::worse(a.verdict.outcome, b.verdict.outcome); }
};

/// Compares what was rendered today with the stored run, which must be one of the same job.
Baseline compare_with(const StoredRun& run, const compare::Comparison& comparison);

}  // namespace tandem::tools
