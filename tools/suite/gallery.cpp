#include "tools/suite/gallery.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "base/json_value.hpp"
#include "base/printable.hpp"
#include "tools/report/device_json.hpp"

namespace tandem::tools {
namespace {

const char* const usual_bit_equal_reason =
    "paths that meet edges or flip a rounded decision are fewer than one in a thousand";

/// Relative to the pages.
const char* const pictures_folder = "images/gallery";

}  // namespace

std::vector<GalleryScene> read_gallery(const std::filesystem::path& path) {
  using namespace json;
  const nlohmann::json document = json::parse(path);
  const Object root(Value(document, path.string(), ""), {"scenes"});
  std::vector<GalleryScene> scenes;
  for (const Value& value : root.require("scenes").elements()) {
    const Object object(value, {"file", "title", "spp"}, {{"samples", "spp"}});
    GalleryScene scene;
    const Value file = object.require("file");
    scene.file = path.parent_path() / file.text();
    if (!std::filesystem::exists(scene.file))
      file.fail(fmt::format("names '{}', which does not exist", scene.file.string()));
    scene.name = printable(scene.file.stem().string());
    scene.title = object.require("title").text();
    object.read("spp", scene.samples, &Value::whole_number, 1u, 1u << 24);
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

std::filesystem::path picture_path(const GalleryScene& scene) {
  return std::filesystem::path(pictures_folder) / (scene.name + ".png");
}

std::filesystem::path difference_path(const GalleryScene& scene) {
  return std::filesystem::path(pictures_folder) / (scene.name + "_difference.png");
}

compare::Outcome outcome_of(const std::vector<GalleryResult>& results) {
  compare::Outcome outcome = compare::Outcome::agree;
  for (const GalleryResult& result : results) outcome = compare::worse(outcome, result.comparison.verdict.outcome);
  return outcome;
}

nlohmann::ordered_json to_json(const Gallery& gallery) {
  nlohmann::ordered_json json;
  json["verdict"] = compare::name(outcome_of(gallery.results));
  json["format"] = json_format;
  json["version"] = TANDEM_VERSION;
  json["date"] = gallery.date;
  json["command"] = gallery.command;
  json["listed"] = gallery.listed;
  json["scenes"] = nlohmann::ordered_json::array();
  for (const GalleryResult& result : gallery.results) {
    const GalleryScene& scene = result.scene;
    nlohmann::ordered_json entry = {{"name", scene.name}, {"title", scene.title}};
    entry.update(to_json(result.comparison));
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
