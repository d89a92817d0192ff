#include "pathtracer/render/path_trace_program.hpp"

#include <array>
#include <cstddef>
#include <span>

#include "metropolis_shaders/spirv.hpp"
#include "shaders/spirv.hpp"

namespace tandem::pathtracer {
namespace {

/// What differs between the tasks: the shader that each begins with.
struct EntryPoint {
  std::span<const std::uint32_t> spirv;
  const char* label;
};

EntryPoint compute_shader(PathTraceTask task) {
  switch (task) {
    case PathTraceTask::log:
      return {shaders::path_log(), "path_log.comp"};
    case PathTraceTask::answer:
      return {shaders::ray_answer(), "ray_answer.comp"};
    case PathTraceTask::first_hit:
      return {shaders::first_hit(), "first_hit.comp"};
    case PathTraceTask::metropolis:
      return {metropolis_shaders::metropolis(), "metropolis.comp"};
    default:
      return {shaders::path_trace(), "path_trace.comp"};
  }
}

EntryPoint ray_generation_shader(PathTraceTask task) {
  switch (task) {
    case PathTraceTask::log:
      return {shaders::path_log_rgen(), "path_log.rgen"};
    case PathTraceTask::answer:
      return {shaders::ray_answer_rgen(), "ray_answer.rgen"};
    case PathTraceTask::first_hit:
      return {shaders::first_hit_rgen(), "first_hit.rgen"};
    case PathTraceTask::metropolis:
      return {metropolis_shaders::metropolis_rgen(), "metropolis.rgen"};
    default:
      return {shaders::path_trace_rgen(), "path_trace.rgen"};
  }
}

rhi::ComputePipelineHandle compute_pipeline(rhi::Device& device, const EntryPoint& shader, Features features) {
  return device.create_compute_pipeline({.shader = device.create_shader_module({shader.spirv, shader.label, true}),
                                         .specialization = specialization(features),
                                         .label = "path tracer"});
}

/// One ray generation and one miss record, and one hit record for triangles and one for spheres: rays of both kinds
/// share them.
rhi::ShaderTableHandle shader_table(rhi::Device& device, PathTraceTask task, Features features) {
  const EntryPoint ray_generation = ray_generation_shader(task);
  // Recorded rays carry more.
  const bool log = task == PathTraceTask::log;
  const auto module = [&](std::span<const std::uint32_t> spirv, const char* label) {
    return device.create_shader_module({spirv, label, true});
  };
  rhi::RayTracingPipelineDesc desc;
  desc.ray_generation = {module(ray_generation.spirv, ray_generation.label)};
  desc.miss = {log ? module(shaders::path_log_rmiss(), "path_log.rmiss")
                   : module(shaders::path_trace_rmiss(), "path_trace.rmiss")};
  rhi::HitGroup group;
  group.closest_hit = log ? module(shaders::path_log_rchit(), "path_log.rchit")
                          : module(shaders::path_trace_rchit(), "path_trace.rchit");
  if ((features & feature::transparency) != 0)
    group.any_hit = log ? module(shaders::path_log_rahit(), "path_log.rahit")
                        : module(shaders::path_trace_rahit(), "path_trace.rahit");
  desc.hit_groups = {group};
  if ((features & feature::spheres) != 0)
    desc.hit_groups.push_back({.closest_hit = group.closest_hit,
                               .any_hit = {},
                               .intersection = module(shaders::path_trace_rint(), "path_trace.rint")});
  desc.specialization = specialization(features);
  desc.label = "path tracer";
  const rhi::ShaderRecords one{.records = {rhi::ShaderRecord{}}};
  rhi::ShaderRecords hit;
  for (std::uint32_t i = 0; i < desc.hit_groups.size(); ++i) hit.records.push_back({.shader = i, .data = {}});
  return device.create_shader_table({.pipeline = device.create_ray_tracing_pipeline(desc),
                                     .ray_generation = one,
                                     .miss = one,
                                     .hit = hit,
                                     .callable = {},
                                     .label = "path tracer"});
}

}  // namespace

Features task_features(Features needed, PathTraceTask task) {
  const Features features = built_features(needed);
  constexpr Features light = feature::transparency | feature::spheres | feature::cameras;
  const bool is_picture = task == PathTraceTask::picture || task == PathTraceTask::metropolis;
  if (is_picture || (features & ~light) == 0) return features;
  return feature::all;
}

PathTraceProgram::PathTraceProgram(rhi::Device& device, TracingMode form, Features features, PathTraceTask task)
    : form_(form), features_(task_features(features, task)) {
  if (form == TracingMode::query) {
    compute_ = compute_pipeline(device, compute_shader(task), features_);
    pipeline_ = compute_;
  } else {
    table_ = shader_table(device, task, features_);
    pipeline_ = table_->desc().pipeline;
  }
}

void PathTraceProgram::record(rhi::CommandList& list, const std::vector<rhi::BindGroupHandle>& bind_groups,
                              const DispatchConstants& constants) const {
  const std::span<const std::byte> push_constants = std::as_bytes(std::span(&constants, 1));
  const glm::uvec2 size = constants.tile_size;
  if (form_ == TracingMode::pipeline) {
    rhi::TraceRaysDesc desc;
    desc.table = table_;
    desc.bind_groups = bind_groups;
    desc.push_constants = push_constants;
    desc.size = {size.x, size.y, 1};
    list.trace_rays(desc);
    return;
  }
  const std::array<std::uint32_t, 3> workgroup = compute_->reflection().workgroup_size;
  list.dispatch(
      {.pipeline = compute_,
       .bind_groups = bind_groups,
       .push_constants = push_constants,
       .workgroup_count = {(size.x + workgroup[0] - 1) / workgroup[0], (size.y + workgroup[1] - 1) / workgroup[1], 1}});
}

}  // namespace tandem::pathtracer
