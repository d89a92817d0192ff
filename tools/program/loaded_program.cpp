#include "tools/program/loaded_program.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <map>
#include <tuple>
#include <utility>

#include "base/error.hpp"
#include "base/printable.hpp"
#include "program/source/shader_file.hpp"
#include "tools/program/resource_words.hpp"

namespace tandem::tools::program_run {
namespace {

using rhi::ShaderStage;

class Loader {
 public:
  explicit Loader(const RunOptions& options) : options_(options) {}

  LoadedProgram load() {
    for (const Launch& launch : options_.launches) load_files(launch);
    for (const Launch& launch : options_.launches) add_launch(launch);
    return std::move(result_);
  }

 private:
  std::vector<std::filesystem::path> group_files(const Setting& group) const {
    std::vector<std::filesystem::path> files;
    std::string_view rest = group.value;
    while (!rest.empty()) {
      const std::size_t end = rest.find(',');
      files.emplace_back(rest.substr(0, end));
      rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
    }
    return files;
  }

  void load_files(const Launch& launch) {
    std::vector<std::filesystem::path> files = launch.shaders;
    for (const Setting& group : launch.hit_groups)
      for (const std::filesystem::path& file : group_files(group)) files.push_back(file);
    for (const std::filesystem::path& file : files) {
      if (positions_.contains({file, launch.entry_point})) continue;
      positions_[{file, launch.entry_point}] = result_.shaders.size();
      result_.shaders.push_back(program::load_shader(file,
                                                     {.defines = options_.defines,
                                                      .include_directories = options_.include_directories,
                                                      .debug_info = options_.debug_info},
                                                     launch.entry_point));
      result_.interfaces.push_back(program::interface_of(result_.shaders.back()));
    }
  }

  LaunchShader shader_of(const Launch& launch, const std::filesystem::path& file) const {
    const std::size_t index = positions_.at({file, launch.entry_point});
    return {.index = index, .stage = result_.interfaces[index].reflection.stage};
  }

  void add_launch(const Launch& launch) {
    LoadedLaunch loaded;
    for (const std::filesystem::path& file : launch.shaders) loaded.shaders.push_back(shader_of(launch, file));
    std::vector<LaunchShader> all = loaded.shaders;
    for (const Setting& group : launch.hit_groups) {
      loaded.hit_groups.emplace_back();
      for (const std::filesystem::path& file : group_files(group)) {
        loaded.hit_groups.back().push_back(shader_of(launch, file));
        all.push_back(loaded.hit_groups.back().back());
      }
    }
    for (const LaunchShader& shader : all) {
      const program::ShaderInterface& interface = result_.interfaces[shader.index];
      for (const rhi::ShaderBinding& binding : interface.reflection.bindings) add_binding(loaded, interface, binding);
      if (interface.push_constants &&
          (!loaded.push_constants || interface.push_constants->size > loaded.push_constants->size))
        loaded.push_constants = interface.push_constants;
    }
    std::ranges::sort(loaded.bindings, {},
                      [](const NeededBinding& each) { return std::tuple(each.binding.set, each.binding.binding); });
    result_.launches.push_back(std::move(loaded));
  }

  void add_binding(LoadedLaunch& launch, const program::ShaderInterface& interface, const rhi::ShaderBinding& binding) {
    auto known = std::ranges::find_if(launch.bindings, [&](const NeededBinding& each) {
      return each.binding.set == binding.set && each.binding.binding == binding.binding;
    });
    if (known == launch.bindings.end()) {
      launch.bindings.push_back({.binding = binding, .names = {}});
      known = launch.bindings.end() - 1;
    }
    known->binding.writable = known->binding.writable || binding.writable;
    if (!known->binding.format) known->binding.format = binding.format;
    add_name(*known, binding.name);
    for (const program::BlockLayout& block : interface.blocks) {
      if (block.set != binding.set || block.binding != binding.binding) continue;
      if (known->block == nullptr) known->block = &block;
      add_name(*known, block.block);
      add_name(*known, block.instance);
      if (block.type.members.size() == 1) add_name(*known, block.type.members[0].name);
    }
  }

  static void add_name(NeededBinding& binding, const std::string& name) {
    if (!name.empty() && std::ranges::count(binding.names, name) == 0) binding.names.push_back(name);
  }

  const RunOptions& options_;
  LoadedProgram result_;
  std::map<std::pair<std::filesystem::path, std::string>, std::size_t> positions_;
};

std::optional<std::uint32_t> whole_number(std::string_view text) {
  std::uint32_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc{} && end == text.data() + text.size() ? std::optional(value) : std::nullopt;
}

}  // namespace

std::string NeededBinding::key() const {
  return binding.name.empty() || binding.name.starts_with('_') ? fmt::format("{}:{}", binding.set, binding.binding)
                                                               : binding.name;
}

std::string NeededBinding::text() const {
  return fmt::format("{}:{}{}", binding.set, binding.binding,
                     binding.name.empty() ? "" : fmt::format(" ({})", shortened(binding.name)));
}

LoadedProgram load_program(const RunOptions& options) { return Loader(options).load(); }

std::optional<KeyMatch> match(std::string_view key, const NeededBinding& binding) {
  KeyMatch result;
  if (const std::size_t bracket = key.find('['); bracket != std::string_view::npos && key.ends_with(']')) {
    result.element = whole_number(key.substr(bracket + 1, key.size() - bracket - 2));
    if (!result.element) return std::nullopt;
    key = key.substr(0, bracket);
  }
  if (const std::size_t colon = key.find(':'); colon != std::string_view::npos) {
    if (whole_number(key.substr(0, colon)) == binding.binding.set &&
        whole_number(key.substr(colon + 1)) == binding.binding.binding)
      return result;
    return std::nullopt;
  }
  return std::ranges::count(binding.names, key) != 0 ? std::optional(result) : std::nullopt;
}

}  // namespace tandem::tools::program_run
