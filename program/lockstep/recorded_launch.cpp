#include "program/lockstep/recorded_launch.hpp"

#include <algorithm>
#include <map>
#include <unordered_map>
#include <utility>

#include "program/print/print_code.hpp"
#include "rhi/entry_point.hpp"
#include "rhi/error.hpp"

namespace tandem::program {
namespace {

/// A shader without specialisation constants.
struct FixedShader {
  std::size_t shader = 0;  ///< position in the job
  std::vector<std::uint32_t> spirv;
  rhi::ShaderReflection reflection;
};

FixedShader fixed_shader(const Job& job, const Stage& stage) {
  const Shader& shader = job.shaders.at(stage.shader);
  const std::vector<std::uint32_t> words =
      without_prints(rhi::with_one_entry_point(shader.spirv, shader.entry_point, shader.name), shader.name);
  const rhi::ShaderReflection reflection = rhi::reflect(words, shader.name);
  std::unordered_map<std::uint32_t, std::vector<std::uint32_t>> values;
  for (const rhi::SpecializationValue& value : stage.specialization) {
    const auto declared =
        std::ranges::find(reflection.specialization_constants, value.id, &rhi::SpecializationConstant::id);
    if (declared == reflection.specialization_constants.end()) continue;
    std::vector<std::uint32_t>& bits = values[value.id];
    bits = {static_cast<std::uint32_t>(value.value)};
    if (declared->width == 64) bits.push_back(static_cast<std::uint32_t>(value.value >> 32));
  }
  FixedShader fixed{
      .shader = stage.shader, .spirv = with_fixed_constants(words, values, shader.name), .reflection = {}};
  fixed.reflection = rhi::reflect(fixed.spirv, shader.name);
  return fixed;
}

/// Calls visit(stage) for each stage of the pipeline.
template <typename Stages, typename Visit>
void for_each_stage(Stages& stages, const Visit& visit) {
  for (auto& stage : stages.ray_generation) visit(stage);
  for (auto& stage : stages.miss) visit(stage);
  for (auto& group : stages.hit_groups) {
    if (group.closest_hit) visit(*group.closest_hit);
    if (group.any_hit) visit(*group.any_hit);
    if (group.intersection) visit(*group.intersection);
  }
  for (auto& stage : stages.callable) visit(stage);
}

/// The first binding of set 0 that no shader uses, and behind all that the pipeline binds.
std::uint32_t free_binding(const std::vector<FixedShader>& shaders, const Pipeline& pipeline) {
  std::uint32_t binding = 0;
  for (const FixedShader& shader : shaders)
    for (const rhi::ShaderBinding& used : shader.reflection.bindings)
      if (used.set == 0) binding = std::max(binding, used.binding + 1);
  for (const Binding& bound : pipeline.bindings)
    if (bound.set == 0) binding = std::max(binding, bound.binding + 1);
  return binding;
}

bool same_stage(const Stage& a, const Stage& b) {
  return a.shader == b.shader &&
         std::ranges::equal(a.specialization, b.specialization,
                            [](const auto& x, const auto& y) { return x.id == y.id && x.value == y.value; });
}

std::size_t pipeline_of(const Command& command) {
  if (const auto* dispatch = std::get_if<Dispatch>(&command)) return dispatch->pipeline;
  if (const auto* trace = std::get_if<TraceRays>(&command)) return trace->pipeline;
  throw rhi::Error(rhi::ErrorCode::invalid_argument, "", "only a command that runs shaders can be recorded");
}

}  // namespace

RecordedLaunch record_launch(const Job& job, const Command& command, RecordForm form, bool mirrored) {
  RecordedLaunch launch;
  Pipeline pipeline = job.pipelines.at(pipeline_of(command));
  std::vector<FixedShader> fixed;
  std::vector<std::pair<Stage, std::size_t>> known;  ///< a stage, and its place in `fixed`
  const auto fix = [&](Stage& stage) {
    auto found = std::ranges::find_if(known, [&](const auto& entry) { return same_stage(entry.first, stage); });
    if (found == known.end()) {
      fixed.push_back(fixed_shader(job, stage));
      known.emplace_back(stage, fixed.size() - 1);
      found = known.end() - 1;
    }
    stage = {.shader = found->second};
  };
  if (auto* compute = std::get_if<ComputeStages>(&pipeline.stages))
    fix(compute->shader);
  else
    for_each_stage(std::get<RayTracingStages>(pipeline.stages), fix);

  launch.job = {.buffers = job.buffers,
                .images = job.images,
                .samplers = job.samplers,
                .bottom_levels = job.bottom_levels,
                .top_levels = job.top_levels};
  const std::uint32_t binding = free_binding(fixed, pipeline);
  std::uint32_t next_segment = 1;  // 0 is what a slot holds where nothing was written
  for (const FixedShader& shader : fixed) {
    const Shader& original = job.shaders[shader.shader];
    Module module = parse_module(shader.spirv, original.name);
    Recorder recorder = instrument(
        module, {.form = form, .set = 0, .binding = binding, .first_segment = next_segment, .mirrored = mirrored},
        original.name);
    launch.job.shaders.push_back({original.name, original.stage, std::move(recorder.spirv), ""});
    for (const Segment& segment : recorder.segments)
      launch.largest_segment = std::max(launch.largest_segment, segment.words);
    const auto count = static_cast<std::uint32_t>(recorder.segments.size());
    launch.shaders.push_back(
        {original.name, original.stage, std::move(module), next_segment, std::move(recorder.segments)});
    next_segment += count;
  }

  launch.record_buffer = launch.job.buffers.size();
  launch.job.buffers.push_back({.name = "record", .initial = std::vector<std::byte>(4)});
  pipeline.bindings.push_back({.set = 0, .binding = binding, .resource = BufferUse{launch.record_buffer}});
  launch.job.pipelines.push_back(std::move(pipeline));
  Command own = command;
  if (auto* dispatch = std::get_if<Dispatch>(&own)) {
    dispatch->pipeline = 0;
    launch.workgroup_size = fixed[0].reflection.workgroup_size;
    for (std::size_t i = 0; i < 3; ++i)
      launch.size[i] =
          (dispatch->base_workgroup[i] + dispatch->workgroup_count[i]) * fixed[0].reflection.workgroup_size[i];
  } else {
    std::get<TraceRays>(own).pipeline = 0;
    launch.size = std::get<TraceRays>(own).size;
  }
  launch.job.commands = {std::move(own)};
  return launch;
}

SegmentPlace segment_at(const RecordedLaunch& launch, std::uint32_t number) {
  for (const RecordedShader& shader : launch.shaders)
    if (number >= shader.first_segment && number - shader.first_segment < shader.segments.size())
      return {&shader, &shader.segments[number - shader.first_segment]};
  return {};
}

}  // namespace tandem::program
