#include "conformance/pipeline/program.hpp"

#include <utility>

namespace tandem::conformance::pipeline {
namespace {

constexpr std::uint32_t first_texture_binding = 8;

rhi::ShaderModuleHandle make_module(Context& context, const std::string& text, rhi::ShaderStage stage,
                                    const std::string& label) {
  if (text.empty()) return nullptr;
  return context.shader(stage, "#version 460\n#extension GL_EXT_ray_tracing : require\n" + text, label);
}

rhi::ShaderRecords records_or_one_each(const rhi::ShaderRecords& records, std::size_t count) {
  return records.records.empty() ? one_record_each(count) : records;
}

}  // namespace

rhi::RayTracingPipelineHandle make_pipeline(Context& context, const PipelineText& text, const std::string& label) {
  rhi::RayTracingPipelineDesc desc;
  for (const std::string& shader : text.ray_generation)
    desc.ray_generation.push_back(
        make_module(context, shader, rhi::ShaderStage::ray_generation, label + ": ray generation"));
  for (const std::string& shader : text.miss)
    desc.miss.push_back(make_module(context, shader, rhi::ShaderStage::miss, label + ": miss"));
  for (const HitGroupText& group : text.hit_groups)
    desc.hit_groups.push_back(
        {.closest_hit = make_module(context, group.closest_hit, rhi::ShaderStage::closest_hit, label + ": closest hit"),
         .any_hit = make_module(context, group.any_hit, rhi::ShaderStage::any_hit, label + ": any hit"),
         .intersection =
             make_module(context, group.intersection, rhi::ShaderStage::intersection, label + ": intersection")});
  for (const std::string& shader : text.callable)
    desc.callable.push_back(make_module(context, shader, rhi::ShaderStage::callable, label + ": callable"));
  desc.max_recursion_depth = text.max_recursion_depth;
  desc.specialization = text.specialization;
  desc.label = label;
  return context.device().create_ray_tracing_pipeline(desc);
}

rhi::ShaderRecords one_record_each(std::size_t count) {
  rhi::ShaderRecords records;
  for (std::size_t i = 0; i < count; ++i) records.records.push_back(record_of(static_cast<std::uint32_t>(i)));
  return records;
}

rhi::ShaderTableHandle make_table(rhi::Device& device, const rhi::RayTracingPipelineHandle& pipeline,
                                  const Launch& launch) {
  const rhi::RayTracingPipelineDesc& desc = pipeline->desc();
  return device.create_shader_table(
      {.pipeline = pipeline,
       .ray_generation = records_or_one_each(launch.ray_generation, desc.ray_generation.size()),
       .miss = records_or_one_each(launch.miss, desc.miss.size()),
       .hit = records_or_one_each(launch.hit, desc.hit_groups.size()),
       .callable = records_or_one_each(launch.callable, desc.callable.size()),
       .label = pipeline->label()});
}

rhi::BindGroupHandle make_bind_group(rhi::Device& device, const rhi::PipelineHandle& pipeline, const Launch& launch) {
  rhi::BindGroupDesc desc;
  desc.pipeline = pipeline;
  desc.label = pipeline->label();
  for (const rhi::ShaderBinding& binding : pipeline->interface().bindings) {
    if (binding.binding == 0)
      desc.entries.push_back({.binding = 0, .resource = launch.scene});
    else if (binding.binding >= first_texture_binding)
      desc.entries.push_back(
          {.binding = binding.binding, .resource = launch.textures.at(binding.binding - first_texture_binding)});
    else
      desc.entries.push_back(
          {.binding = binding.binding, .resource = rhi::BufferRange{launch.buffers.at(binding.binding - 1)}});
  }
  return device.create_bind_group(desc);
}

void run(rhi::Device& device, const rhi::RayTracingPipelineHandle& pipeline, const Launch& launch) {
  rhi::TraceRaysDesc trace = launch.trace;
  trace.table = make_table(device, pipeline, launch);
  if (!pipeline->interface().bindings.empty()) trace.bind_groups = {make_bind_group(device, pipeline, launch)};
  const rhi::CommandListHandle list = device.create_command_list(pipeline->label());
  list->trace_rays(trace);
  device.submit(list)->wait();
}

}  // namespace tandem::conformance::pipeline
