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

/// A page with a plot for each equation: the error of every estimator against the number of walks, beside N^-1/2.
std::string plots_page(const MarkovReport& report);

/// The same for programs, with every measurement.
nlohmann::ordered_json to_json(const MarkovReport& report);

}  // namespace tandem::tools
