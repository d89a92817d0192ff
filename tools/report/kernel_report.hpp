#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "rhi/device.hpp"

namespace tandem::tools {

/// What one device did with a kernel in each round of `tandem bench --kernels`.
struct KernelSeries {
  double compile_milliseconds = 0.0;      ///< from GLSL to a pipeline; drivers may compile in the first round
  std::vector<double> milliseconds = {};  ///< of each round
};

struct KernelMeasurement {
  std::string name;
  std::string description;
  std::vector<KernelSeries> series;  ///< of each device
};

struct KernelReport {
  std::uint32_t threads = 0;             ///< of the CPU devices; 0: all
  std::vector<rhi::DeviceInfo> devices;  ///< in the order of the command line
  std::vector<KernelMeasurement> kernels;
};

/// The aligned table for people: medians, with the least and the most in brackets.
std::string table(const KernelReport& report);

/// The same for programs, with every round.
nlohmann::ordered_json to_json(const KernelReport& report);

}  // namespace tandem::tools
