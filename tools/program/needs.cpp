#include "tools/program/needs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "program/data/fill.hpp"
#include "program/data/scalar.hpp"
#include "tools/options/shipped_file.hpp"

namespace tandem::tools::program_run {
namespace {

using program::ValueType;
using rhi::BindingKind;
using rhi::ShaderStage;

const char* name_of(ShaderStage stage) {
  constexpr const char* names[] = {"compute", "ray generation", "any hit", "closest hit",
                                   "miss",    "intersection",   "callable"};
  return names[static_cast<std::size_t>(stage)];
}

const char* name_of(BindingKind kind) {
  constexpr const char* names[] = {"uniform buffer",    "storage buffer",       "acceleration structure",
                                   "storage image",     "sampled image",        "sampler",
                                   "image and sampler", "uniform texel buffer", "storage texel buffer"};
  return names[static_cast<std::size_t>(kind)];
}

bool is_buffer(BindingKind kind) {
  return kind == BindingKind::uniform_buffer || kind == BindingKind::storage_buffer ||
         kind == BindingKind::uniform_texel_buffer || kind == BindingKind::storage_texel_buffer;
}

bool is_image(BindingKind kind) {
  return kind == BindingKind::storage_image || kind == BindingKind::sampled_image ||
         kind == BindingKind::combined_image_sampler;
}

/// A size that images of the kind are often given.
const char* usual_size(rhi::TextureDimension dimension) {
  switch (dimension) {
    case rhi::TextureDimension::d1:
      return "512";
    case rhi::TextureDimension::d3:
      return "64x64x64";
    case rhi::TextureDimension::cube:
      return "64x64";
    case rhi::TextureDimension::d1_array:
      return "512x4";
    case rhi::TextureDimension::d2_array:
      return "512x512x4";
    case rhi::TextureDimension::cube_array:
      return "64x64x12";
    default:
      return "512x512";
  }
}

std::string image_value(const rhi::ShaderBinding& binding) {
  const std::string size = usual_size(binding.dimension);
  return binding.format ? fmt::format("{}:{}", rhi::info_of(*binding.format).name, size) : size;
}

MissingOption missing(const char* option, const std::string& key, const std::string& value) {
  return {.what = key.empty() ? std::string(option) : fmt::format("{} {}", option, key),
          .option = fmt::format("{} {}{}{}", option, key, key.empty() || value.empty() ? "" : "=", value)};
}

std::optional<MissingOption> missing_of(const NeededBinding& needed) {
  const rhi::ShaderBinding& binding = needed.binding;
  if (binding.kind == BindingKind::acceleration_structure)
    return missing("--scene", "", shipped_scene("cornell_box.obj").string());
  if (is_image(binding.kind)) return missing("--image", needed.key(), image_value(binding));
  if (!is_buffer(binding.kind)) return std::nullopt;  // a sampler has a default
  const bool is_open = needed.block == nullptr || program::unsized_array(needed.block->type) != nullptr;
  return missing("--buffer", needed.key(), is_open ? "zeros:1024" : "zeros");
}

/// The elements that have to be given, of an array of descriptors without a length the first.
std::uint32_t element_count(const rhi::ShaderBinding& binding) { return std::max(binding.count, 1u); }

bool is_given(const Launch& launch, const std::vector<Setting>& resources, const NeededBinding& needed) {
  std::set<std::uint32_t> elements;
  for (const Setting& resource : resources)
    if (const std::optional<KeyMatch> found = binds(launch, resource, needed)) {
      if (!found->element) return true;
      elements.insert(*found->element);
    }
  return elements.size() >= element_count(needed.binding);
}

bool is_given(const RunOptions& options, const Launch& launch, const NeededBinding& needed) {
  const BindingKind kind = needed.binding.kind;
  if (kind == BindingKind::acceleration_structure)
    return std::ranges::any_of(options.scenes, [&](const Setting& scene) {
      return scene.key.empty() || binds(launch, scene, needed).has_value();
    });
  if (kind == BindingKind::sampler) return true;
  return is_given(launch, is_image(kind) ? options.images : options.buffers, needed);
}

void append_members(const ValueType& type, std::uint64_t offset, const std::string& path, std::string& text) {
  for (const program::Member& member : type.members) {
    const std::string name = path + member.name;
    const ValueType* inner = &member.type;
    while (inner->kind == ValueType::Kind::array) inner = &inner->element.front();
    const std::string stride =
        member.type.kind == ValueType::Kind::array ? fmt::format(", {} bytes apart", member.type.stride) : "";
    text += fmt::format("      byte {:<4}  {:<16}  {}{}\n", offset + member.offset, program::describe(member.type),
                        name, stride);
    if (inner->kind == ValueType::Kind::structure)
      append_members(*inner, offset + member.offset, name + (inner == &member.type ? "." : "[0]."), text);
  }
}

std::string binding_text(const NeededBinding& needed) {
  const rhi::ShaderBinding& binding = needed.binding;
  std::string text = fmt::format("  {}:{}  {}{}", binding.set, binding.binding, name_of(binding.kind),
                                 binding.writable ? ", written" : "");
  if (binding.count != 1) text += binding.count == 0 ? ", an array" : fmt::format(", {} of them", binding.count);
  if (binding.format) text += fmt::format(", {}", rhi::info_of(*binding.format).name);
  std::string names;
  for (const std::string& name : needed.names) names += (names.empty() ? "  " : " or ") + name;
  text += names + "\n";
  if (needed.block != nullptr) append_members(needed.block->type, 0, "", text);
  return text;
}

std::string constants_text(const LoadedProgram& program, const LoadedLaunch& launch) {
  // The size of a workgroup is a second constant of its id, which has no name.
  std::map<std::uint32_t, const program::ConstantLayout*> constants;
  const auto add = [&](const LaunchShader& shader) {
    for (const program::ConstantLayout& each : program.interfaces[shader.index].constants)
      if (const program::ConstantLayout*& known = constants[each.id]; known == nullptr || known->name.empty())
        known = &each;
  };
  for (const LaunchShader& shader : launch.shaders) add(shader);
  for (const auto& group : launch.hit_groups)
    for (const LaunchShader& shader : group) add(shader);
  std::string text = constants.empty() ? "" : "  specialisation constants\n";
  for (const auto& [id, constant] : constants) {
    const std::string type = constant->is_bool ? "bool" : program::describe(program::make_type(constant->type));
    const std::string value = constant->is_bool ? (constant->default_value != 0 ? "true" : "false")
                                                : program::to_text(constant->type, constant->default_value);
    text += fmt::format("      id {:<4}    {:<16}  {}, {} by default\n", id, type,
                        constant->name.empty() ? "without a name" : constant->name, value);
  }
  return text;
}

std::string quoted(const std::string& word) {
  const bool is_plain = word.find_first_of(" []()*?$&;<>|\"'\\`!#") == std::string::npos && !word.empty();
  return is_plain ? word : "'" + word + "'";
}

std::string setting_words(const char* option, const std::vector<Setting>& settings) {
  std::string text;
  for (const Setting& setting : settings)
    text +=
        fmt::format(" {} {}", option, quoted(setting.key.empty() ? setting.value : setting.key + "=" + setting.value));
  return text;
}

}  // namespace

std::optional<KeyMatch> binds(const Launch& launch, const Setting& resource, const NeededBinding& binding) {
  bool is_bound_by_name = false;
  for (const Setting& bind : launch.bind) {
    const std::optional<KeyMatch> found = match(bind.key, binding);
    if (!found) continue;
    if (bind.value == resource.key) return found;
    is_bound_by_name = true;  // to another resource
  }
  return is_bound_by_name ? std::nullopt : match(resource.key, binding);
}

std::vector<MissingOption> missing_options(const LoadedProgram& program, const RunOptions& options) {
  std::vector<MissingOption> result;
  for (std::size_t i = 0; i < program.launches.size(); ++i) {
    const LoadedLaunch& loaded = program.launches[i];
    const Launch& launch = options.launches[i];
    for (const NeededBinding& needed : loaded.bindings) {
      if (is_given(options, launch, needed)) continue;
      const std::optional<MissingOption> option = missing_of(needed);
      const auto is_same = [&](const MissingOption& each) { return each.option == option->option; };
      if (option && std::ranges::none_of(result, is_same)) result.push_back(*option);
    }
    if (loaded.push_constants && launch.push.empty()) {
      for (const program::Member& member : loaded.push_constants->members) {
        std::string zeros = "0";
        for (std::uint64_t n = program::scalar_count(member.type, member.type.size); n > 1; --n) zeros += ",0";
        result.push_back(missing("--push", member.name, zeros));
      }
    }
    if (!launch.groups && !launch.size)
      result.push_back(loaded.is_ray_tracing() ? missing("--size", "", "512x512") : missing("--groups", "", "16"));
  }
  return result;
}

std::string needs_text(const LoadedProgram& program) {
  std::string text;
  for (const LoadedLaunch& launch : program.launches) {
    const auto add = [&](const LaunchShader& shader) {
      const rhi::ShaderReflection& reflection = program.interfaces[shader.index].reflection;
      text += fmt::format("{}: {}", program.shaders[shader.index].name, name_of(shader.stage));
      if (shader.stage == ShaderStage::compute)
        text += fmt::format(", workgroups of {}x{}x{}", reflection.workgroup_size[0], reflection.workgroup_size[1],
                            reflection.workgroup_size[2]);
      text += "\n";
    };
    for (const LaunchShader& shader : launch.shaders) add(shader);
    for (const auto& group : launch.hit_groups)
      for (const LaunchShader& shader : group) add(shader);
    for (const NeededBinding& needed : launch.bindings) text += binding_text(needed);
    if (launch.push_constants) {
      text += fmt::format("  push constants, {} bytes\n", launch.push_constants->size);
      append_members(*launch.push_constants, 0, "", text);
    }
    for (const LaunchShader& shader : launch.shaders)
      if (const auto& record = program.interfaces[shader.index].shader_record) {
        text += fmt::format("  shader record of {}, {} bytes\n", program.shaders[shader.index].name, record->size);
        append_members(*record, 0, "", text);
      }
    text += constants_text(program, launch);
  }
  return text;
}

std::string proposed_command(const RunOptions& options, const std::vector<MissingOption>& missing) {
  const Launch& launch = options.launches.front();
  std::string text = "tandem run";
  for (const std::filesystem::path& shader : launch.shaders) text += " " + quoted(shader.string());
  text += setting_words("--hit", launch.hit_groups);
  for (const glsl::Define& define : options.defines)
    text += " " + quoted(fmt::format("-D{}{}{}", define.name, define.value.empty() ? "" : "=", define.value));
  for (const std::filesystem::path& folder : options.include_directories) text += " -I " + quoted(folder.string());
  if (!launch.entry_point.empty()) text += " --entry " + quoted(launch.entry_point);
  text += setting_words("--spec", launch.specialization) + setting_words("--buffer", options.buffers) +
          setting_words("--image", options.images) + setting_words("--sampler", options.samplers) +
          setting_words("--scene", options.scenes) + setting_words("--push", launch.push) +
          setting_words("--record", launch.records);
  if (launch.groups) text += " --groups " + launch.groups->value;
  if (launch.size) text += " --size " + launch.size->value;
  for (const MissingOption& each : missing) text += " " + each.option;
  return text;
}

}  // namespace tandem::tools::program_run
