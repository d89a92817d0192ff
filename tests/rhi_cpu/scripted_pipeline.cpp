#include "tests/rhi_cpu/scripted_pipeline.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <string>
#include <utility>

#include "rhi/glsl/compile.hpp"
#include "rhi_cpu/device.hpp"

namespace tandem::test {
namespace {

using kernel::CandidateDecision;
using kernel::Hit;
using kernel::KernelInfo;
using kernel::Ray;
using kernel::ShaderCall;

constexpr std::size_t slot_count = 8;

struct Slot {
  KernelInfo info;
  std::function<void(ShaderCall&)> run;
};

std::array<Slot, slot_count>& slots() {
  static std::array<Slot, slot_count> all;
  return all;
}

template <std::size_t slot>
const KernelInfo* entry() {
  return &slots()[slot].info;
}

template <std::size_t slot>
void call(ShaderCall& shader_call) {
  slots()[slot].run(shader_call);
}

struct SlotFunctions {
  kernel::EntryFunction entry;
  void (*call)(ShaderCall&);
};

template <std::size_t... slot>
std::array<SlotFunctions, slot_count> slot_functions(std::index_sequence<slot...>) {
  return {SlotFunctions{.entry = &entry<slot>, .call = &call<slot>}...};
}

/// A module of that stage whose words no other slot's module has.
const std::vector<std::uint32_t>& spirv_of(rhi::ShaderStage stage, std::size_t slot) {
  static std::map<std::pair<rhi::ShaderStage, std::size_t>, std::vector<std::uint32_t>> modules;
  std::vector<std::uint32_t>& words = modules[{stage, slot}];
  if (words.empty()) {
    const std::string source =
        "#version 460\n#extension GL_EXT_ray_tracing : require\nvoid main() { uint slot = " + std::to_string(slot) +
        "u; }";
    words = glsl::compile(source, stage, "slot " + std::to_string(slot));
  }
  return words;
}

bool closest_primitive(const ScriptedScene& scene, const Ray& ray, Hit& hit) {
  bool found = false;
  float t_max = ray.t_max;
  for (const Hit& each : scene.hits) {
    if (each.is_box || each.t >= t_max) continue;
    hit = each;
    t_max = each.t;
    found = true;
  }
  return found;
}

bool closest(const kernel::TopLevel& top_level, const Ray& ray, Hit& hit) {
  const auto& scene = static_cast<const ScriptedScene&>(top_level);
  ++scene.closest_calls;
  return closest_primitive(scene, ray, hit);
}

bool occluded(const kernel::TopLevel& top_level, const Ray& ray) {
  const auto& scene = static_cast<const ScriptedScene&>(top_level);
  ++scene.occluded_calls;
  Hit hit;
  return closest_primitive(scene, ray, hit);
}

bool visit(const kernel::TopLevel& top_level, const Ray& ray, const kernel::CandidateVisitor& visitor, Hit& committed) {
  const auto& scene = static_cast<const ScriptedScene&>(top_level);
  ++scene.visit_calls;
  bool found = false;
  float t_max = ray.t_max;
  for (Hit candidate : scene.hits) {
    if (candidate.t >= t_max) continue;
    CandidateDecision decision = CandidateDecision::commit;
    if (candidate.is_box)
      decision = visitor.box(visitor.context, candidate, t_max);
    else if (!candidate.opaque || visitor.visits_opaque_triangles)
      decision = visitor.triangle(visitor.context, candidate);
    if (decision == CandidateDecision::ignore) continue;
    committed = candidate;
    t_max = candidate.t;
    found = true;
    if (decision == CandidateDecision::commit_and_terminate ||
        (ray.flags & kernel::ray_flag_terminate_on_first_hit) != 0)
      break;
  }
  return found;
}

constexpr kernel::TraceFunctions scripted_functions = {.closest = &closest,
                                                       .occluded = &occluded,
                                                       .next_hits = nullptr,
                                                       .visit = &visit,
                                                       .closest_of_packet = nullptr,
                                                       .occluded_of_packet = nullptr};

}  // namespace

ScriptedPipeline::ScriptedPipeline(std::vector<ScriptedShader> shaders, const std::vector<ScriptedHitGroup>& hit_groups,
                                   std::uint32_t max_recursion_depth, std::uint32_t thread_count) {
  const auto functions = slot_functions(std::make_index_sequence<slot_count>());
  std::vector<cpu::PrecompiledKernel> kernels;
  for (std::size_t i = 0; i < shaders.size(); ++i) {
    Slot& slot = slots().at(i);
    slot.run = std::move(shaders[i].run);
    slot.info = {.abi_version = kernel::abi_version,
                 .workgroup_size = {1, 1, 1},
                 .push_constant_size = 0,
                 .resource_count = 0,
                 .binding_count = 0,
                 .bindings = nullptr,
                 .run = nullptr,
                 .stage = static_cast<kernel::Stage>(shaders[i].stage),
                 .call = functions[i].call,
                 .shader_record_size = shaders[i].shader_record_size,
                 .payload_size = shaders[i].payload_size};
    kernels.push_back({.spirv = spirv_of(shaders[i].stage, i), .entry = functions[i].entry});
  }
  device_ = cpu::create_device({.thread_count = thread_count}, std::move(kernels));

  std::vector<rhi::ShaderModuleHandle> modules;
  rhi::RayTracingPipelineDesc desc;
  desc.max_recursion_depth = max_recursion_depth;
  desc.label = "scripted";
  for (std::size_t i = 0; i < shaders.size(); ++i) {
    modules.push_back(device_->create_shader_module(
        {.spirv = spirv_of(shaders[i].stage, i), .label = "shader " + std::to_string(i)}));
    if (shaders[i].stage == rhi::ShaderStage::ray_generation) desc.ray_generation.push_back(modules.back());
    if (shaders[i].stage == rhi::ShaderStage::miss) desc.miss.push_back(modules.back());
    if (shaders[i].stage == rhi::ShaderStage::callable) desc.callable.push_back(modules.back());
  }
  const auto module_at = [&modules](int position) {
    return position < 0 ? nullptr : modules[static_cast<std::size_t>(position)];
  };
  for (const ScriptedHitGroup& group : hit_groups)
    desc.hit_groups.push_back({.closest_hit = module_at(group.closest_hit),
                               .any_hit = module_at(group.any_hit),
                               .intersection = module_at(group.intersection)});
  pipeline_ = device_->create_ray_tracing_pipeline(desc);
}

rhi::ShaderTableDesc ScriptedPipeline::table_desc(const std::vector<std::uint32_t>& hit_records) const {
  rhi::ShaderTableDesc desc;
  desc.pipeline = pipeline_;
  desc.label = "table";
  const auto number = [](rhi::ShaderRecords& records, std::size_t count) {
    for (std::uint32_t i = 0; i < count; ++i) records.records.push_back({.shader = i, .data = {}});
  };
  number(desc.ray_generation, pipeline_->desc().ray_generation.size());
  number(desc.miss, pipeline_->desc().miss.size());
  number(desc.callable, pipeline_->desc().callable.size());
  for (const std::uint32_t group : hit_records) desc.hit.records.push_back({.shader = group, .data = {}});
  return desc;
}

void ScriptedPipeline::submit(const rhi::TraceRaysDesc& desc) const {
  const rhi::CommandListHandle list = device_->create_command_list("trace");
  list->trace_rays(desc);
  device_->submit(list);
}

void ScriptedPipeline::trace_table(const rhi::ShaderTableHandle& table, std::array<std::uint32_t, 3> size) const {
  rhi::TraceRaysDesc desc;
  desc.table = table;
  desc.size = size;
  submit(desc);
}

void ScriptedPipeline::trace(const std::vector<std::uint32_t>& hit_records, std::array<std::uint32_t, 3> size) const {
  trace_table(device_->create_shader_table(table_desc(hit_records)), size);
}

ScriptedScene::ScriptedScene(std::vector<Hit> scripted_hits, std::vector<std::uint32_t> sbt_offsets)
    : kernel::TopLevel{}, hits(std::move(scripted_hits)) {
  for (const std::uint32_t offset : sbt_offsets) {
    instance_storage.push_back({});
    instance_storage.back().sbt_offset = offset;
  }
  functions = &scripted_functions;
  instances = instance_storage.data();
  instance_count = static_cast<std::uint32_t>(instance_storage.size());
  all_opaque = std::all_of(hits.begin(), hits.end(), [](const Hit& hit) { return hit.is_box || hit.opaque; });
  has_boxes = std::any_of(hits.begin(), hits.end(), [](const Hit& hit) { return hit.is_box; });
}

Hit triangle_at(float t, bool opaque) {
  return {.t = t,
          .barycentrics = {0.25f, 0.5f},
          .instance_index = 0,
          .geometry_index = 0,
          .primitive_index = 0,
          .front_face = true,
          .opaque = opaque,
          .is_box = false};
}

Hit box_at(float t, bool opaque) {
  Hit hit = triangle_at(t, opaque);
  hit.is_box = true;
  return hit;
}

Ray ray_with(std::uint32_t flags) {
  return {.origin = {0, 0, 0}, .t_min = 0, .direction = {0, 0, 1}, .t_max = 100, .flags = flags, .mask = 0xFF};
}

}  // namespace tandem::test
