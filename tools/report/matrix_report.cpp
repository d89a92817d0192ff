#include "tools/report/matrix_report.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <utility>

#include "tools/report/device_json.hpp"
#include "tools/report/job_report.hpp"

namespace tandem::tools {
namespace {

/// Ties that the table lists; the JSON has all.
constexpr std::size_t most_listed = 5;

const std::string& device_name(const MatrixReport& report, std::size_t device) {
  return report.renderings[device].device.name;
}

std::vector<std::string> device_names(const MatrixReport& report, const compare::DeviceIndices& devices) {
  std::vector<std::string> names;
  for (const std::size_t device : devices) names.push_back(device_name(report, device));
  return names;
}

const MatrixPair& pair_of(const MatrixReport& report, std::size_t first, std::size_t second) {
  return *std::ranges::find_if(report.pairs, [&](const MatrixPair& pair) {
    return pair.a == std::min(first, second) && pair.b == std::max(first, second);
  });
}

std::string sides_text(const MatrixReport& report, const compare::SplitVote& split) {
  std::vector<std::string> sides;
  for (const compare::DeviceIndices& side : split.sides)
    sides.push_back(fmt::format("{}", fmt::join(device_names(report, side), ", ")));
  return fmt::format("{}", fmt::join(sides, " against "));
}

}  // namespace

bool MatrixReport::agree() const {
  return std::ranges::all_of(pairs,
                             [](const MatrixPair& pair) { return pair.verdict.outcome == compare::Outcome::agree; });
}

MatrixReport compare_all(const compare::JobSummary& job, const compare::Thresholds& thresholds,
                         std::vector<compare::Rendering> renderings) {
  MatrixReport report{.job = job,
                      .thresholds = thresholds,
                      .renderings = std::move(renderings),
                      .pairs = {},
                      .vote = {},
                      .outvoted = {}};
  const std::size_t count = report.renderings.size();
  std::vector<std::vector<bool>> agree(count, std::vector<bool>(count, true));
  for (std::size_t a = 0; a < count; ++a)
    for (std::size_t b = a + 1; b < count; ++b) {
      MatrixPair pair{.a = a, .b = b, .metrics = {}, .verdict = {}};
      pair.metrics = compare::measure(report.renderings[a].image, report.renderings[b].image);
      pair.verdict = compare::make_verdict({.metrics = pair.metrics}, thresholds);
      agree[a][b] = agree[b][a] = pair.verdict.outcome == compare::Outcome::agree;
      report.pairs.push_back(std::move(pair));
    }
  std::vector<pathtracer::Image> images;
  for (const compare::Rendering& rendering : report.renderings) images.push_back(rendering.image);
  report.vote = compare::vote(images);
  report.outvoted = compare::outvoted_devices(agree);
  return report;
}

std::vector<std::string> reasons(const MatrixReport& report) {
  std::vector<std::string> sentences;
  for (const std::size_t device : report.outvoted)
    sentences.push_back(
        fmt::format("{} is outvoted: most of the devices agree with each other, and none of them with it.",
                    device_name(report, device)));
  for (const MatrixPair& pair : report.pairs)
    for (const std::string& reason : pair.verdict.reasons)
      sentences.push_back(
          fmt::format("{} (a) against {} (b): {}", device_name(report, pair.a), device_name(report, pair.b), reason));
  return sentences;
}

std::string table(const MatrixReport& report) {
  std::string text;
  const auto line = [&](const std::string& name, const std::string& value) {
    fmt::format_to(std::back_inserter(text), "{:<18}{}\n", name, value);
  };
  const compare::Vote& vote = report.vote;
  line("scene", scene_text(report.job));
  line("settings", settings_text(report.job));
  for (const compare::Rendering& rendering : report.renderings)
    line(rendering.device.name,
         fmt::format("{:.1f} ms, compiling {:.1f} ms", rendering.milliseconds, rendering.compile_milliseconds));
  text += '\n';
  std::string header;
  for (const compare::Rendering& rendering : report.renderings) header += fmt::format("{:>20}", rendering.device.name);
  line("bit-equal", header);
  for (std::size_t row = 0; row < report.renderings.size(); ++row) {
    std::string cells;
    for (std::size_t column = 0; column < report.renderings.size(); ++column) {
      if (column == row) {
        cells += fmt::format("{:>20}", "-");
        continue;
      }
      const MatrixPair& pair = pair_of(report, row, column);
      cells +=
          fmt::format("{:>20}", fmt::format("{:.4f} % {}", 100 * pair.metrics.bit_equal, compare::name(pair.verdict)));
    }
    line(device_name(report, row), cells);
  }
  text += '\n';
  line("vote", fmt::format("{} pixels: {} unanimous, {} within tolerance, {} decided, {} tied", vote.pixels,
                           vote.unanimous, vote.within_tolerance, vote.decided, vote.undecided));
  for (std::size_t device = 0; device < vote.devices.size(); ++device) {
    const compare::DeviceVotes& votes = vote.devices[device];
    const std::string first = votes.beyond_tolerance > 0
                                  ? fmt::format(", first at pixel {},{}", votes.first_beyond.x, votes.first_beyond.y)
                                  : std::string();
    line("", fmt::format("{} is outvoted in {}, beyond tolerance in {}{}", device_name(report, device), votes.outvoted,
                         votes.beyond_tolerance, first));
  }
  for (std::size_t index = 0; index < std::min(vote.splits.size(), most_listed); ++index) {
    const compare::SplitVote& split = vote.splits[index];
    line(index == 0 ? "ties" : "", fmt::format("{}: {}, first at pixel {},{}", sides_text(report, split), split.pixels,
                                               split.first.x, split.first.y));
  }
  text += '\n';
  line("verdict", report.agree() ? "agree" : "differ");
  for (const std::string& reason : reasons(report)) line("", reason);
  return text;
}

nlohmann::ordered_json to_json(const MatrixReport& report) {
  using Json = nlohmann::ordered_json;
  const compare::Rendering& first = report.renderings.front();
  Json json = {{"verdict", report.agree() ? "agree" : "differ"},
               {"reasons", reasons(report)},
               {"outvoted", device_names(report, report.outvoted)},
               {"devices", Json::array()},
               {"pairs", Json::array()}};
  for (std::size_t index = 0; index < report.renderings.size(); ++index) {
    const compare::Rendering& rendering = report.renderings[index];
    const compare::DeviceVotes& votes = report.vote.devices[index];
    Json device = to_json(rendering.device);
    device["trace"] = pathtracer::name(rendering.trace);
    device["ms"] = rendering.milliseconds;
    device["compile_ms"] = rendering.compile_milliseconds;
    device["outvoted"] = votes.outvoted;
    device["beyond_tolerance"] = votes.beyond_tolerance;
    device["first_beyond"] =
        votes.beyond_tolerance > 0 ? Json{votes.first_beyond.x, votes.first_beyond.y} : Json(nullptr);
    json["devices"].push_back(std::move(device));
  }
  for (const MatrixPair& pair : report.pairs)
    json["pairs"].push_back({{"a", device_name(report, pair.a)},
                             {"b", device_name(report, pair.b)},
                             {"verdict", compare::name(pair.verdict)},
                             {"reasons", pair.verdict.reasons},
                             {"bit_equal", pair.metrics.bit_equal},
                             {"within_1e3", pair.metrics.within_1e3},
                             {"max_abs", pair.metrics.max_abs},
                             {"rmse", pair.metrics.rmse}});
  json["vote"] = {{"pixels", report.vote.pixels},
                  {"unanimous", report.vote.unanimous},
                  {"within_tolerance", report.vote.within_tolerance},
                  {"decided", report.vote.decided},
                  {"tied", report.vote.undecided},
                  {"ties", Json::array()}};
  for (const compare::SplitVote& split : report.vote.splits) {
    Json sides = Json::array();
    for (const compare::DeviceIndices& side : split.sides) sides.push_back(device_names(report, side));
    json["vote"]["ties"].push_back(
        {{"sides", sides}, {"pixels", split.pixels}, {"first", {split.first.x, split.first.y}}});
  }
  json["settings"] = settings_json(report.job, first.camera, first.background);
  json["format"] = json_format;
  json["version"] = TANDEM_VERSION;
  return json;
}

}  // namespace tandem::tools
