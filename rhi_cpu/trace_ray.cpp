#include "rhi_cpu/trace_ray.hpp"

#include <algorithm>
#include <cstring>

#include "rhi_cpu/kernel/trace.hpp"

namespace tandem::cpu {
namespace {

using kernel::CandidateDecision;
using kernel::Hit;
using kernel::HitDecision;
using kernel::Ray;
using kernel::ShaderCall;

/// Bits that Vulkan reads of the operands of OpTraceRayKHR.
constexpr std::uint32_t sbt_bits = 0xF;
constexpr std::uint32_t miss_bits = 0xFFFF;
constexpr std::uint32_t mask_bits = 0xFF;

/// What an intersection shader, which decides about it, is given for the kind of its hit.
constexpr std::uint32_t no_hit_kind = 0;

struct alignas(16) HitAttributes {
  std::byte bytes[kernel::max_hit_attribute_size];
};

HitAttributes triangle_attributes(const Hit& hit) {
  HitAttributes attributes{};
  std::memcpy(attributes.bytes, hit.barycentrics, sizeof(hit.barycentrics));
  return attributes;
}

std::uint32_t triangle_hit_kind(const Hit& hit) {
  return hit.front_face ? kernel::hit_kind_front_facing_triangle : kernel::hit_kind_back_facing_triangle;
}

/// A ray while it looks for its hit.
struct Traversal {
  const ShaderCall& caller;  ///< of traceRayEXT
  const RayLaunch& launch;
  const kernel::TopLevel& scene;
  const Ray& ray;
  std::uint64_t record_offset;  ///< traceRayEXT's sbtRecordOffset
  std::uint32_t record_stride;
  void* payload;
  std::uint32_t payload_size;
  /// Of the box that is committed, when it is a box.
  HitAttributes box_attributes;
  std::uint32_t box_hit_kind;
};

/// A box while its intersection shader runs.
struct BoxCandidate {
  Traversal& traversal;
  const HitRecord& record;
  const Hit& hit;
  bool accepted = false;
};

/// What the calls of one invocation share: ShaderCall::host points at it.
struct Invocation {
  const RayLaunch& launch;
  std::uint32_t callable_depth = 0;
  BoxCandidate* box = nullptr;  ///< whose intersection shader runs; it traces no rays, so there is one at a time
};

Invocation& invocation_of(const ShaderCall& call) { return *static_cast<Invocation*>(call.host); }

/// The call of a shader by what `caller` does.
ShaderCall call_from(const ShaderCall& caller) {
  ShaderCall call;
  call.functions = caller.functions;
  call.host = caller.host;
  call.push_constants = caller.push_constants;
  std::copy_n(caller.launch_id, 3, call.launch_id);
  std::copy_n(caller.launch_size, 3, call.launch_size);
  call.depth = caller.depth;
  call.watch = caller.watch;
  return call;
}

/// The call of a shader that serves a ray.
ShaderCall call_of_ray(const ShaderCall& caller, const Ray& ray, void* payload, std::uint32_t payload_size) {
  ShaderCall call = call_from(caller);
  call.depth = caller.depth + 1;
  call.ray = &ray;
  call.payload = payload;
  call.payload_size = payload_size;
  return call;
}

/// The call of a shader that serves a ray at one of its hits.
/// @param t of the hit, or what an intersection shader sees as gl_RayTmaxEXT
ShaderCall call_at_hit(const Traversal& traversal, const Hit& hit, float t, std::uint32_t hit_kind, void* attributes) {
  ShaderCall call = call_of_ray(traversal.caller, traversal.ray, traversal.payload, traversal.payload_size);
  call.hit_attributes = attributes;
  call.t = t;
  call.hit_kind = hit_kind;
  call.hit = &hit;
  call.instance = &traversal.scene.instances[hit.instance_index];
  return call;
}

/// Calls the shader, unless its payload is larger than the one that it would be given.
void run(const RayLaunch& launch, std::uint32_t shader, const std::byte* record_data, ShaderCall& call) {
  const BoundShader& bound = launch.shaders[shader];
  if (call.payload_size < bound.payload_size) {
    launch.failures.note(LaunchFailure::payload, shader);
    return;
  }
  call.resources = bound.resources;
  call.shader_record = record_data;
  bound.call(call);
}

/// Counted from the first hit record of the trace.
std::uint64_t record_index(const Traversal& traversal, const Hit& hit) {
  return traversal.record_offset + traversal.scene.instances[hit.instance_index].sbt_offset +
         std::uint64_t{hit.geometry_index} * traversal.record_stride;
}

/// Record `index` of those that begin at `first`, or null where there is no such record. Where none begin there, every
/// index names a record without shaders.
template <typename Record>
const Record* record_at(std::span<const Record> records, std::uint32_t first, std::uint64_t index) {
  static constexpr Record nothing;
  if (first >= records.size()) return &nothing;
  return index < records.size() - first ? &records[first + index] : nullptr;
}

/// As record_at; that there is no such record is noted.
template <typename Record>
const Record* use_record(const RayLaunch& launch, std::span<const Record> records, std::uint32_t first,
                         std::uint64_t index, LaunchFailure failure) {
  const Record* record = record_at(records, first, index);
  if (record == nullptr)
    launch.failures.note(failure, static_cast<std::uint32_t>(std::min<std::uint64_t>(index, ~std::uint32_t{0})));
  return record;
}

/// The record of a hit whose shader is to run.
const HitRecord* use_hit_record(const Traversal& traversal, const Hit& hit) {
  const RayLaunch& launch = traversal.launch;
  return use_record(launch, launch.table.hit(), launch.first.hit, record_index(traversal, hit),
                    LaunchFailure::hit_record);
}

/// @param hit with the t at which it is hit
HitDecision run_any_hit(const Traversal& traversal, const HitRecord& record, const Hit& hit, std::uint32_t hit_kind,
                        void* attributes) {
  ShaderCall call = call_at_hit(traversal, hit, hit.t, hit_kind, attributes);
  run(traversal.launch, record.any_hit, record.data, call);
  return call.decision;
}

CandidateDecision visit_triangle(void* context, const Hit& candidate) {
  const Traversal& traversal = *static_cast<const Traversal*>(context);
  const RayLaunch& launch = traversal.launch;
  // What an opaque triangle's record says of shaders is only asked when it is the closest.
  const HitRecord* record = candidate.opaque
                                ? record_at(launch.table.hit(), launch.first.hit, record_index(traversal, candidate))
                                : use_hit_record(traversal, candidate);
  if (record == nullptr) return CandidateDecision::commit;
  if (record->intersection != rhi::no_shader) return CandidateDecision::ignore;
  if (candidate.opaque || record->any_hit == rhi::no_shader) return CandidateDecision::commit;
  HitAttributes attributes = triangle_attributes(candidate);
  switch (run_any_hit(traversal, *record, candidate, triangle_hit_kind(candidate), attributes.bytes)) {
    case HitDecision::ignore:
      return CandidateDecision::ignore;
    case HitDecision::terminate:
      return CandidateDecision::commit_and_terminate;
    case HitDecision::accept:
      break;
  }
  return CandidateDecision::commit;
}

CandidateDecision visit_box(void* context, Hit& candidate, float t_max) {
  Traversal& traversal = *static_cast<Traversal*>(context);
  const HitRecord* record = use_hit_record(traversal, candidate);
  if (record == nullptr || record->intersection == rhi::no_shader) return CandidateDecision::ignore;

  BoxCandidate box{.traversal = traversal, .record = *record, .hit = candidate};
  HitAttributes attributes{};
  ShaderCall call = call_at_hit(traversal, candidate, t_max, no_hit_kind, attributes.bytes);
  // Intersection shaders have none.
  call.payload = nullptr;
  call.payload_size = 0;
  Invocation& invocation = invocation_of(call);
  invocation.box = &box;
  run(traversal.launch, record->intersection, record->data, call);
  invocation.box = nullptr;
  if (!box.accepted) return CandidateDecision::ignore;
  candidate.t = call.t;
  return call.decision == HitDecision::terminate ? CandidateDecision::commit_and_terminate : CandidateDecision::commit;
}

bool report_intersection(ShaderCall& caller, float t, std::uint32_t hit_kind) {
  BoxCandidate* box = invocation_of(caller).box;
  if (box == nullptr) return false;
  Traversal& traversal = box->traversal;
  // Both ends are included: Vulkan specification, "Ray Intersection Candidate Determination".
  if (!(t >= traversal.ray.t_min && t <= caller.t)) return false;

  HitDecision decision = HitDecision::accept;
  if (!box->hit.opaque && box->record.any_hit != rhi::no_shader) {
    Hit reported = box->hit;
    reported.t = t;
    decision = run_any_hit(traversal, box->record, reported, hit_kind, caller.hit_attributes);
  }
  if (decision == HitDecision::ignore) return false;
  box->accepted = true;
  traversal.box_hit_kind = hit_kind;
  std::memcpy(traversal.box_attributes.bytes, caller.hit_attributes, sizeof(HitAttributes));
  caller.t = t;
  const bool is_last =
      decision == HitDecision::terminate || (traversal.ray.flags & kernel::ray_flag_terminate_on_first_hit) != 0;
  if (is_last) caller.decision = HitDecision::terminate;
  return true;
}

/// Whether the ray can meet a triangle that is not opaque.
bool meets_any_hit(const kernel::TopLevel& scene, std::uint32_t flags) {
  if ((flags & (kernel::ray_flag_opaque | kernel::ray_flag_cull_no_opaque)) != 0) return false;
  return (flags & kernel::ray_flag_no_opaque) != 0 || !scene.all_opaque;
}

void run_closest_hit(Traversal& traversal, const Hit& hit) {
  if ((traversal.ray.flags & kernel::ray_flag_skip_closest_hit_shader) != 0) return;
  const HitRecord* record = use_hit_record(traversal, hit);
  if (record == nullptr || record->closest_hit == rhi::no_shader) return;
  HitAttributes attributes = hit.is_box ? traversal.box_attributes : triangle_attributes(hit);
  const std::uint32_t hit_kind = hit.is_box ? traversal.box_hit_kind : triangle_hit_kind(hit);
  ShaderCall call = call_at_hit(traversal, hit, hit.t, hit_kind, attributes.bytes);
  run(traversal.launch, record->closest_hit, record->data, call);
}

void run_miss(const ShaderCall& caller, const RayLaunch& launch, const Ray& ray, std::uint32_t index, void* payload,
              std::uint32_t payload_size) {
  const GeneralRecord* record =
      use_record(launch, launch.table.miss(), launch.first.miss, index, LaunchFailure::miss_record);
  if (record == nullptr || record->shader == rhi::no_shader) return;
  ShaderCall call = call_of_ray(caller, ray, payload, payload_size);
  call.t = ray.t_max;
  run(launch, record->shader, record->data, call);
}

enum class Outcome {
  miss,
  hit,
  occluded  ///< something is hit; what it is, no shader asks
};

/// Finds what the ray hits, with as few calls as that takes.
Outcome find_hit(Traversal& traversal, Hit& hit) {
  const kernel::TopLevel& scene = traversal.scene;
  const Ray& ray = traversal.ray;
  const ShaderTable& table = traversal.launch.table;
  // With groups for boxes in the table, every triangle's group has to be looked at: theirs may be such a one.
  if (table.has_intersection() || (table.has_any_hit() && meets_any_hit(scene, ray.flags))) {
    const kernel::CandidateVisitor visitor{.context = &traversal,
                                           .triangle = &visit_triangle,
                                           .box = &visit_box,
                                           .visits_opaque_triangles = table.has_intersection()};
    return scene.functions->visit(scene, ray, visitor, hit) ? Outcome::hit : Outcome::miss;
  }
  constexpr std::uint32_t any_hit_only =
      kernel::ray_flag_terminate_on_first_hit | kernel::ray_flag_skip_closest_hit_shader;
  if ((ray.flags & any_hit_only) == any_hit_only)
    return scene.functions->occluded(scene, ray) ? Outcome::occluded : Outcome::miss;
  return scene.functions->closest(scene, ray, hit) ? Outcome::hit : Outcome::miss;
}

void trace_ray(ShaderCall& caller, const kernel::TopLevel* scene, const Ray& ray, std::uint32_t sbt_record_offset,
               std::uint32_t sbt_record_stride, std::uint32_t miss_index, void* payload, std::uint32_t payload_size) {
  const RayLaunch& launch = invocation_of(caller).launch;
  if (caller.depth >= launch.max_recursion_depth) {
    launch.failures.note(LaunchFailure::recursion, 0);
    return;
  }
  // Written so that a NaN at either end meets nothing too.
  const bool meets_anything = scene != nullptr && (ray.mask & mask_bits) != 0 && ray.t_min < ray.t_max;
  if (meets_anything) {
    Traversal traversal{.caller = caller,
                        .launch = launch,
                        .scene = *scene,
                        .ray = ray,
                        .record_offset = sbt_record_offset & sbt_bits,
                        .record_stride = sbt_record_stride & sbt_bits,
                        .payload = payload,
                        .payload_size = payload_size,
                        .box_attributes = {},
                        .box_hit_kind = 0};
    Hit hit;
    const Outcome outcome = find_hit(traversal, hit);
    if (outcome == Outcome::hit) run_closest_hit(traversal, hit);
    if (outcome != Outcome::miss) return;
  }
  run_miss(caller, launch, ray, miss_index & miss_bits, payload, payload_size);
}

void execute_callable(ShaderCall& caller, std::uint32_t index, void* data, std::uint32_t data_size) {
  Invocation& invocation = invocation_of(caller);
  const RayLaunch& launch = invocation.launch;
  const GeneralRecord* record =
      use_record(launch, launch.table.callable(), launch.first.callable, index, LaunchFailure::callable_record);
  if (record == nullptr || record->shader == rhi::no_shader) return;
  if (invocation.callable_depth == rhi::max_callable_depth) {
    launch.failures.note(LaunchFailure::callable_depth, 0);
    return;
  }
  ShaderCall call = call_from(caller);
  call.payload = data;
  call.payload_size = data_size;
  ++invocation.callable_depth;
  run(launch, record->shader, record->data, call);
  --invocation.callable_depth;
}

constexpr kernel::PipelineFunctions functions = {
    .trace_ray = &trace_ray, .execute_callable = &execute_callable, .report_intersection = &report_intersection};

}  // namespace

void generate_rays(const RayLaunch& launch, const GeneralRecord& record, const std::byte* push_constants,
                   const std::array<std::uint32_t, 3>& id, const std::array<std::uint32_t, 3>& size) {
  Invocation invocation{.launch = launch};
  ShaderCall call;
  call.functions = &functions;
  call.host = &invocation;
  call.push_constants = push_constants;
  call.watch = launch.watch;
  std::copy_n(id.data(), 3, call.launch_id);
  std::copy_n(size.data(), 3, call.launch_size);
  run(launch, record.shader, record.data, call);
}

}  // namespace tandem::cpu
