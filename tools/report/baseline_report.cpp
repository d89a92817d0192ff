#include "tools/report/baseline_report.hpp"

#include <fmt/format.h>

#include <iterator>

namespace tandem::tools {
namespace {

nlohmann::ordered_json side_json(const BaselineSide& side) {
  return {{"verdict", compare::name(side.verdict)},
          {"reasons", side.verdict.reasons},
          {"bit_equal", side.metrics.bit_equal},
          {"within_1e5", side.metrics.within_1e5},
          {"within_1e3", side.metrics.within_1e3},
          {"max_abs", side.metrics.max_abs},
          {"rmse", side.metrics.rmse},
          {"ms_before", side.milliseconds_before},
          {"ms_now", side.milliseconds_now}};
}

bool images_changed(const Baseline& baseline) {
  return baseline.a.metrics.bit_equal < 1 || baseline.b.metrics.bit_equal < 1;
}

}  // namespace

std::string table(const Baseline& baseline) {
  std::string text;
  const auto line = [&](const std::string& name, const std::string& value) {
    fmt::format_to(std::back_inserter(text), "{:<18}{}\n", name, value);
  };
  line("baseline", baseline.folder);
  const auto add_side = [&](const char* name, const BaselineSide& side) {
    line(name, fmt::format("{}, {:.5f} % bit-equal, max difference {:.6g}, {:.2f} ms then, {:.2f} ms now",
                           compare::name(side.verdict), 100 * side.metrics.bit_equal, side.metrics.max_abs,
                           side.milliseconds_before, side.milliseconds_now));
    for (const std::string& reason : side.verdict.reasons) line("", reason);
  };
  add_side("a since then", baseline.a);
  add_side("b since then", baseline.b);
  if (baseline.changes.empty())
    line("changed", images_changed(baseline) ? "the images, with the same devices, drivers and version" : "nothing");
  for (const BaselineChange& change : baseline.changes)
    line("changed", fmt::format("{}: {}, was {}", change.what, change.now, change.before));
  return text;
}

nlohmann::ordered_json to_json(const Baseline& baseline) {
  nlohmann::ordered_json json = {{"folder", baseline.folder},
                                 {"verdict", compare::name(baseline.outcome())},
                                 {"a", side_json(baseline.a)},
                                 {"b", side_json(baseline.b)},
                                 {"changes", nlohmann::ordered_json::array()}};
  for (const BaselineChange& change : baseline.changes)
    json["changes"].push_back({{"what", change.what}, {"before", change.before}, {"now", change.now}});
  return json;
}

}  // namespace tandem::tools
