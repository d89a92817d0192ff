#include "tools/program/pipeline_builder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <optional>
#include <set>
#include <utility>

#include "base/error.hpp"
#include "base/printable.hpp"
#include "program/data/fill.hpp"
#include "program/data/scalar.hpp"
#include "program/data/table.hpp"
#include "tools/program/resource_words.hpp"

namespace tandem::tools::program_run {
namespace {

using program::Stage;
using rhi::ShaderStage;

/// What fill() throws, with the setting in front.
template <typename Fill>
void fill(const Setting& setting, const Fill& fill_bytes) {
  try {
    fill_bytes();
  } catch (const Error& error) {
    refuse(setting, error.what());
  }
}

class PipelineBuilder {
 public:
  PipelineBuilder(const LoadedProgram& program, const LoadedLaunch& loaded, const Launch& launch)
      : program_(program), loaded_(loaded), launch_(launch) {}

  LaunchPipeline make(std::size_t number) {
    if (loaded_.shaders.empty()) throw Error("no shader is given");
    if (loaded_.is_ray_tracing())
      make_ray_tracing();
    else
      make_compute();
    result_.pipeline.name = program_.shaders[loaded_.shaders.front().index].name;
    if (number > 0) result_.pipeline.name += fmt::format(", launch {}", number + 1);
    result_.pipeline.push_constants = push_constants();
    for (const Setting& setting : launch_.specialization)
      if (!used_.contains(&setting))
        refuse(setting, fmt::format("no shader has a specialisation constant '{}'", shortened(setting.key)));
    for (const Setting& setting : launch_.records)
      if (!used_.contains(&setting))
        refuse(setting, fmt::format("'{}' is no record; records are rgen, miss:0, hit:0 and callable:0, and so on",
                                    shortened(setting.key)));
    return std::move(result_);
  }

 private:
  const program::ShaderInterface& interface_of(const LaunchShader& shader) const {
    return program_.interfaces[shader.index];
  }

  Stage stage_of(const LaunchShader& shader) {
    Stage stage{.shader = shader.index};
    for (const Setting& setting : launch_.specialization)
      for (const program::ConstantLayout& constant : interface_of(shader).constants) {
        if (setting.key != constant.name && setting.key != std::to_string(constant.id)) continue;
        used_.insert(&setting);
        std::string text = setting.value;
        if (constant.is_bool && (text == "true" || text == "false")) text = text == "true" ? "1" : "0";
        fill(setting, [&] {
          stage.specialization.push_back({.id = constant.id, .value = program::from_text(constant.type, text)});
        });
      }
    return stage;
  }

  std::vector<LaunchShader> of_stage(ShaderStage stage) const {
    std::vector<LaunchShader> shaders;
    for (const LaunchShader& each : loaded_.shaders)
      if (each.stage == stage) shaders.push_back(each);
    return shaders;
  }

  const std::string& name_of(const LaunchShader& shader) const { return program_.shaders[shader.index].name; }

  void make_compute() {
    if (loaded_.shaders.size() != 1 || !loaded_.hit_groups.empty())
      throw Error(fmt::format("{} is a compute shader, which runs alone", shortened(name_of(loaded_.shaders.front()))));
    program::ComputeStages stages{.shader = stage_of(loaded_.shaders[0])};
    program::Dispatch dispatch;
    if (launch_.groups) {
      dispatch.workgroup_count = three_sizes(*launch_.groups);
    } else {
      const std::array<std::uint32_t, 3> size = three_sizes(*launch_.size), group = workgroup_size(stages.shader);
      for (std::size_t i = 0; i < 3; ++i)
        dispatch.workgroup_count[i] =
            size[i] / std::max(group[i], 1u) + (size[i] % std::max(group[i], 1u) != 0 ? 1 : 0);
    }
    result_.pipeline.stages = std::move(stages);
    result_.command = dispatch;
  }

  std::array<std::uint32_t, 3> workgroup_size(const Stage& stage) const {
    const rhi::ShaderReflection& reflection = program_.interfaces[stage.shader].reflection;
    std::array<std::uint32_t, 3> size = reflection.workgroup_size;
    for (std::size_t i = 0; i < 3; ++i)
      for (const rhi::SpecializationValue& value : stage.specialization)
        if (reflection.workgroup_size_constant[i] == value.id) size[i] = static_cast<std::uint32_t>(value.value);
    return size;
  }

  /// The hit groups of --hit, or what the hit shaders that are there make.
  std::vector<std::vector<LaunchShader>> hit_groups() const {
    if (!loaded_.hit_groups.empty()) return loaded_.hit_groups;
    std::vector<LaunchShader> triangles, boxes;
    for (const ShaderStage stage : {ShaderStage::closest_hit, ShaderStage::any_hit, ShaderStage::intersection}) {
      const std::vector<LaunchShader> shaders = of_stage(stage);
      if (shaders.size() > 1)
        throw Error(fmt::format("{} and {} are of one stage; say with --hit which shaders are a group",
                                shortened(name_of(shaders[0])), shortened(name_of(shaders[1]))));
      if (shaders.empty()) continue;
      boxes.push_back(shaders[0]);
      if (stage != ShaderStage::intersection) triangles.push_back(shaders[0]);
    }
    if (boxes.empty()) return {};
    if (boxes.size() == triangles.size()) return {triangles};
    return {triangles, boxes};
  }

  program::HitGroup group_of(const std::vector<LaunchShader>& shaders) {
    program::HitGroup group;
    for (const LaunchShader& shader : shaders) {
      std::optional<Stage>* const place = shader.stage == ShaderStage::closest_hit    ? &group.closest_hit
                                          : shader.stage == ShaderStage::any_hit      ? &group.any_hit
                                          : shader.stage == ShaderStage::intersection ? &group.intersection
                                                                                      : nullptr;
      if (place == nullptr || *place)
        throw Error(fmt::format("--hit: {} {}", shortened(name_of(shader)),
                                place == nullptr ? "is no hit shader" : "is the second of its stage in a group"));
      *place = stage_of(shader);
    }
    return group;
  }

  void make_ray_tracing() {
    const std::vector<LaunchShader> generation = of_stage(ShaderStage::ray_generation);
    if (generation.size() != 1)
      throw Error(fmt::format("{} ray generation shaders are given, where one is run", generation.size()));
    if (!of_stage(ShaderStage::compute).empty())
      throw Error(fmt::format("{} is a compute shader, which runs alone",
                              shortened(name_of(of_stage(ShaderStage::compute)[0]))));
    if (!launch_.size) refuse(*launch_.groups, "a ray generation shader has no workgroups; say --size");
    program::RayTracingStages stages{.ray_generation = {stage_of(generation[0])}};
    program::TraceRays trace;
    trace.size = three_sizes(*launch_.size);
    trace.ray_generation.data = record_of("rgen", generation);
    for (const LaunchShader& shader : of_stage(ShaderStage::miss)) {
      trace.miss.push_back(record("miss", stages.miss.size(), {shader}));
      stages.miss.push_back(stage_of(shader));
    }
    for (const std::vector<LaunchShader>& group : hit_groups()) {
      const auto number = static_cast<std::uint32_t>(stages.hit_groups.size());
      trace.hit.push_back(record("hit", number, group));
      stages.hit_groups.push_back(group_of(group));
      result_.has_any_hit = result_.has_any_hit || stages.hit_groups.back().any_hit.has_value();
      if (result_.box_record == 0 && stages.hit_groups.back().intersection) result_.box_record = number;
    }
    for (const LaunchShader& shader : of_stage(ShaderStage::callable)) {
      trace.callable.push_back(record("callable", stages.callable.size(), {shader}));
      stages.callable.push_back(stage_of(shader));
    }
    stages.max_recursion_depth = recursion_depth(stages);
    result_.pipeline.stages = std::move(stages);
    result_.command = std::move(trace);
  }

  /// More than one only where a hit or miss shader traces: devices reserve memory for it.
  std::uint32_t recursion_depth(const program::RayTracingStages& stages) const {
    const auto traces = [&](std::size_t shader) {
      const std::vector<std::uint32_t>& words = program_.shaders[shader].spirv;
      for (std::size_t i = 5; i < words.size() && (words[i] >> 16) != 0; i += words[i] >> 16)
        if ((words[i] & 0xffff) == trace_ray_instruction) return true;
      return false;
    };
    for (const program::HitGroup& group : stages.hit_groups)
      if (group.closest_hit && traces(group.closest_hit->shader)) return launch_.max_recursion_depth;
    for (const Stage& miss : stages.miss)
      if (traces(miss.shader)) return launch_.max_recursion_depth;
    return 1;
  }

  program::Record record(const char* kind, std::size_t number, const std::vector<LaunchShader>& shaders) {
    return {.shader = static_cast<std::uint32_t>(number),
            .data = record_of(fmt::format("{}:{}", kind, number), shaders)};
  }

  /// The shader record of that name, typed by the first of the shaders that has one; zeros where it is not given.
  std::vector<std::byte> record_of(const std::string& name, const std::vector<LaunchShader>& shaders) {
    const program::ValueType* type = nullptr;
    for (const LaunchShader& shader : shaders)
      if (type == nullptr && interface_of(shader).shader_record) type = &*interface_of(shader).shader_record;
    if (type == nullptr) return {};
    std::vector<std::byte> bytes(static_cast<std::size_t>(type->size));
    for (const Setting& setting : launch_.records) {
      if (setting.key != name) continue;
      used_.insert(&setting);
      fill(setting, [&] { program::fill_values(bytes, *type, program::value_words(setting.value)); });
    }
    return bytes;
  }

  std::vector<std::byte> push_constants() const {
    if (!loaded_.push_constants) {
      if (!launch_.push.empty()) refuse(launch_.push.front(), "no shader has push constants");
      return {};
    }
    const program::ValueType& type = *loaded_.push_constants;
    std::vector<std::byte> bytes(static_cast<std::size_t>(type.size));
    for (const Setting& setting : launch_.push)
      fill(setting, [&] {
        const std::vector<std::string> values = program::value_words(setting.value);
        if (setting.key.empty())
          program::fill_values(bytes, type, values);
        else
          program::fill_part(bytes, type, setting.key, values);
      });
    return bytes;
  }

  static constexpr std::uint32_t trace_ray_instruction = 4445;  // OpTraceRayKHR

  const LoadedProgram& program_;
  const LoadedLaunch& loaded_;
  const Launch& launch_;
  LaunchPipeline result_;
  std::set<const Setting*> used_;
};

}  // namespace

LaunchPipeline make_pipeline(const LoadedProgram& program, const LoadedLaunch& loaded, const Launch& launch,
                             std::size_t number) {
  return PipelineBuilder(program, loaded, launch).make(number);
}

void set_pipeline(program::Command& command, std::size_t position) {
  if (auto* const dispatch = std::get_if<program::Dispatch>(&command)) dispatch->pipeline = position;
  if (auto* const trace = std::get_if<program::TraceRays>(&command)) trace->pipeline = position;
}

}  // namespace tandem::tools::program_run
