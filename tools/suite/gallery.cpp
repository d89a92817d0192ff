#include "tools/suite/gallery.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "base/json_value.hpp"
#include "base/printable.hpp"
#include "tools/report/device_json.hpp"
#include "tools/report/job_report.hpp"

namespace tandem::tools {
namespace {

const char* const usual_bit_equal_reason =
    "paths that meet edges or flip a rounded decision are fewer than one in a thousand";

double relative_mean_difference(const compare::Metrics& metrics) {
  const double largest = std::max(std::abs(metrics.mean_a), std::abs(metrics.mean_b));
  return largest > 0 ? std::abs(metrics.mean_a - metrics.mean_b) / largest : 0.0;
}

const compare::Rule& bit_equal(const compare::Comparison& comparison) {
  return comparison.thresholds.rule(compare::RuleMetric::bit_equal);
}

}  // namespace

std::vector<GalleryScene> read_gallery(const std::filesystem::path& path) {
  using namespace json;
  const nlohmann::json document = json::parse(path);
  const Object root(Value(document, path.string(), ""), {"scenes"});
  std::vector<GalleryScene> scenes;
  for (const Value& value : root.require("scenes").elements()) {
    const Object object(value, {"file", "title", "samples"});
    GalleryScene scene;
    scene.file = path.parent_path() / object.require("file").text();
    scene.name = printable(scene.file.stem().string());
    scene.title = object.require("title").text();
    object.read("samples", scene.samples, &Value::whole_number, 1u, 1u << 24);
    if (std::ranges::any_of(scenes, [&](const GalleryScene& other) { return other.name == scene.name; }))
      value.fail(fmt::format("has the same name as another scene, {}", scene.name));
    scenes.push_back(scene);
  }
  if (scenes.empty()) root.require("scenes").fail("must not be empty");
  return scenes;
}

compare::Thresholds gallery_thresholds() {
  compare::Thresholds thresholds;
  thresholds.set({compare::RuleMetric::bit_equal, 0.999, usual_bit_equal_reason});
  return thresholds;
}

std::string gallery_markdown(const std::vector<GalleryResult>& results, const std::string& pictures) {
  std::string text = "# Gallery\n\n";
  const auto line = [&](const std::string& words) { text += words + "\n"; };
  if (!results.empty()) {
    const compare::Comparison& first = results.front().comparison;
    line("Written by `tandem gallery`. Each scene is rendered on two devices, from the same shader, seed and scene:\n");
    line("| | device | hardware | driver |\n|---|---|---|---|");
    line(fmt::format("| a | {} | {} | {} |", first.a.device.name, first.a.device.description, first.a.device.driver));
    line(fmt::format("| b | {} | {} | {} |\n", first.b.device.name, first.b.device.description, first.b.device.driver));
    line("The picture is that of a; beside it, bright where b differs from it, the relative difference.\n");
  }
  line("| scene | a | difference | settings | bit-equal pixels | means differ by | seconds a, b | verdict |");
  line("|---|---|---|---|---|---|---|---|");
  for (const auto& [scene, comparison] : results) {
    std::string verdict = compare::name(comparison.verdict);
    if (!comparison.verdict.reasons.empty())
      verdict = fmt::format("**{}**: {}", verdict, fmt::join(comparison.verdict.reasons, "; "));
    line(fmt::format(
        "| {}<br>`{}` | ![{}]({}/{}.png) | ![]({}/{}_difference.png) | {} | {:.3f} %, at least {:g} % | {:.1e} | "
        "{:.2f}, {:.2f} | {} |",
        scene.title, scene.file.filename().string(), scene.title, pictures, scene.name, pictures, scene.name,
        settings_text(comparison.job), 100 * comparison.metrics.bit_equal, 100 * bit_equal(comparison).limit,
        relative_mean_difference(comparison.metrics), comparison.a.milliseconds / 1000,
        comparison.b.milliseconds / 1000, verdict));
  }
  const auto is_unusual = [](const GalleryResult& r) {
    return bit_equal(r.comparison).reason != usual_bit_equal_reason;
  };
  if (std::ranges::any_of(results, is_unusual)) line("\nWhy some scenes may differ at more pixels:\n");
  for (const GalleryResult& result : results)
    if (is_unusual(result)) line(fmt::format("- `{}`: {}", result.scene.name, bit_equal(result.comparison).reason));
  return text;
}

compare::Outcome outcome_of(const std::vector<GalleryResult>& results) {
  compare::Outcome outcome = compare::Outcome::agree;
  for (const GalleryResult& result : results) outcome = compare::worse(outcome, result.comparison.verdict.outcome);
  return outcome;
}

nlohmann::ordered_json to_json(const std::vector<GalleryResult>& results) {
  nlohmann::ordered_json json;
  json["verdict"] = compare::name(outcome_of(results));
  json["format"] = json_format;
  json["scenes"] = nlohmann::ordered_json::array();
  for (const auto& [scene, comparison] : results) {
    nlohmann::ordered_json entry = {{"name", scene.name}, {"title", scene.title}};
    entry.update(to_json(comparison));
    json["scenes"].push_back(entry);
  }
  return json;
}

pathtracer::Image reduced(const pathtracer::Image& image, std::uint32_t largest) {
  const std::uint32_t factor = (std::max(image.width, image.height) + largest - 1) / largest;
  pathtracer::Image small{
      .width = std::max(image.width / factor, 1u), .height = std::max(image.height / factor, 1u), .pixels = {}};
  for (std::uint32_t y = 0; y < small.height; ++y)
    for (std::uint32_t x = 0; x < small.width; ++x) {
      glm::dvec3 sum(0);
      std::uint32_t count = 0;
      for (std::uint32_t j = y * factor; j < std::min((y + 1) * factor, image.height); ++j)
        for (std::uint32_t i = x * factor; i < std::min((x + 1) * factor, image.width); ++i, ++count)
          sum += glm::dvec3(image.at(i, j));
      small.pixels.emplace_back(sum / double(count));
    }
  return small;
}

}  // namespace tandem::tools
