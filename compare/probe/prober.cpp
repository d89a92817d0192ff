#include "compare/probe/prober.hpp"

#include <cstring>

#include "probe_shaders/spirv.hpp"
#include "rhi/transfer.hpp"

namespace tandem::compare {
namespace {

/// Trial of shaders/probe/trial.glsl.
struct TrialConstants {
  std::uint32_t flags;
  std::uint32_t mask;
  std::uint32_t acceptance;
  std::uint32_t ray_count;
};

/// Two hit records for triangles and two for spheres, each with its number: hit_record says which an instance names.
rhi::ShaderTableHandle create_table(rhi::Device& device) {
  const auto module = [&](std::span<const std::uint32_t> spirv, const char* label) {
    return device.create_shader_module({spirv, label, true});
  };
  rhi::RayTracingPipelineDesc desc;
  desc.ray_generation = {module(probe_shaders::probe_rgen(), "probe.rgen")};
  desc.miss = {module(probe_shaders::probe_rmiss(), "probe.rmiss")};
  const rhi::HitGroup triangles = {.closest_hit = module(probe_shaders::probe_rchit(), "probe.rchit"),
                                   .any_hit = module(probe_shaders::probe_rahit(), "probe.rahit"),
                                   .intersection = {}};
  rhi::HitGroup spheres = triangles;
  spheres.intersection = module(probe_shaders::probe_rint(), "probe.rint");
  desc.hit_groups = {triangles, spheres};
  desc.label = "probe";
  rhi::ShaderRecords hit;
  for (std::uint32_t number = 0; number < 4; ++number) {
    std::vector<std::byte> data(sizeof(number));
    std::memcpy(data.data(), &number, sizeof(number));
    hit.records.push_back({.shader = number % 2, .data = std::move(data)});
  }
  const rhi::ShaderRecords one{.records = {rhi::ShaderRecord{}}};
  return device.create_shader_table({.pipeline = device.create_ray_tracing_pipeline(desc),
                                     .ray_generation = one,
                                     .miss = one,
                                     .hit = hit,
                                     .callable = {},
                                     .label = "probe"});
}

}  // namespace

Prober::Prober(rhi::Device& device, const pathtracer::Scene& scene, std::optional<pathtracer::TracingMode> form)
    : device_(device), form_(pathtracer::choose_tracing_mode(device.info(), form)), structures_(device, scene) {
  if (form_ == pathtracer::TracingMode::query) {
    compute_ = device.create_compute_pipeline(
        {.shader = device.create_shader_module({probe_shaders::probe(), "probe.comp", true}),
         .specialization = {},
         .label = "probe"});
    pipeline_ = compute_;
  } else {
    table_ = create_table(device);
    pipeline_ = table_->desc().pipeline;
  }
}

bool Prober::supports(const Trial& trial) const {
  const bool skips = (trial.flags & (ray_flag::skip_triangles | ray_flag::skip_boxes)) != 0;
  return !skips || form_ == pathtracer::TracingMode::query || device_.info().capabilities.primitive_culling;
}

std::vector<ProbeAnswer> Prober::answer(const Trial& trial, std::span<const ProbeRay> rays) {
  const auto ray_count = static_cast<std::uint32_t>(rays.size());
  const rhi::CommandListHandle list = device_.create_command_list(std::string("probe: ") + trial.name);
  const rhi::BufferHandle ray_buffer =
      rhi::create_filled(device_, *list, rays, rhi::BufferUsage::storage, "probe: rays");
  const rhi::BufferHandle answer_buffer = device_.create_buffer(
      {.size = rays.size() * sizeof(ProbeAnswer), .usage = rhi::BufferUsage::storage, .label = "probe: answers"});
  const rhi::BindGroupHandle group =
      device_.create_bind_group({.pipeline = pipeline_,
                                 .set = 0,
                                 .entries = {{.binding = 0, .resource = structures_.top_level(trial.instance_setup)},
                                             {.binding = 1, .resource = rhi::BufferRange{ray_buffer}},
                                             {.binding = 2, .resource = rhi::BufferRange{structures_.spheres()}},
                                             {.binding = 3, .resource = rhi::BufferRange{answer_buffer}}},
                                 .label = "probe"});
  const TrialConstants constants = {trial.flags, trial.mask, trial.acceptance, ray_count};
  const std::span<const std::byte> push_constants = std::as_bytes(std::span(&constants, 1));
  // What no invocation writes is no answer.
  list->fill({answer_buffer}, static_cast<std::uint32_t>(AnswerType::missing));
  if (form_ == pathtracer::TracingMode::query) {
    const std::uint32_t workgroup = compute_->reflection().workgroup_size[0];
    list->dispatch({.pipeline = compute_,
                    .bind_groups = {group},
                    .push_constants = push_constants,
                    .workgroup_count = {(ray_count + workgroup - 1) / workgroup, 1, 1}});
  } else {
    rhi::TraceRaysDesc desc;
    desc.table = table_;
    desc.bind_groups = {group};
    desc.push_constants = push_constants;
    desc.size = {ray_count, 1, 1};
    list->trace_rays(desc);
  }
  device_.submit(list)->wait();
  return rhi::read<ProbeAnswer>(device_, answer_buffer, rays.size());
}

}  // namespace tandem::compare
