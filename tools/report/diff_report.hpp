#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "compare/cause/classification.hpp"
#include "compare/metrics/detailed_metrics.hpp"
#include "compare/metrics/metrics.hpp"
#include "compare/probe/probing.hpp"
#include "compare/verdict/verdict.hpp"
#include "tools/baseline.hpp"
#include "tools/rendering.hpp"
#include "tools/report/job_report.hpp"
#include "tools/report/statistics_report.hpp"

namespace tandem::tools {

/// All that `tandem diff` found out.
struct DiffReport {
  JobSummary job;
  Rendering a;
  Rendering b;
  compare::Metrics metrics;
  std::optional<compare::DetailedMetrics> detailed_metrics;
  compare::Thresholds thresholds;
  compare::Verdict verdict;
  std::optional<Statistics> statistics;                   ///< in tier statistical; a and b are then means of batches
  std::optional<compare::Classification> classification;  ///< where it was asked for
  std::optional<compare::Probing> probes;                 ///< where it was asked to probe
  std::optional<Baseline> baseline;                       ///< where a stored run was given
};

/// A sentence for each thing that is not as it must be, those of the verdict first. None: the exit code is 0.
std::vector<std::string> failures(const DiffReport& report);

/// The aligned table for people, with a line break at its end.
std::string table(const DiffReport& report);

/// The same for programs; docs/guide/user-guide.md lists the keys.
nlohmann::ordered_json to_json(const DiffReport& report);

}  // namespace tandem::tools
