#include <utility>

#include "conformance/kit/check.hpp"
#include "conformance/pipeline/cases.hpp"
#include "conformance/pipeline/stack.hpp"

// Ray flags, masks and t windows of traceRayEXT. Vulkan: "Ray Closest Hit Determination", "Ray Traversal".
namespace tandem::conformance {
namespace {

using namespace pipeline;
using rhi::GeometryFlags;
using rhi::InstanceFlags;

Report run_one(Context& context, const Probe& probe) { return run(context, probe, "ray flags").reports.at(0); }

void skip_closest_hit(Context& context) {
  StackProbe probe = triangle_stack(context.device(), 1, GeometryFlags::opaque);
  probe.rays = {through_stack(ray_flags::skip_closest_hit_shader), through_stack(ray_flags::skip_closest_hit_shader)};
  probe.rays[1].origin.x = 50;
  const ProbeResult result = run(context, probe, "ray flags");
  check_equal("the shader that ran for a hit", result.reports[0].shader, reporter::none);
  check_equal("the shader that ran for a miss", result.reports[1].shader, reporter::miss);
}

void skip_closest_hit_runs_any_hit(Context& context) {
  StackProbe probe = triangle_stack(context.device(), 2);
  probe.decisions = {Decision::ignore, Decision::ignore};
  probe.rays[0].flags = ray_flags::skip_closest_hit_shader;
  const Report report = run_one(context, probe);
  check_missed(report);
  check_equal("the primitives offered, as bits", report.any_hit_primitives, 3u);
}

void terminate_on_first_hit(Context& context) {
  StackProbe probe = triangle_stack(context.device(), 5, GeometryFlags::opaque);
  probe.rays[0].flags = ray_flags::terminate_on_first_hit;
  const Report report = run_one(context, probe);
  check(report.primitive < 5, "no such primitive");
  check_closest_hit(report, report.primitive, 5.0 + report.primitive);
}

void shadow_ray(Context& context) {
  // The usual shadow ray: only the miss shader says anything.
  StackProbe probe = triangle_stack(context.device(), 2, GeometryFlags::opaque);
  const std::uint32_t flags =
      ray_flags::terminate_on_first_hit | ray_flags::skip_closest_hit_shader | ray_flags::opaque;
  probe.rays = {through_stack(flags), through_stack(flags), through_stack(flags)};
  probe.rays[1].t_max = 4.5F;
  probe.rays[2].origin.y = -3;
  const ProbeResult result = run(context, probe, "ray flags");
  check_equal("the shader that ran for an occluded ray", result.reports[0].shader, reporter::none);
  check_equal("the shader that ran for a ray that ends in front", result.reports[1].shader, reporter::miss);
  check_equal("the shader that ran for a ray beside", result.reports[2].shader, reporter::miss);
}

/// A ray through triangles that it meets from the front (from above) or back (from below).
struct Facing {
  std::string_view name;
  std::string_view behaviour;
  bool from_above;
  std::uint32_t flags;
  InstanceFlags instance;
  bool hit;
  std::uint32_t kind;
};
constexpr Facing facings[] = {
    {"cull_back_faces_back", "the ray flag cull-back-facing-triangles leaves out back faces", false,
     ray_flags::cull_back_facing, InstanceFlags::none, false, 0},
    {"cull_back_faces_front", "the ray flag cull-back-facing-triangles leaves front faces", true,
     ray_flags::cull_back_facing, InstanceFlags::none, true, 0xFE},
    {"cull_front_faces_back", "the ray flag cull-front-facing-triangles leaves back faces", false,
     ray_flags::cull_front_facing, InstanceFlags::none, true, 0xFF},
    {"cull_front_faces_front", "the ray flag cull-front-facing-triangles leaves out front faces", true,
     ray_flags::cull_front_facing, InstanceFlags::none, false, 0},
    {"flip_facing_kind", "an instance that flips facing makes front faces back faces", true, 0,
     InstanceFlags::triangle_flip_facing, true, 0xFF},
    {"flip_facing_cull", "an instance that flips facing has its back faces left out as such", true,
     ray_flags::cull_back_facing, InstanceFlags::triangle_flip_facing, false, 0},
    {"facing_cull_disable_back", "an instance without facing culling keeps its back faces", false,
     ray_flags::cull_back_facing, InstanceFlags::triangle_facing_cull_disable, true, 0xFF},
    {"facing_cull_disable_front", "an instance without facing culling keeps its front faces", true,
     ray_flags::cull_front_facing, InstanceFlags::triangle_facing_cull_disable, true, 0xFE},
};

void check_facing(Context& context, const Facing& facing) {
  StackProbe probe = triangle_stack(context.device(), 1, GeometryFlags::opaque, facing.instance);
  probe.rays[0].flags = facing.flags;
  if (!facing.from_above) {
    probe.rays[0].origin.z = -5;
    probe.rays[0].direction.z = 1;
  }
  const Report report = run_one(context, probe);
  if (!facing.hit) return check_missed(report);
  check_closest_hit(report, 0, 5);
  check_equal("gl_HitKindEXT", report.hit_kind, facing.kind);
}

/// Two instances: the nearer one is not opaque, the farther one is.
void check_opacity_cull(Context& context, std::uint32_t flags, std::uint32_t expected_instance, double t) {
  rhi::Device& device = context.device();
  const auto not_opaque = build_bottom_level(device, {stacked_triangles(device, 1, GeometryFlags::none)});
  const auto opaque = build_bottom_level(device, {stacked_triangles(device, 1, GeometryFlags::opaque, -1)});
  Probe probe;
  probe.scene = build_top_level(device, {rhi::make_instance(*not_opaque), rhi::make_instance(*opaque)});
  probe.rays = {through_stack(flags)};
  const Report report = run_one(context, probe);
  check_closest_hit(report, 0, t);
  check_equal("gl_InstanceID", report.instance, expected_instance);
}

void cull_opaque_after_ray_flag(Context& context) {
  // The instance forces no-opaque, so nothing of it counts as opaque.
  StackProbe probe = triangle_stack(context.device(), 1, GeometryFlags::opaque, InstanceFlags::force_no_opaque);
  probe.rays[0].flags = ray_flags::cull_opaque;
  check_closest_hit(run_one(context, probe), 0, 5);
}

/// Boxes in front of triangles, with flags that skip one kind.
Report trace_both_kinds(Context& context, std::uint32_t flags) {
  rhi::Device& device = context.device();
  const auto near_boxes = build_bottom_level(device, {stacked_boxes(device, 1, GeometryFlags::opaque)});
  const auto far_triangles = build_bottom_level(device, {stacked_triangles(device, 1, GeometryFlags::opaque, -1)});
  std::vector<rhi::InstanceDesc> instances = {rhi::make_instance(*near_boxes), rhi::make_instance(*far_triangles)};
  instances[1].sbt_offset = 1;
  Probe probe;
  probe.scene = build_top_level(device, instances);
  probe.hit_groups = {{.closest_hit = probe::box_closest_hit, .intersection = probe::intersection},
                      {.closest_hit = probe::closest_hit}};
  probe.rays = {through_stack(flags)};
  probe.plans = {Plan{.count = 1, .t = {5.25F}, .kind = {9}}};
  return run_one(context, probe);
}

void mask_bits(Context& context) {
  // Instance i has mask bit i and lies at t = 5 + i: the ray's mask picks.
  rhi::Device& device = context.device();
  const auto bottom = build_bottom_level(device, {stacked_triangles(device, 1, GeometryFlags::opaque)});
  std::vector<rhi::InstanceDesc> instances;
  Probe probe;
  for (std::uint32_t i = 0; i < 8; ++i) {
    instances.push_back(rhi::make_instance(*bottom, translation(0, 0, -static_cast<float>(i))));
    instances.back().mask = (1u << i) & 0xFF;
    probe.rays.push_back(through_stack());
    probe.rays.back().mask = 1u << i;
  }
  probe.scene = build_top_level(device, instances);
  const ProbeResult result = run(context, probe, "ray flags");
  for (std::uint32_t i = 0; i < 8; ++i) {
    check_closest_hit(result.reports[i], 0, 5.0 + i);
    check_equal("gl_InstanceID", result.reports[i].instance, i);
  }
}

void mask_of_eight_bits(Context& context) {
  // SPIR-V, OpTraceRayKHR: only the 8 least-significant bits of Cull Mask are used.
  StackProbe probe = triangle_stack(context.device(), 1, GeometryFlags::opaque);
  probe.rays = {through_stack(), through_stack()};
  probe.rays[0].mask = 0xFFFFFF00;
  probe.rays[1].mask = 0xFFFFFF01;
  const ProbeResult result = run(context, probe, "ray flags");
  check_missed(result.reports[0]);
  check_closest_hit(result.reports[1], 0, 5);
}

void t_window(Context& context) {
  StackProbe probe = triangle_stack(context.device(), 5, GeometryFlags::opaque);
  probe.rays = {through_stack(), through_stack(), through_stack()};
  probe.rays[0].t_min = 6.5F;
  probe.rays[1].t_max = 4.5F;
  probe.rays[2].t_min = 9.5F;
  const ProbeResult result = run(context, probe, "ray flags");
  check_closest_hit(result.reports[0], 2, 7);
  check_missed(result.reports[1]);
  check_missed(result.reports[2]);
}

void direction_length(Context& context) {
  StackProbe probe = triangle_stack(context.device(), 3, GeometryFlags::opaque);
  probe.rays = {through_stack(), through_stack()};
  probe.rays[0].direction.z = -0.125F;
  probe.rays[1].direction.z = -16;
  const ProbeResult result = run(context, probe, "ray flags");
  check_closest_hit(result.reports[0], 0, 40);
  check_closest_hit(result.reports[1], 0, 5.0 / 16);
}

}  // namespace

void add_pipeline_ray_flags_cases(Cases& cases) {
  const auto add = [&cases](const std::string& name, const std::string& behaviour, std::function<void(Context&)> run,
                            std::vector<Capability> more_needs = {}) {
    more_needs.push_back(&rhi::Capabilities::ray_tracing_pipeline);
    Group{.cases = cases, .name = "ray_tracing_pipeline.ray_flags", .needs = std::move(more_needs)}.add(name, behaviour,
                                                                                                        std::move(run));
  };
  add("skip_closest_hit", "the flag skip-closest-hit keeps the closest-hit shader from running, not the miss shader",
      skip_closest_hit);
  add("skip_closest_hit_runs_any_hit", "the flag skip-closest-hit lets any-hit shaders run",
      skip_closest_hit_runs_any_hit);
  add("terminate_on_first_hit", "the flag terminate-on-first-hit gives some hit with its own t",
      terminate_on_first_hit);
  add("shadow_ray", "with terminate-on-first-hit and skip-closest-hit only rays that meet nothing run a shader",
      shadow_ray);
  for (const Facing& facing : facings)
    add(std::string(facing.name), std::string(facing.behaviour),
        [facing](Context& context) { check_facing(context, facing); });
  add("cull_opaque", "the flag cull-opaque leaves out what is opaque",
      [](Context& context) { check_opacity_cull(context, ray_flags::cull_opaque, 0, 5); });
  add("cull_no_opaque", "the flag cull-no-opaque leaves out what is not opaque",
      [](Context& context) { check_opacity_cull(context, ray_flags::cull_no_opaque, 1, 6); });
  add("cull_opaque_after_override", "the flag cull-opaque looks at the opacity that the instance forces",
      cull_opaque_after_ray_flag);
  add("skip_triangles", "the flag skip-triangles leaves boxes",
      [](Context& context) {
        const Report report = trace_both_kinds(context, ray_flags::skip_triangles);
        check_equal("gl_HitKindEXT", report.hit_kind, 9u);
      },
      {&rhi::Capabilities::primitive_culling});
  add("skip_boxes", "the flag skip-AABBs leaves triangles",
      [](Context& context) { check_closest_hit(trace_both_kinds(context, ray_flags::skip_boxes), 0, 6); },
      {&rhi::Capabilities::primitive_culling});
  add("mask_bits", "a ray meets the instances whose mask shares a bit with its own", mask_bits);
  add("mask_of_eight_bits", "only the lowest eight bits of a ray's mask count", mask_of_eight_bits);
  add("t_window", "only hits between t_min and t_max count", t_window);
  add("direction_length", "t counts lengths of the direction", direction_length);
}

}  // namespace tandem::conformance
