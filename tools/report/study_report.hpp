#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "compare/study/sampling_study.hpp"
#include "rhi/device.hpp"

namespace tandem::tools {

/// What `tandem study sampling` measured.
struct StudyReport {
  rhi::DeviceInfo device;
  study::StudySettings settings;
  std::vector<study::SceneResult> scenes;
};

/// The tables in Markdown, which reads well on a terminal too.
std::string markdown(const StudyReport& report);

/// The same for programs, with every measurement.
nlohmann::ordered_json to_json(const StudyReport& report);

}  // namespace tandem::tools
