#include "tools/program/job_file.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/json_value.hpp"

namespace tandem::tools::program_run {
namespace {

class JobFile {
 public:
  JobFile(const std::filesystem::path& path, RunOptions& options)
      : file_(path.string()), folder_(path.parent_path()), options_(options) {}

  void read(const json::Value& root) {
    const json::Object job(
        root, {"$schema", "define", "include", "buffers", "images", "samplers", "scene", "opaque", "launches", "save"});
    if (const auto defines = job.get("define"))
      for (const auto& [name, value] : defines->members()) options_.defines.push_back({name, text_of(value)});
    if (const auto folders = job.get("include"))
      for (const json::Value& folder : folders->elements())
        options_.include_directories.push_back(folder_ / folder.text());
    add(job, "buffers", options_.buffers);
    add(job, "images", options_.images);
    add(job, "samplers", options_.samplers);
    add(job, "save", options_.saves);
    job.read("opaque", options_.is_opaque, &json::Value::boolean);
    if (const auto scene = job.get("scene")) {
      if (scene->is_object())
        add(job, "scene", options_.scenes);
      else
        options_.scenes.push_back(setting("scene", "", *scene));
    }
    for (const json::Value& launch : job.require("launches").elements()) read_launch(launch);
    if (options_.launches.empty()) job.require("launches").fail("names no launch");
  }

 private:
  /// A value as an option has it: lists with commas.
  static std::string text_of(const json::Value& value) {
    if (value.is_string()) return value.text();
    if (value.is_boolean()) return value.boolean() ? "true" : "false";
    if (!value.is_array()) return fmt::format("{}", value.double_number({}));
    std::string text;
    for (const json::Value& element : value.elements()) text += (text.empty() ? "" : ",") + text_of(element);
    return text;
  }

  Setting setting(const std::string& place, const std::string& key, const json::Value& value) const {
    return {.where = fmt::format("{}: {}{}{}", file_, place, key.empty() ? "" : ".", key),
            .key = key,
            .value = text_of(value),
            .folder = folder_};
  }

  void add(const json::Object& object, const std::string& key, std::vector<Setting>& settings,
           const std::string& place = "") const {
    if (const auto values = object.get(key))
      for (const auto& [name, value] : values->members()) settings.push_back(setting(place + key, name, value));
  }

  void read_launch(const json::Value& value) {
    const json::Object object(value, {"shader", "shaders", "entry", "hit_groups", "constants", "push", "records",
                                      "bind", "groups", "size", "recursion"});
    const std::string place = fmt::format("launches[{}].", options_.launches.size());
    Launch launch;
    if (const auto shader = object.get("shader")) launch.shaders.push_back(folder_ / shader->text());
    if (const auto shaders = object.get("shaders"))
      for (const json::Value& shader : shaders->elements()) launch.shaders.push_back(folder_ / shader.text());
    if (launch.shaders.empty()) value.fail("must have a shader");
    object.read("entry", launch.entry_point, &json::Value::text);
    if (const auto groups = object.get("hit_groups"))
      for (const json::Value& group : groups->elements()) {
        Setting files{.where = file_ + ": " + place + "hit_groups", .key = {}, .value = {}};
        for (const json::Value& shader : group.elements())
          files.value += (files.value.empty() ? "" : ",") + (folder_ / shader.text()).string();
        launch.hit_groups.push_back(std::move(files));
      }
    add(object, "constants", launch.specialization, place);
    add(object, "records", launch.records, place);
    add(object, "bind", launch.bind, place);
    if (const auto push = object.get("push")) {
      if (push->is_object())
        add(object, "push", launch.push, place);
      else
        launch.push.push_back(setting(place + "push", "", *push));
    }
    if (const auto groups = object.get("groups")) launch.groups = setting(place + "groups", "", *groups);
    if (const auto size = object.get("size")) launch.size = setting(place + "size", "", *size);
    if (const auto depth = object.get("recursion")) launch.max_recursion_depth = depth->whole_number(1, 31);
    options_.launches.push_back(std::move(launch));
  }

  std::string file_;
  std::filesystem::path folder_;
  RunOptions& options_;
};

}  // namespace

void read_job_file(const std::filesystem::path& path, RunOptions& options) {
  const nlohmann::json json = json::parse(path);
  JobFile(path, options).read(json::Value(json, path.string(), ""));
}

}  // namespace tandem::tools::program_run
