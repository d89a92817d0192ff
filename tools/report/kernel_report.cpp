#include "tools/report/kernel_report.hpp"

#include <fmt/format.h>

#include <iterator>

#include "tools/report/device_json.hpp"
#include "tools/report/spread.hpp"

namespace tandem::tools {

std::string table(const KernelReport& report) {
  std::string text =
      fmt::format("{} kernel{}: {} rounds after one to warm up\n\n", report.kernels.size(),
                  report.kernels.size() == 1 ? "" : "s", report.kernels.front().series.front().milliseconds.size());
  const auto row = [&](const auto&... cells) {
    fmt::format_to(std::back_inserter(text), "{:<20}{:<12}{:<30}{}\n", cells...);
  };
  row("kernel", "device", "ms (min, max)", "times the first device's speed (min, max)");
  for (const KernelMeasurement& kernel : report.kernels) {
    for (std::size_t i = 0; i < kernel.series.size(); ++i) {
      const KernelSeries& series = kernel.series[i];
      const Spread times = spread(series.milliseconds);
      const Spread ratio = speed_ratio(kernel.series.front().milliseconds, series.milliseconds);
      row(i == 0 ? kernel.name : "", report.devices[i].name,
          fmt::format("{:.2f} ({:.2f}, {:.2f})", times.median, times.least, times.most),
          fmt::format("{:.3f} ({:.3f}, {:.3f})", ratio.median, ratio.least, ratio.most));
    }
  }
  text += '\n';
  for (const KernelMeasurement& kernel : report.kernels)
    fmt::format_to(std::back_inserter(text), "{:<20}{}\n", kernel.name, kernel.description);
  text += '\n';
  for (const rhi::DeviceInfo& device : report.devices)
    fmt::format_to(std::back_inserter(text), "{:<20}{}, {}\n", device.name, device.description, device.driver);
  return text;
}

nlohmann::ordered_json to_json(const KernelReport& report) {
  nlohmann::ordered_json json;
  json["settings"]["threads"] = report.threads;
  json["devices"] = nlohmann::ordered_json::array();
  for (const rhi::DeviceInfo& device : report.devices) json["devices"].push_back(to_json(device));
  json["kernels"] = nlohmann::ordered_json::array();
  for (const KernelMeasurement& kernel : report.kernels) {
    nlohmann::ordered_json entry = {{"name", kernel.name}, {"description", kernel.description}};
    entry["devices"] = nlohmann::ordered_json::array();
    for (std::size_t i = 0; i < kernel.series.size(); ++i) {
      const KernelSeries& series = kernel.series[i];
      nlohmann::ordered_json times;
      times["name"] = report.devices[i].name;
      times["ms"] = to_json(spread(series.milliseconds));
      times["ms_rounds"] = series.milliseconds;
      times["compile_ms"] = series.compile_milliseconds;
      times["speed_ratio"] = to_json(speed_ratio(kernel.series.front().milliseconds, series.milliseconds));
      entry["devices"].push_back(std::move(times));
    }
    json["kernels"].push_back(std::move(entry));
  }
  json["format"] = json_format;
  json["version"] = TANDEM_VERSION;
  return json;
}

}  // namespace tandem::tools
