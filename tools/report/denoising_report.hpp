#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "compare/study/denoising_study.hpp"
#include "rhi/device.hpp"

namespace tandem::tools {

/// What `tandem study denoising` measured.
struct DenoisingReport {
  rhi::DeviceInfo device;
  study::DenoisingSettings settings;
  std::vector<study::DenoisedScene> scenes;
};

/// The table in Markdown.
std::string markdown(const DenoisingReport& report);

/// The same for programs.
nlohmann::ordered_json to_json(const DenoisingReport& report);

}  // namespace tandem::tools
