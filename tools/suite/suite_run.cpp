#include "tools/suite/suite_run.hpp"
#include "base/progress.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <new>
#include <optional>
#include <utility>

#include "base/error.hpp"
#include "base/text_file.hpp"
#include "compare/image/difference.hpp"
#include "pathtracer/image/image_io.hpp"
#include "tools/options/job.hpp"
#include "tools/output/interruption.hpp"
#include "tools/output/output_file.hpp"
#include "tools/output/progress_bar.hpp"
#include "tools/output/run_record.hpp"
#include "tools/report/comparison_report.hpp"
#include "tools/report/device_json.hpp"
#include "tools/report/job_report.hpp"
#include "tools/report/report_page.hpp"
#include "tools/suite/gallery.hpp"
#include "tools/suite/program_hash.hpp"

namespace tandem::tools {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::uint32_t largest_picture = 256;

/// The result in the file of the folder, if it is there, whole, and one of this key.
std::optional<Json> read_result(const std::filesystem::path& folder, const std::filesystem::path& path,
                                const Json& key) {
  std::string text;
  try {
    text = read_text(folder / path);
  } catch (const Error&) {
    return std::nullopt;
  }
  const Json json = Json::parse(text, nullptr, false);
  // Through text, so that both have numbers as a file has them.
  if (!json.is_object() || json.value("key", Json()) != Json::parse(json_text(key))) return std::nullopt;
  if (json.value("state", Json()) == "failed") return std::nullopt;
  for (const char* file_key : {"picture", "difference", "page"}) {
    if (!json.contains(file_key)) continue;
    if (!json.at(file_key).is_string()) return std::nullopt;
    if (!std::filesystem::exists(folder / json.at(file_key).get<std::string>())) return std::nullopt;
  }
  return json;
}

/// Everything that a cell's result depends on.
Json key_of(const SuiteCell& cell, const compare::Job& job, const compare::ComparedDevices& devices,
            const compare::Thresholds& thresholds, const std::string& program) {
  Json rules = {{"tier", compare::name(thresholds.tier)}};
  for (const compare::Rule& rule : thresholds.rules) rules[compare::name(rule.metric)] = {rule.limit, rule.reason};
  return {{"version", TANDEM_VERSION},
          {"program", program},
          {"job", to_json(summary(job))},
          {"given", cell.given},
          {"thresholds", rules},
          {"device_a", to_json(devices.a->info())},
          {"device_b", to_json(devices.b->info())}};
}

std::filesystem::path cell_path(const SuiteCell& cell, const char* ending) {
  return std::filesystem::path(suite_cells_folder) / (cell.name + ending);
}

}  // namespace

SuiteRun::SuiteRun(std::filesystem::path folder, bool fresh)
    : folder_(std::move(folder)), fresh_(fresh), program_(program_hash()) {}

const SuiteRun::OpenDevice& SuiteRun::device(const std::string& name, const RenderOptions& options) {
  const auto known = devices_.find(name);
  if (known != devices_.end()) return known->second;
  OpenDevice device{.handle = open_device(name, options), .programs = {}};
  device.programs = std::make_shared<pathtracer::ProgramStore>(device.handle);
  return devices_.emplace(name, std::move(device)).first->second;
}

SuiteResult SuiteRun::try_run(const SuiteCell& cell, compare::Comparison& comparison, std::string& page) {
  compare::Job job = load_job(cell.render);
  compare::ComparisonOptions options = comparison_options(cell.comparison, cell.render);
  if (cell.report) options = with_metrics_for_page(options);
  compare::ComparedDevices devices;
  const auto open = [&](const std::string& name, rhi::DeviceHandle& handle, pathtracer::ProgramStoreHandle& programs) {
    const OpenDevice& opened = device(name, cell.render);
    handle = opened.handle;
    programs = opened.programs;
  };
  open(cell.comparison.a, devices.a, devices.programs_a);
  open(cell.comparison.b, devices.b, devices.programs_b);
  if (options.classify) open(cell.comparison.arbiter, devices.arbiter, devices.programs_arbiter);
  const Json key = key_of(cell, job, devices, options.thresholds, program_);
  if (!fresh_)
    if (std::optional<Json> earlier = read_result(folder_, cell_path(cell, ".json"), key))
      return {.json = std::move(*earlier), .reused = true};
  std::optional<ShownStage> stage(building_stage);
  compare::Session session = prepare(std::move(devices), std::move(job), options);
  stage.reset();
  comparison = compare_devices(session, progress_bars());
  Json report = to_json(comparison);
  report["date"] = date_text();
  if (cell.report) page = report_page(session, comparison, json_text(report));
  const std::vector<std::string>& reasons = comparison.verdict.reasons;
  SuiteResult result{.json = {{"state", compare::name(comparison.verdict)},
                              {"reasons", reasons},
                              {"report", report},
                              {"picture", cell_path(cell, ".png").string()},
                              {"difference", cell_path(cell, "_difference.png").string()},
                              {"key", key}}};
  if (cell.report) result.json["page"] = (cell_path(cell, "") / "index.html").string();
  return result;
}

SuiteResult SuiteRun::run(const SuiteCell& cell) {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point started = Clock::now();
  compare::Comparison comparison;
  std::string page;
  SuiteResult result;
  const auto fail = [&](const std::string& sentence) {
    // Whatever state they are in.
    devices_.erase(cell.comparison.a);
    devices_.erase(cell.comparison.b);
    devices_.erase(cell.comparison.arbiter);
    result.json = {{"state", "failed"}, {"reasons", {sentence}}, {"report", nullptr}};
  };
  try {
    result = try_run(cell, comparison, page);
  } catch (const Cancelled&) {
    throw;
  } catch (const std::bad_alloc&) {
    fail("not enough memory for this scene and image size");
  } catch (const std::exception& error) {
    fail(error.what());
  }
  if (result.reused) return result;

  Json json = {{"name", cell.name},
               {"scene", cell.scene},
               {"a", cell.comparison.a},
               {"b", cell.comparison.b},
               {"settings", cell.settings},
               {"date", date_text()},
               {"seconds", std::chrono::duration<double>(Clock::now() - started).count()}};
  json.update(result.json);
  result.json = std::move(json);
  if (!result.failed()) {
    const auto write = [&](const char* file, const pathtracer::Image& image) {
      pathtracer::write_image(folder_ / result.json.at(file).get<std::string>(), reduced(image, largest_picture), {});
    };
    write("picture", comparison.a.image);
    write("difference", compare::heat_map(comparison.a.image, comparison.b.image));
    if (cell.report) {
      const OutputFolder folder(folder_ / cell_path(cell, ""));
      write_text(folder.path() / "index.html", page);
    }
  }
  write_text(folder_ / cell_path(cell, ".json"), json_text(result.json));
  return result;
}

compare::Outcome outcome_of(const std::vector<SuiteResult>& results) {
  compare::Outcome outcome = compare::Outcome::agree;
  for (const SuiteResult& result : results)
    if (!result.agrees())
      outcome = compare::worse(
          outcome, result.json.at("state") == "explained" ? compare::Outcome::explained : compare::Outcome::differ);
  return outcome;
}

nlohmann::ordered_json to_json(const std::vector<SuiteResult>& results) {
  const auto count = [&](const char* state) {
    return std::ranges::count_if(results, [&](const SuiteResult& each) { return each.json.at("state") == state; });
  };
  Json json = {{"verdict", compare::name(outcome_of(results))},
               {"agree", count("agree")},
               {"explained", count("explained")},
               {"differ", count("differ")},
               {"failed", count("failed")},
               {"format", json_format},
               {"version", TANDEM_VERSION},
               {"cells", Json::array()}};
  for (const SuiteResult& result : results) {
    Json cell = result.json;
    cell.erase("key");
    cell["reused"] = result.reused;
    json["cells"].push_back(std::move(cell));
  }
  return json;
}

std::vector<JunitCase> junit_cases(const std::vector<SuiteResult>& results) {
  std::vector<JunitCase> cases;
  for (const SuiteResult& result : results) {
    const Json& json = result.json;
    JunitCase each{.group = json.at("scene"),
                   .name = fmt::format("{} against {}, {}", json.at("a").get<std::string>(),
                                       json.at("b").get<std::string>(), json.at("settings").get<std::string>()),
                   .seconds = json.at("seconds"),
                   .failures = {},
                   .error = {}};
    if (json.at("state") != "explained") each.failures = json.at("reasons").get<std::vector<std::string>>();
    if (result.failed()) std::swap(each.error, each.failures.front());
    cases.push_back(std::move(each));
  }
  return cases;
}

}  // namespace tandem::tools
