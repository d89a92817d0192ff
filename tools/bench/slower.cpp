#include "tools/bench/slower.hpp"

#include <fmt/format.h>

#include <array>
#include <map>
#include <nlohmann/json.hpp>

#include "base/error.hpp"
#include "tools/report/interval.hpp"

namespace tandem::tools {
namespace {

using Json = nlohmann::ordered_json;

/// Of fewer, the intervals of equal times fail to overlap in some percent of cases.
constexpr std::size_t fewest_rounds = 5;

struct Series {
  std::string name;  ///< as a person reads it
  std::vector<double> times;
};

/// By all that must be the same for two series to be compared. The scene's file may have moved: its content may not.
std::map<std::string, Series> series_of(const Json& report) {
  std::map<std::string, Series> all;
  for (const Json& run : report.at("runs")) {
    Json settings = run.at("settings");
    std::string name = settings.at("scene").get<std::string>();
    settings.erase("scene");
    for (const auto& [option, value] : run.at("varied").items())
      name += fmt::format(", {} {}", option, value.get<std::string>());
    for (const Json& device : run.at("devices")) {
      const auto device_name = device.at("name").get<std::string>();
      all[fmt::format("{}|{}|{}|{}", settings.dump(), device_name, device.at("trace").get<std::string>(),
                      device.at("threads").get<std::uint32_t>())] = {
          .name = fmt::format("{} on {}", name, device_name),
          .times = device.at("ms_rounds").get<std::vector<double>>()};
    }
  }
  return all;
}

}  // namespace

SpeedChanges speed_changes(const Json& stored, const Json& now, double tolerance) {
  SpeedChanges changes;
  std::map<std::string, Series> before;
  try {
    before = series_of(stored);
  } catch (const nlohmann::json::exception& error) {
    throw Error(fmt::format("it is not what 'tandem bench --json' writes ({})", error.what()));
  }
  const std::map<std::string, Series> after = series_of(now);
  for (const auto* each : std::array<const std::map<std::string, Series>*, 2>{&before, &after})
    for (const auto& [key, series] : *each)
      if (series.times.size() < fewest_rounds)
        throw Error(fmt::format("{}: {} rounds are too few to tell what became slower; --repeat {} is the least",
                                series.name, series.times.size(), fewest_rounds));
  for (const auto& [key, series] : before)
    if (!after.contains(key)) changes.gone.push_back(series.name);
  if (changes.gone.size() == before.size()) throw Error("it has no scene under the same settings on the same device");
  for (const auto& [key, series] : after) {
    const auto found = before.find(key);
    if (found == before.end()) {
      changes.unmatched.push_back(series.name);
      continue;
    }
    const MedianInterval then = median_interval(found->second.times), today = median_interval(series.times);
    const std::string sentence = fmt::format("{}: {:.2f} ms in place of {:.2f}, {:.2f} times", series.name,
                                             today.median, then.median, today.median / then.median);
    if (today.least > then.most && today.median > then.median * (1 + tolerance))
      changes.slower.push_back(sentence);
    else if (today.most < then.least && today.median * (1 + tolerance) < then.median)
      changes.faster.push_back(sentence);
    else
      ++changes.unchanged;
  }
  return changes;
}

}  // namespace tandem::tools
