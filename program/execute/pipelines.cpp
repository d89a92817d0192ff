#include "program/execute/pipelines.hpp"

#include <algorithm>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "program/execute/position.hpp"
#include "program/execute/specialization.hpp"
#include "program/print/print_code.hpp"

namespace tandem::program {
namespace {

using rhi::BindingKind;

rhi::ShaderModuleHandle make_module(rhi::Device& device, const Shader& shader) {
  const std::vector<std::uint32_t> words = without_prints(shader.spirv, shader.name);
  return device.create_shader_module({.spirv = words, .label = shader.name, .entry_point = shader.entry_point});
}

/// The modules of ray tracing stages, which have their constants' values in them: a pipeline of the rhi gives a value
/// to all of its shaders.
class StageModules {
 public:
  StageModules(rhi::Device& device, const Job& job, std::string label)
      : device_(device), job_(job), label_(std::move(label)), plain_(job.shaders.size()) {}

  rhi::ShaderModuleHandle module_of(const Stage& stage) {
    const Shader& shader = at_position(job_.shaders, stage.shader, label_, "shader");
    rhi::ShaderModuleHandle& plain = plain_[stage.shader];
    if (plain == nullptr) plain = make_module(device_, shader);
    if (stage.specialization.empty()) return plain;
    const std::vector<std::uint32_t> words = specialized(*plain, stage.specialization);
    return device_.create_shader_module({.spirv = words, .label = shader.name});
  }

  rhi::ShaderModuleHandle module_of(const std::optional<Stage>& stage) { return stage ? module_of(*stage) : nullptr; }

  std::vector<rhi::ShaderModuleHandle> modules_of(const std::vector<Stage>& stages) {
    std::vector<rhi::ShaderModuleHandle> modules;
    for (const Stage& stage : stages) modules.push_back(module_of(stage));
    return modules;
  }

 private:
  rhi::Device& device_;
  const Job& job_;
  std::string label_;
  std::vector<rhi::ShaderModuleHandle> plain_;  ///< by shader, once it is used
};

rhi::ComputePipelineHandle make_compute(rhi::Device& device, const Job& job, const std::string& label,
                                        const ComputeStages& stages) {
  return device.create_compute_pipeline(
      {.shader = make_module(device, at_position(job.shaders, stages.shader.shader, label, "shader")),
       .specialization = stages.shader.specialization,
       .required_subgroup_size = stages.required_subgroup_size,
       .full_subgroups = stages.full_subgroups,
       .label = label});
}

rhi::RayTracingPipelineHandle make_ray_tracing(rhi::Device& device, const Job& job, const std::string& label,
                                               const RayTracingStages& stages) {
  StageModules modules(device, job, label);
  rhi::RayTracingPipelineDesc desc{.ray_generation = modules.modules_of(stages.ray_generation),
                                   .miss = modules.modules_of(stages.miss),
                                   .hit_groups = {},
                                   .callable = modules.modules_of(stages.callable),
                                   .max_recursion_depth = stages.max_recursion_depth,
                                   .specialization = {},
                                   .label = label};
  for (const HitGroup& group : stages.hit_groups)
    desc.hit_groups.push_back({.closest_hit = modules.module_of(group.closest_hit),
                               .any_hit = modules.module_of(group.any_hit),
                               .intersection = modules.module_of(group.intersection)});
  return device.create_ray_tracing_pipeline(desc);
}

/// Makes what a descriptor of the rhi holds of what the job says.
class Binder {
 public:
  Binder(const Resources& resources, const rhi::Limits& limits, std::string label)
      : resources_(resources), limits_(limits), label_(std::move(label)) {}

  rhi::BoundResource bound(const Binding& binding, const rhi::ShaderBinding& wanted) const {
    return std::visit([&](const auto& use) { return bound(use, wanted); }, binding.resource);
  }

 private:
  rhi::BoundResource bound(const BufferUse& use, const rhi::ShaderBinding& wanted) const {
    rhi::BufferRange range{at_position(resources_.buffers, use.buffer, label_, "buffer"), use.offset, use.size};
    // A block has a fixed size, which a device takes; the buffer around it may be larger than that.
    if (wanted.kind == BindingKind::uniform_buffer && range.offset < range.buffer->size())
      range.size = std::min(range.resolved_size(), limits_.max_uniform_buffer_range);
    return range;
  }

  rhi::BoundResource bound(const TexelBufferUse& use, const rhi::ShaderBinding&) const {
    return rhi::TexelBuffer{.range = {at_position(resources_.buffers, use.buffer, label_, "buffer")},
                            .format = use.format};
  }

  rhi::BoundResource bound(const ImageUse& use, const rhi::ShaderBinding& wanted) const {
    rhi::TextureView view{.texture = at_position(resources_.images, use.image, label_, "image"),
                          .first_level = use.first_level,
                          .level_count = use.level_count,
                          .dimension = use.dimension};
    if (!use.sampler || wanted.kind != BindingKind::combined_image_sampler) return view;
    return rhi::SampledTexture{.view = view, .sampler = sampler(*use.sampler)};
  }

  rhi::BoundResource bound(const SamplerUse& use, const rhi::ShaderBinding&) const { return sampler(use.sampler); }

  rhi::BoundResource bound(const TopLevelUse& use, const rhi::ShaderBinding&) const {
    return at_position(resources_.top_levels, use.top_level, label_, "top level");
  }

  rhi::SamplerHandle sampler(std::size_t position) const {
    return at_position(resources_.samplers, position, label_, "sampler");
  }

  const Resources& resources_;
  const rhi::Limits& limits_;
  std::string label_;
};

std::vector<rhi::BindGroupHandle> make_bind_groups(rhi::Device& device, const Resources& resources,
                                                   const Pipeline& pipeline, const rhi::PipelineHandle& handle) {
  const std::vector<rhi::ShaderBinding>& wanted = handle->interface().bindings;
  std::set<std::uint32_t> sets;
  for (const rhi::ShaderBinding& each : wanted) sets.insert(each.set);
  const Binder binder(resources, device.info().limits, pipeline.name);
  std::vector<rhi::BindGroupHandle> groups;
  for (const std::uint32_t set : sets) {
    rhi::BindGroupDesc desc{.pipeline = handle, .set = set, .entries = {}, .label = pipeline.name};
    for (const Binding& binding : pipeline.bindings) {
      const auto declared = std::ranges::find_if(wanted, [&](const rhi::ShaderBinding& each) {
        return each.set == set && binding.set == set && each.binding == binding.binding;
      });
      if (declared == wanted.end()) continue;
      desc.entries.push_back({.binding = binding.binding,
                              .resource = binder.bound(binding, *declared),
                              .array_element = binding.array_element});
    }
    groups.push_back(device.create_bind_group(desc));
  }
  return groups;
}

}  // namespace

std::vector<BoundPipeline> make_pipelines(rhi::Device& device, const Job& job, const Resources& resources) {
  std::vector<BoundPipeline> pipelines;
  for (const Pipeline& pipeline : job.pipelines) {
    BoundPipeline bound;
    rhi::PipelineHandle handle;
    if (const auto* stages = std::get_if<ComputeStages>(&pipeline.stages))
      handle = bound.compute = make_compute(device, job, pipeline.name, *stages);
    else
      handle = bound.ray_tracing =
          make_ray_tracing(device, job, pipeline.name, std::get<RayTracingStages>(pipeline.stages));
    bound.bind_groups = make_bind_groups(device, resources, pipeline, handle);
    bound.push_constants = pipeline.push_constants;
    bound.push_constants.resize(handle->interface().push_constant_size);
    pipelines.push_back(std::move(bound));
  }
  return pipelines;
}

void bind_again(rhi::Device& device, const Job& job, const Resources& resources,
                std::vector<BoundPipeline>& pipelines) {
  for (std::size_t i = 0; i < pipelines.size(); ++i) {
    BoundPipeline& bound = pipelines[i];
    const rhi::PipelineHandle handle =
        bound.compute != nullptr ? rhi::PipelineHandle(bound.compute) : rhi::PipelineHandle(bound.ray_tracing);
    bound.bind_groups = make_bind_groups(device, resources, job.pipelines[i], handle);
  }
}

}  // namespace tandem::program
