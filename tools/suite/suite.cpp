#include "tools/suite/suite.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <optional>
#include <set>
#include <utility>

#include "base/json_value.hpp"
#include "base/printable.hpp"
#include "tools/options/option_words.hpp"

namespace tandem::tools {
namespace {

using Json = nlohmann::json;
using json::Object;
using json::Value;

struct SuiteScene {
  std::filesystem::path file;
  std::string name;
  Json settings = Json::object();
  std::string place;  ///< of the settings, for messages
};

struct NamedSettings {
  std::string name;
  Json settings = Json::object();
  std::string place;
};

struct DevicePair {
  std::string a, b;
};

/// Of the machine, not of what is compared: the command line says them for the whole suite.
bool is_about_execution(const std::string& option) {
  return option == "--threads" || option == "--validation" || option == "--help";
}

/// A value as it stands on a command line.
std::string option_text(const Value& place, const Json& value, bool is_flag) {
  if (value.is_boolean()) return is_flag ? value.dump() : (value.get<bool>() ? "on" : "off");
  if (value.is_string() && !is_flag) return value.get<std::string>();
  if (value.is_number() && !is_flag) return value.dump();
  if (value.is_array() && !is_flag && std::ranges::all_of(value, [](const Json& each) { return each.is_number(); })) {
    std::vector<std::string> numbers;
    for (const Json& each : value) numbers.push_back(each.dump());
    return fmt::format("{}", fmt::join(numbers, ","));
  }
  place.fail(is_flag ? "must be true or false" : "must be a text, a number, a list of numbers, true or false");
}

/// Sets an option of `tandem diff` by its long name, with underscores for hyphens, or whether there is a report.
void set_option(SuiteCell& cell, const Value& place, const std::string& key, const Json& value) {
  if (key == "report") {  // whose folder is the suite's
    cell.report = place.boolean();
    return;
  }
  CLI::App app;
  add_render_options(app, cell.render);
  add_comparison_options(app, cell.comparison);
  std::string option = "--" + key;
  std::ranges::replace(option, '_', '-');
  option = current_name(option);
  const CLI::Option* const known = app.get_option_no_throw(option);
  if (known == nullptr || is_about_execution(option) || key.find('-') != std::string::npos)
    place.fail("is not an option of 'tandem diff' that a suite can set");
  const std::string text = option_text(place, value, known->get_items_expected_max() == 0);
  try {
    app.parse({fmt::format("{}={}", option, text), "scene"});  // in reverse order; the scene is set elsewhere
  } catch (const CLI::ParseError& error) {
    std::string sentence = error.what();
    if (sentence.starts_with(option + ": ")) sentence.erase(0, option.size() + 2);
    place.fail(fmt::format("cannot be used: {}", sentence));
  }
}

/// Applies settings, one member after the other. What another has set before is overwritten.
void apply_settings(SuiteCell& cell, const std::string& file, const std::string& place, const Json& settings) {
  for (const auto& [key, value] : settings.items()) {
    set_option(cell, Value(value, file, fmt::format("{}.{}", place, key)), key, value);
    cell.given[key] = value;
  }
}

std::vector<SuiteScene> read_scenes(const Json& root, const Value& list, const std::filesystem::path& folder) {
  std::vector<SuiteScene> scenes;
  for (std::size_t index = 0; const Value& value : list.elements()) {
    SuiteScene scene;
    std::optional<Value> name;
    std::optional<Value> file = value;
    if (!value.is_string()) {
      const Object object(value, {"file", "name", "settings"});
      file = object.require("file");
      name = object.get("name");
      if (const auto settings = object.get("settings")) {
        settings->members();  // an object
        scene.settings = root.at("scenes").at(index).at("settings");
        scene.place = fmt::format("scenes[{}].settings", index);
      }
    }
    scene.file = folder / file->text();
    if (!std::filesystem::exists(scene.file))
      file->fail(fmt::format("names '{}', which does not exist", scene.file.string()));
    scene.name = printable(name ? name->text() : scene.file.stem().string());
    scenes.push_back(std::move(scene));
    ++index;
  }
  if (scenes.empty()) list.fail("must not be empty");
  return scenes;
}

std::vector<DevicePair> read_devices(const std::optional<Value>& list) {
  if (!list) return {{"cpu", "vulkan"}};
  std::vector<DevicePair> pairs;
  for (const Value& value : list->elements()) {
    std::vector<std::string> names;
    for (const Value& name : value.elements()) names.push_back(name.text());
    if (names.size() < 2) value.fail("must name at least two devices");
    for (std::size_t first = 0; first < names.size(); ++first)
      for (std::size_t second = first + 1; second < names.size(); ++second)
        pairs.push_back({names[first], names[second]});
  }
  if (pairs.empty()) list->fail("must not be empty");
  return pairs;
}

std::vector<NamedSettings> read_settings(const Json& root, const std::optional<Value>& list) {
  if (!list) return {{.name = "default", .settings = Json::object(), .place = {}}};
  std::vector<NamedSettings> all;
  for (std::size_t index = 0; const Value& value : list->elements()) {
    NamedSettings settings;
    for (const auto& [key, member] : value.members())
      if (key == "name") settings.name = printable(member.text());
    if (settings.name.empty()) value.fail("must have a name");
    settings.settings = root.at("settings").at(index);
    settings.settings.erase("name");
    settings.place = fmt::format("settings[{}]", index);
    all.push_back(std::move(settings));
    ++index;
  }
  if (all.empty()) list->fail("must not be empty");
  return all;
}

/// For a file: whatever is no letter, digit, point or underscore becomes a hyphen.
std::string file_name(const SuiteCell& cell) {
  std::string name = fmt::format("{}-{}-{}-{}", cell.scene, cell.comparison.a, cell.comparison.b, cell.settings);
  std::ranges::replace_if(
      name,
      [](char c) {
        return !(c >= 'a' && c <= 'z') && !(c >= 'A' && c <= 'Z') && !(c >= '0' && c <= '9') && c != '.' && c != '_';
      },
      '-');
  return name;
}

}  // namespace

Suite read_suite(const std::filesystem::path& path, const RenderOptions& execution) {
  const Json document = json::parse(path);
  const std::string file = path.string();
  const Object root(Value(document, file, ""), {"$schema", "title", "scenes", "devices", "settings"});
  const std::vector<SuiteScene> scenes = read_scenes(document, root.require("scenes"), path.parent_path());
  const std::vector<DevicePair> devices = read_devices(root.get("devices"));
  const std::vector<NamedSettings> columns = read_settings(document, root.get("settings"));
  Suite suite{.title = path.stem().string(), .cells = {}};
  root.read("title", suite.title, &Value::text);
  std::set<std::string> names;
  for (const SuiteScene& scene : scenes)
    for (const DevicePair& pair : devices)
      for (const NamedSettings& column : columns) {
        SuiteCell cell;
        cell.scene = scene.name;
        cell.settings = column.name;
        cell.given = nlohmann::ordered_json::object();
        cell.render = execution;
        cell.render.scene = scene.file;
        apply_settings(cell, file, column.place, column.settings);
        apply_settings(cell, file, scene.place, scene.settings);
        cell.render.scene = scene.file;
        cell.comparison.a = pair.a;
        cell.comparison.b = pair.b;
        cell.name = file_name(cell);
        if (!names.insert(cell.name).second)
          throw Error(fmt::format("{}: two comparisons would be called '{}'", file, cell.name));
        suite.cells.push_back(std::move(cell));
      }
  return suite;
}

}  // namespace tandem::tools
