#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace tandem::tools {

/// What a run says beside a stored one.
struct SpeedChanges {
  std::vector<std::string> slower;     ///< sentences: series that became slower
  std::vector<std::string> faster;     ///< likewise
  std::vector<std::string> unmatched;  ///< series that the stored run does not have
  std::vector<std::string> gone;       ///< series that only the stored run has
  std::size_t unchanged = 0;
};

/// Matches series by scene, settings, device, form of tracing and threads. One has become slower where the medians
/// differ by more than `tolerance`, and the intervals that hold them do not overlap: of five equal rounds each, in 1 of
/// 250 cases. The runs did not take turns: the machine must be the same, and as busy as it was. Throws Error where
/// `stored` is not what 'tandem bench --json' writes.
SpeedChanges speed_changes(const nlohmann::ordered_json& stored, const nlohmann::ordered_json& now,
                           double tolerance = 0.05);

}  // namespace tandem::tools
