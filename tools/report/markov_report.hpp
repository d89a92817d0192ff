#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "compare/study/random_walk_study.hpp"
#include "rhi/device.hpp"

namespace tandem::tools {

/// What `tandem study markov` measured.
struct MarkovReport {
  rhi::DeviceInfo device;
  study::RandomWalkSettings settings;
  std::vector<study::FredholmResult> equations;
};

/// The tables in Markdown, which reads well on a terminal too.
std::string markdown(const MarkovReport& report);

/// The same for programs, with every measurement.
nlohmann::ordered_json to_json(const MarkovReport& report);

}  // namespace tandem::tools
