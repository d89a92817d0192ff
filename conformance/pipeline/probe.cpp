#include "conformance/pipeline/probe.hpp"

#include <algorithm>

namespace tandem::conformance::pipeline {
namespace {

const std::string report_declaration = R"(
struct Report {
  uint shader; uint record; uint launch_id[3]; uint launch_size[3];
  uint primitive; uint instance; uint custom_index; uint geometry; uint hit_kind; uint flags;
  float t_min; float t_max; float hit_t; float attributes[8];
  float world_origin[3]; float world_direction[3]; float object_origin[3]; float object_direction[3];
  float object_to_world[12]; float world_to_object[12]; float object_to_world_3x4[12]; float world_to_object_3x4[12];
  uint any_hits; uint any_hit_primitives; uint any_hit_records;
};
)";

const std::string payload_declaration = report_declaration + "layout(location = 0) rayPayloadInEXT Report report;\n";
const std::string record_declaration = "layout(shaderRecordEXT, std430) buffer Record { uint word; } record;\n";
const std::string triangle_attributes = "hitAttributeEXT vec2 barycentrics;\n";
const std::string box_attributes = "struct Attributes { float values[8]; };\nhitAttributeEXT Attributes attributes;\n";
const std::string decisions_declaration =
    "layout(set = 0, binding = 3, std430) readonly buffer Decisions { uint decisions[]; };\n";

/// Statements that fill `report` with what every shader but ray generation and callable knows.
const std::string describe_ray = R"(
  for (int i = 0; i < 3; ++i) {
    report.launch_id[i] = gl_LaunchIDEXT[i];
    report.launch_size[i] = gl_LaunchSizeEXT[i];
    report.world_origin[i] = gl_WorldRayOriginEXT[i];
    report.world_direction[i] = gl_WorldRayDirectionEXT[i];
  }
  report.t_min = gl_RayTminEXT;
  report.t_max = gl_RayTmaxEXT;
  report.flags = gl_IncomingRayFlagsEXT;
)";

/// Likewise with what any-hit, closest-hit and intersection shaders know.
const std::string describe_primitive = R"(
  report.primitive = uint(gl_PrimitiveID);
  report.instance = uint(gl_InstanceID);
  report.custom_index = uint(gl_InstanceCustomIndexEXT);
  report.geometry = uint(gl_GeometryIndexEXT);
  for (int row = 0; row < 3; ++row) {
    report.object_origin[row] = gl_ObjectRayOriginEXT[row];
    report.object_direction[row] = gl_ObjectRayDirectionEXT[row];
    for (int column = 0; column < 4; ++column) {
      report.object_to_world[row * 4 + column] = gl_ObjectToWorldEXT[column][row];
      report.world_to_object[row * 4 + column] = gl_WorldToObjectEXT[column][row];
      report.object_to_world_3x4[row * 4 + column] = gl_ObjectToWorld3x4EXT[row][column];
      report.world_to_object_3x4[row * 4 + column] = gl_WorldToObject3x4EXT[row][column];
    }
  }
)";

const std::string describe_hit = R"(
  report.hit_kind = gl_HitKindEXT;
  report.hit_t = gl_HitTEXT;
)";

const std::string describe_barycentrics = R"(
  report.attributes[0] = barycentrics.x;
  report.attributes[1] = barycentrics.y;
)";

const std::string describe_box_attributes = R"(
  for (int i = 0; i < 8; ++i) report.attributes[i] = attributes.values[i];
)";

const std::string decide = R"(
void main() {
  ++report.any_hits;
  report.any_hit_primitives |= 1u << uint(gl_PrimitiveID);
  report.any_hit_records |= record.word;
  if (decisions[gl_PrimitiveID] == 1u) ignoreIntersectionEXT;
  if (decisions[gl_PrimitiveID] == 2u) terminateRayEXT;
}
)";

std::string reporting(std::uint32_t shader, const std::string& statements) {
  return "void main() {\n  report.shader = " + std::to_string(shader) + "u;\n" + statements + "}\n";
}

}  // namespace

namespace probe {

const std::string ray_generation = report_declaration + R"(
struct Ray {
  vec3 origin; float t_min; vec3 direction; float t_max;
  uint flags; uint mask; uint record_offset; uint record_stride; uint miss_index; uint padding[3];
};
layout(set = 0, binding = 0) uniform accelerationStructureEXT scene;
layout(set = 0, binding = 1, std430) readonly buffer Rays { Ray rays[]; };
layout(set = 0, binding = 2, std430) buffer Reports { Report reports[]; };
layout(location = 0) rayPayloadEXT Report report;
void main() {
  uint index = gl_LaunchIDEXT.x;
  Ray ray = rays[index];
  report = reports[index];
  traceRayEXT(scene, ray.flags, ray.mask, ray.record_offset, ray.record_stride, ray.miss_index, ray.origin, ray.t_min,
              ray.direction, ray.t_max, 0);
  reports[index] = report;
}
)";

const std::string miss = payload_declaration + record_declaration +
                         reporting(reporter::miss, "  report.record = record.word;\n" + describe_ray);

const std::string closest_hit =
    payload_declaration + record_declaration + triangle_attributes +
    reporting(reporter::closest_hit, "  report.record = record.word;\n" + describe_ray + describe_primitive +
                                         describe_hit + describe_barycentrics);

const std::string any_hit = payload_declaration + record_declaration + decisions_declaration + decide;

const std::string any_hit_report =
    payload_declaration + record_declaration + triangle_attributes +
    reporting(reporter::any_hit, "  report.record = record.word;\n" + describe_ray + describe_primitive + describe_hit +
                                     describe_barycentrics);

const std::string box_closest_hit =
    payload_declaration + record_declaration + box_attributes +
    reporting(reporter::closest_hit, "  report.record = record.word;\n" + describe_ray + describe_primitive +
                                         describe_hit + describe_box_attributes);

const std::string box_any_hit = any_hit;

const std::string box_any_hit_report =
    payload_declaration + record_declaration + box_attributes +
    reporting(reporter::any_hit, "  report.record = record.word;\n" + describe_ray + describe_primitive + describe_hit +
                                     describe_box_attributes);

const std::string intersection = box_attributes + R"(
struct Plan { uint count; float t[4]; uint kind[4]; };
struct Outcome { uint runs; uint accepted; float t_max[5]; };
layout(set = 0, binding = 4, std430) readonly buffer Plans { Plan plans[]; };
layout(set = 0, binding = 5, std430) buffer Outcomes { Outcome outcomes[]; };
void main() {
  uint box = uint(gl_GeometryIndexEXT) * 16u + uint(gl_PrimitiveID);
  uint outcome = gl_LaunchIDEXT.x * 64u + box;
  ++outcomes[outcome].runs;
  for (uint i = 0u; i < plans[box].count; ++i) {
    float t = plans[box].t[i];
    uint kind = plans[box].kind[i];
    for (int k = 0; k < 8; ++k) attributes.values[k] = t * float(k + 1) + float(kind);
    outcomes[outcome].t_max[i] = gl_RayTmaxEXT;
    if (reportIntersectionEXT(t, kind)) outcomes[outcome].accepted |= 1u << i;
  }
  outcomes[outcome].t_max[plans[box].count] = gl_RayTmaxEXT;
}
)";

const std::string intersection_report = report_declaration + record_declaration + R"(
layout(set = 0, binding = 6, std430) buffer Reports { Report reports[]; };
void main() {
  Report report = reports[gl_LaunchIDEXT.x];
  report.shader = 4u;
  report.record = record.word;
)" + describe_ray + describe_primitive + "  reports[gl_LaunchIDEXT.x] = report;\n}\n";

}  // namespace probe

rhi::ShaderRecords numbered_records(std::size_t count, std::uint32_t first_word) {
  rhi::ShaderRecords records;
  for (std::uint32_t i = 0; i < count; ++i) records.records.push_back(record_with(i, first_word + i));
  return records;
}

ProbeResult run(Context& context, const Probe& probe, const std::string& label) {
  rhi::Device& device = context.device();
  const PipelineText text = {.ray_generation = {probe::ray_generation},
                             .miss = std::vector<std::string>(probe.miss_count, probe::miss),
                             .hit_groups = probe.hit_groups};
  constexpr std::size_t decision_count = 32;
  constexpr std::size_t plan_count = outcomes_per_ray;
  std::vector<Decision> decisions = probe.decisions;
  decisions.resize(std::max(decision_count, decisions.size()));
  std::vector<Plan> plans = probe.plans;
  plans.resize(plan_count);

  Launch launch;
  launch.scene = probe.scene;
  launch.buffers = {buffer_of(device, probe.rays, "rays"),
                    buffer_of(device, std::vector<Report>(probe.rays.size()), "reports"),
                    buffer_of(device, decisions, "decisions"),
                    buffer_of(device, plans, "plans"),
                    buffer_of(device, std::vector<Outcome>(probe.rays.size() * outcomes_per_ray), "outcomes"),
                    buffer_of(device, std::vector<Report>(probe.rays.size()), "reports of intersection shaders")};
  launch.trace = probe.trace;
  launch.trace.size = {static_cast<std::uint32_t>(probe.rays.size()), 1, 1};
  launch.hit = probe.hit.records.empty() ? numbered_records(probe.hit_groups.size(), first_hit_word) : probe.hit;
  launch.miss = probe.miss.records.empty() ? numbered_records(probe.miss_count, first_miss_word) : probe.miss;
  run(device, make_pipeline(context, text, label), launch);
  return {.reports = rhi::read<Report>(device, launch.buffers[1], probe.rays.size()),
          .outcomes = rhi::read<Outcome>(device, launch.buffers[4], probe.rays.size() * outcomes_per_ray),
          .intersections = rhi::read<Report>(device, launch.buffers[5], probe.rays.size())};
}

}  // namespace tandem::conformance::pipeline
