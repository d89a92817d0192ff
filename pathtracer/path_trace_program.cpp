#include "pathtracer/path_trace_program.hpp"

#include <array>
#include <cstddef>
#include <span>

#include "shaders/spirv.hpp"

namespace tandem::pathtracer {
namespace {

rhi::ComputePipelineHandle compute_pipeline(rhi::Device& device, bool transparency) {
  const rhi::ShaderModuleDesc shader =
      transparency ? rhi::ShaderModuleDesc{shaders::path_trace_transparent(), "path_trace_transparent.comp"}
                   : rhi::ShaderModuleDesc{shaders::path_trace(), "path_trace.comp"};
  return device.create_compute_pipeline(
      {.shader = device.create_shader_module(shader), .specialization = {}, .label = "path tracer"});
}

/// One ray generation, one miss and one hit record: rays of both kinds share them.
rhi::ShaderTableHandle shader_table(rhi::Device& device, bool transparency) {
  const auto module = [&](std::span<const std::uint32_t> spirv, const char* label) {
    return device.create_shader_module({spirv, label});
  };
  rhi::RayTracingPipelineDesc desc;
  desc.ray_generation = {transparency ? module(shaders::path_trace_transparent_rgen(), "path_trace_transparent.rgen")
                                      : module(shaders::path_trace_rgen(), "path_trace.rgen")};
  desc.miss = {module(shaders::path_trace_rmiss(), "path_trace.rmiss")};
  rhi::HitGroup group;
  group.closest_hit = module(shaders::path_trace_rchit(), "path_trace.rchit");
  if (transparency) group.any_hit = module(shaders::path_trace_rahit(), "path_trace.rahit");
  desc.hit_groups = {group};
  desc.label = "path tracer";
  const rhi::ShaderRecords one{.records = {rhi::ShaderRecord{}}};
  return device.create_shader_table({.pipeline = device.create_ray_tracing_pipeline(desc),
                                     .ray_generation = one,
                                     .miss = one,
                                     .hit = one,
                                     .callable = {},
                                     .label = "path tracer"});
}

}  // namespace

PathTraceProgram::PathTraceProgram(rhi::Device& device, TraceForm form, bool transparency) : form_(form) {
  if (form == TraceForm::query) {
    compute_ = compute_pipeline(device, transparency);
    pipeline_ = compute_;
  } else {
    table_ = shader_table(device, transparency);
    pipeline_ = table_->desc().pipeline;
  }
}

void PathTraceProgram::record(rhi::CommandList& list, const std::vector<rhi::BindGroupHandle>& bind_groups,
                              const RenderConstants& constants) const {
  const std::span<const std::byte> push_constants = std::as_bytes(std::span(&constants, 1));
  const glm::uvec2 size = constants.tile_size;
  if (form_ == TraceForm::pipeline) {
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
