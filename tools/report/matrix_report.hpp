#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "compare/image/vote.hpp"
#include "compare/session/rendering.hpp"
#include "compare/verdict/thresholds.hpp"
#include "compare/verdict/verdict.hpp"
#include "tools/report/job_report.hpp"

/// More than two devices on one scene.
namespace tandem::tools {

/// Two of the devices; a comes before b.
struct MatrixPair {
  std::size_t a = 0, b = 0;
  compare::Metrics metrics;
  compare::Verdict verdict;
};

/// All that `tandem matrix` found out.
struct MatrixReport {
  compare::JobSummary job;
  compare::Thresholds thresholds;
  std::vector<compare::Rendering> renderings;  ///< of each device
  std::vector<MatrixPair> pairs;
  compare::Vote vote;
  compare::DeviceIndices outvoted;  ///< as a whole

  /// Whether every pair agrees.
  bool agree() const;
};

/// Compares the pictures of each two devices, and lets all vote. Throws rhi::Error for fewer than three.
MatrixReport compare_all(const compare::JobSummary& job, const compare::Thresholds& thresholds,
                         std::vector<compare::Rendering> renderings);

/// Which device is outvoted, or which pairs differ; none when all agree.
std::vector<std::string> reasons(const MatrixReport& report);

/// For people.
std::string table(const MatrixReport& report);

/// For programs; docs/guide/user-guide.md lists the keys.
nlohmann::ordered_json to_json(const MatrixReport& report);

}  // namespace tandem::tools
