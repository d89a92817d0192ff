#include "tools/report/baseline.hpp"

#include <fmt/format.h>

#include "base/error.hpp"
#include "base/json_value.hpp"
#include "base/printable.hpp"
#include "pathtracer/image/image_io.hpp"
#include "tools/report/comparison_report.hpp"
#include "tools/report/device_json.hpp"
#include "tools/report/job_report.hpp"

namespace tandem::tools {
namespace {

using Json = nlohmann::json;

[[noreturn]] void refuse(const std::filesystem::path& folder, const std::string& reason) {
  throw Error(fmt::format("'{}' does not hold a run of 'tandem diff --out': {}", folder.string(), reason));
}

/// What settings may be called differently without being different.
Json without_names(Json settings) {
  settings.erase("scene");
  return settings;
}

std::string text(const Json& value) { return shortened(value.is_string() ? value.get<std::string>() : value.dump()); }

BaselineSide compare_side(const pathtracer::Image& before, const Json& milliseconds, const compare::Rendering& now,
                          const compare::Thresholds& thresholds) {
  BaselineSide side;
  side.metrics = compare::measure(before, now.image);
  side.verdict = compare::make_verdict({.metrics = side.metrics}, thresholds);
  side.milliseconds_before = milliseconds;
  side.milliseconds_now = now.milliseconds;
  return side;
}

}  // namespace

StoredRun read_stored_run(const std::filesystem::path& folder) {
  StoredRun run{.folder = folder, .a = {}, .b = {}, .report = {}};
  try {
    run.report = json::parse(folder / stored_report);
    // Whatever is read later.
    for (const char* key : {"settings", "device_a", "device_b"})
      if (!run.report.at(key).is_object()) throw Error(fmt::format("'{}' of {} is not an object", key, stored_report));
    for (const char* key : {"ms_a", "ms_b"}) run.report.at(key).get<double>();
    run.a = pathtracer::read_image(folder / "a.exr");
    run.b = pathtracer::read_image(folder / "b.exr");
  } catch (const Json::exception& error) {
    refuse(folder, fmt::format("{}: {}", stored_report, json::library_sentence(error)));
  } catch (const Error& error) {
    refuse(folder, error.what());
  }
  return run;
}

void check_same_job(const StoredRun& run, const compare::JobSummary& job, const pathtracer::Camera& camera,
                    const glm::vec3& background) {
  // Through text, so that both have numbers as a file has them.
  const Json now = without_names(Json::parse(settings_json(job, camera, background).dump()));
  const Json before = without_names(run.report.at("settings"));
  const auto fail = [&](const std::string& reason) {
    throw Error(fmt::format("the run in '{}' cannot be the baseline: {}", run.folder.string(), reason));
  };
  if (run.report.contains("statistics")) fail("its images are of tier statistical, the means of many seeds");
  if (before.value("scene_hash", Json()) != now.at("scene_hash"))
    fail(fmt::format("the content of {} has changed since", job.scene));
  for (const auto& [key, value] : now.items()) {
    const Json stored = before.value(key, Json());
    if (stored != value) fail(fmt::format("its {} is {}, not {}", key, text(stored), text(value)));
  }
  for (const pathtracer::Image* image : {&run.a, &run.b})
    if (image->width != job.settings.width || image->height != job.settings.height)
      fail(fmt::format("its images are not of {}x{} pixels", job.settings.width, job.settings.height));
}

Baseline compare_with(const StoredRun& run, const compare::Comparison& comparison) {
  Baseline baseline{.folder = run.folder.string(),
                    .a = compare_side(run.a, run.report.at("ms_a"), comparison.a, comparison.thresholds),
                    .b = compare_side(run.b, run.report.at("ms_b"), comparison.b, comparison.thresholds),
                    .changes = {}};
  const Json now = Json::parse(json_text(to_json(comparison)));
  const auto note = [&](const std::string& what, const Json& before_value, const Json& now_value) {
    if (before_value != now_value) baseline.changes.push_back({what, text(before_value), text(now_value)});
  };
  note("version", run.report.value("version", Json()), now.at("version"));
  note("verdict", run.report.value("verdict", Json()), now.at("verdict"));
  for (const char side : {'a', 'b'}) {
    const std::string device = fmt::format("device_{}", side);
    for (const auto& [key, value] : now.at(device).items())
      note(fmt::format("{} of {}", key, side), run.report.at(device).value(key, Json()), value);
    const std::string trace = fmt::format("trace_{}", side);
    note(fmt::format("trace of {}", side), run.report.value(trace, Json()), now.at(trace));
  }
  return baseline;
}

}  // namespace tandem::tools
