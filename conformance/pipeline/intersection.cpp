#include <utility>

#include "conformance/kit/check.hpp"
#include "conformance/pipeline/cases.hpp"
#include "conformance/pipeline/stack.hpp"

// Intersection shaders: what reportIntersectionEXT accepts, what it returns, and what the shaders after it see. Vulkan:
// "Ray Intersection Candidate Determination"; SPIR-V: OpReportIntersectionKHR.
namespace tandem::conformance {
namespace {

using namespace pipeline;
using rhi::GeometryFlags;

ProbeResult run_probe(Context& context, const Probe& probe) { return run(context, probe, "intersection"); }

Plan plan_of(std::initializer_list<std::pair<float, std::uint32_t>> reports) {
  Plan plan;
  for (const auto& [t, kind] : reports) {
    plan.t[plan.count] = t;
    plan.kind[plan.count] = kind;
    ++plan.count;
  }
  return plan;
}

/// The closest hit is this one of the box, with the attributes that belong to it, to the last bit.
void check_box_hit(const Report& report, std::uint32_t primitive, float t, std::uint32_t kind) {
  check_equal("the shader that ran last", report.shader, reporter::closest_hit);
  check_equal("the primitive", report.primitive, primitive);
  check_equal("gl_HitTEXT", report.hit_t, t);
  check_equal("gl_HitKindEXT", report.hit_kind, kind);
  for (int i = 0; i < 8; ++i)
    check_equal(fmt::format("hit attribute {}", i), report.attributes[i], expected_attribute(i, t, kind));
}

void check_one_plan(Context& context, const Plan& plan, float t, std::uint32_t kind, std::uint32_t accepted) {
  const ProbeResult result = run_probe(context, box_stack(context.device(), {plan}));
  check_equal("the reports that returned true, as bits", result.outcomes[0].accepted, accepted);
  check_box_hit(result.reports[0], 0, t, kind);
}

void report_hit(Context& context) { check_one_plan(context, plan_of({{5.25F, 3}}), 5.25F, 3, 1); }

void hit_kind_ends(Context& context) {
  check_one_plan(context, plan_of({{5.25F, 0}}), 5.25F, 0, 1);
  check_one_plan(context, plan_of({{5.25F, 127}}), 5.25F, 127, 1);
}

void no_report(Context& context) {
  const ProbeResult result = run_probe(context, box_stack(context.device(), {Plan{}}));
  check(result.outcomes[0].runs > 0, "the intersection shader did not run");
  check_missed(result.reports[0]);
}

void not_run_outside_boxes(Context& context) {
  StackProbe probe = box_stack(context.device(), {plan_of({{5.25F, 3}})});
  probe.rays[0].origin = {3, 0.25F, 5};
  const ProbeResult result = run_probe(context, probe);
  check_missed(result.reports[0]);
}

/// Reports at these t for a ray over [5.125, 5.375]: which are accepted?
void check_window(Context& context, float t, bool accepted) {
  StackProbe probe = box_stack(context.device(), {plan_of({{t, 1}})});
  probe.rays[0].t_min = 5.125F;
  probe.rays[0].t_max = 5.375F;
  const ProbeResult result = run_probe(context, probe);
  check(result.outcomes[0].runs > 0, "the intersection shader did not run");
  check_equal("the return value of reportIntersectionEXT", result.outcomes[0].accepted, accepted ? 1u : 0u);
  if (accepted)
    check_box_hit(result.reports[0], 0, t, 1);
  else
    check_missed(result.reports[0]);
}

void descending_reports(Context& context) {
  check_one_plan(context, plan_of({{7, 1}, {6, 2}, {5.5F, 3}}), 5.5F, 3, 0b111);
}

void ascending_reports(Context& context) {
  check_one_plan(context, plan_of({{5.5F, 1}, {6, 2}, {7, 3}}), 5.5F, 1, 0b001);
}

void mixed_reports(Context& context) {
  check_one_plan(context, plan_of({{6, 1}, {7, 2}, {5.5F, 3}, {5.75F, 4}}), 5.5F, 3, 0b101);
}

void t_max_after_accepted(Context& context) {
  const StackProbe probe = box_stack(context.device(), {plan_of({{7, 1}, {8, 2}, {6, 3}})});
  const Outcome outcome = run_probe(context, probe).outcomes[0];
  check_equal("gl_RayTmaxEXT before any report", outcome.t_max[0], 100.0F);
  check_equal("gl_RayTmaxEXT after an accepted report at 7", outcome.t_max[1], 7.0F);
  check_equal("gl_RayTmaxEXT after a refused report at 8", outcome.t_max[2], 7.0F);
  check_equal("gl_RayTmaxEXT after an accepted report at 6", outcome.t_max[3], 6.0F);
}

void t_max_after_ignored(Context& context) {
  StackProbe probe = box_stack(context.device(), {plan_of({{7, 1}, {6, 2}})});
  probe.decisions = {Decision::ignore};
  const ProbeResult result = run_probe(context, probe);
  check_missed(result.reports[0]);
  for (int i = 0; i < 3; ++i)
    check_equal(fmt::format("gl_RayTmaxEXT after {} ignored reports", i), result.outcomes[0].t_max[i], 100.0F);
}

void ignored_returns_false(Context& context) {
  StackProbe probe = box_stack(context.device(), {plan_of({{6, 1}})});
  probe.decisions = {Decision::ignore};
  const ProbeResult result = run_probe(context, probe);
  check_missed(result.reports[0]);
  check(result.reports[0].any_hits > 0, "the any-hit shader did not run");
  check_equal("the return value of reportIntersectionEXT", result.outcomes[0].accepted, 0);
}

void terminate_ends_shader(Context& context) {
  StackProbe probe = box_stack(context.device(), {plan_of({{6, 1}, {5.5F, 2}})});
  probe.decisions = {Decision::terminate};
  const ProbeResult result = run_probe(context, probe);
  check_box_hit(result.reports[0], 0, 6, 1);
  check_equal("any-hit invocations", result.reports[0].any_hits, 1);
  check_equal("what the intersection shader wrote after the report that ended the ray", result.outcomes[0].t_max[1],
              0.0F);
}

void nearest_of_boxes(Context& context) {
  // What is reported has nothing to do with where the boxes are: the nearest report wins, whichever comes first.
  const ProbeResult near_box =
      run_probe(context, box_stack(context.device(), {plan_of({{8, 1}}), plan_of({{9, 2}}), plan_of({{10, 3}})}));
  check_box_hit(near_box.reports[0], 0, 8, 1);
  const ProbeResult far_box =
      run_probe(context, box_stack(context.device(), {plan_of({{10, 1}}), plan_of({{9, 2}}), plan_of({{8.5F, 3}})}));
  check_box_hit(far_box.reports[0], 2, 8.5F, 3);
}

void opaque_boxes(Context& context) {
  StackProbe probe = box_stack(context.device(), {plan_of({{6, 1}})}, GeometryFlags::opaque);
  probe.decisions = {Decision::ignore};
  const ProbeResult result = run_probe(context, probe);
  check_box_hit(result.reports[0], 0, 6, 1);
  check_equal("the return value of reportIntersectionEXT", result.outcomes[0].accepted, 1);
  check_equal("any-hit invocations", result.reports[0].any_hits, 0);
}

void without_any_hit_shader(Context& context) {
  StackProbe probe = box_stack(context.device(), {plan_of({{6, 1}})});
  probe.hit_groups = {{.closest_hit = probe::box_closest_hit, .intersection = probe::intersection}};
  const ProbeResult result = run_probe(context, probe);
  check_box_hit(result.reports[0], 0, 6, 1);
  check_equal("the return value of reportIntersectionEXT", result.outcomes[0].accepted, 1);
}

void any_hit_sees_report(Context& context) {
  StackProbe probe = box_stack(context.device(), {plan_of({{6.5F, 77}})});
  probe.hit_groups = {{.any_hit = probe::box_any_hit_report, .intersection = probe::intersection}};
  const Report report = run_probe(context, probe).reports[0];
  check_equal("the shader that reports", report.shader, reporter::any_hit);
  check_equal("gl_HitTEXT", report.hit_t, 6.5F);
  check_equal("gl_RayTmaxEXT", report.t_max, 6.5F);
  check_equal("gl_HitKindEXT", report.hit_kind, 77u);
  for (int i = 0; i < 8; ++i)
    check_equal(fmt::format("hit attribute {}", i), report.attributes[i], expected_attribute(i, 6.5F, 77));
}

void ignored_keeps_committed_attributes(Context& context) {
  // Box 1 is accepted; box 0, which is nearer, is ignored whenever it comes.
  StackProbe probe = box_stack(context.device(), {plan_of({{5.5F, 1}}), plan_of({{6.5F, 2}}), plan_of({{7.5F, 3}})});
  probe.decisions = {Decision::ignore, Decision::accept, Decision::ignore};
  check_box_hit(run_probe(context, probe).reports[0], 1, 6.5F, 2);
}

void terminate_on_first_hit(Context& context) {
  StackProbe probe = box_stack(context.device(), {plan_of({{6, 1}}), plan_of({{7, 2}}), plan_of({{8, 3}})});
  probe.rays[0].flags = ray_flags::terminate_on_first_hit;
  const ProbeResult result = run_probe(context, probe);
  const Report& report = result.reports[0];
  check(report.primitive < 3, "no such primitive");
  check_box_hit(report, report.primitive, 6.0F + static_cast<float>(report.primitive), report.primitive + 1);
  check_equal("any-hit invocations", report.any_hits, 1);
}

void skip_closest_hit(Context& context) {
  StackProbe probe = box_stack(context.device(), {plan_of({{6, 1}})});
  probe.rays[0].flags = ray_flags::skip_closest_hit_shader;
  const ProbeResult result = run_probe(context, probe);
  check_equal("the return value of reportIntersectionEXT", result.outcomes[0].accepted, 1);
  check_equal("the shader that ran last", result.reports[0].shader, reporter::none);
}

void ray_inside_box(Context& context) {
  StackProbe probe = box_stack(context.device(), {plan_of({{0.125F, 1}})});
  probe.rays[0].origin = {0.5F, 0.5F, -0.25F};
  check_box_hit(run_probe(context, probe).reports[0], 0, 0.125F, 1);
}

void beside_triangles(Context& context) {
  // One instance of boxes and one of triangles, whichever is nearer.
  rhi::Device& device = context.device();
  const auto bottom_of_boxes = build_bottom_level(device, {stacked_boxes(device, 1, GeometryFlags::opaque)});
  const auto bottom_of_triangles =
      build_bottom_level(device, {stacked_triangles(device, 1, GeometryFlags::opaque, -1)});
  std::vector<rhi::InstanceDesc> instances = {rhi::make_instance(*bottom_of_boxes),
                                              rhi::make_instance(*bottom_of_triangles)};
  instances[1].sbt_offset = 1;
  Probe probe;
  probe.scene = build_top_level(device, instances);
  probe.hit_groups = {{.closest_hit = probe::box_closest_hit, .intersection = probe::intersection},
                      {.closest_hit = probe::closest_hit}};
  probe.rays = {through_stack()};
  probe.plans = {plan_of({{5.25F, 4}})};
  const Report box = run_probe(context, probe).reports[0];
  check_box_hit(box, 0, 5.25F, 4);
  check_equal("gl_InstanceID", box.instance, 0);
  probe.plans = {plan_of({{6.25F, 4}})};
  const Report triangle = run_probe(context, probe).reports[0];
  check_closest_hit(triangle, 0, 6);
  check_equal("gl_InstanceID", triangle.instance, 1);
  check_equal("gl_HitKindEXT", triangle.hit_kind, 0xFEu);
}

void group_of_geometry(Context& context) {
  // Two geometries, of which only the farther one's group has an any-hit shader that ignores.
  rhi::Device& device = context.device();
  StackProbe probe = box_stack(device, {plan_of({{8, 1}})});
  probe.built = build_scene(
      device, {stacked_boxes(device, 1, GeometryFlags::none), stacked_boxes(device, 1, GeometryFlags::none, -1)});
  probe.scene = probe.built.top_level;
  probe.hit_groups = {
      {.closest_hit = probe::box_closest_hit, .intersection = probe::intersection},
      {.closest_hit = probe::box_closest_hit, .any_hit = probe::box_any_hit, .intersection = probe::intersection}};
  probe.plans.resize(17);
  probe.plans[16] = plan_of({{7, 2}});
  probe.decisions = {Decision::ignore};
  probe.rays[0].record_stride = 1;
  const Report report = run_probe(context, probe).reports[0];
  check_box_hit(report, 0, 8, 1);
  check_equal("gl_GeometryIndexEXT", report.geometry, 0);
}

}  // namespace

void add_pipeline_intersection_cases(Cases& cases) {
  const Group group{.cases = cases,
                    .name = "ray_tracing_pipeline.procedural_geometry",
                    .needs = {&rhi::Capabilities::ray_tracing_pipeline}};
  group.add("report_hit", "t, kind and 32 bytes of attributes of a reported hit reach the closest-hit shader",
            report_hit);
  group.add("hit_kind_ends", "hit kinds 0 and 127 reach the closest-hit shader", hit_kind_ends);
  group.add("no_report", "a box whose shader reports nothing is not hit", no_report);
  group.add("not_run_outside_boxes", "a ray that meets no box misses", not_run_outside_boxes);
  group.add("report_before_t_min", "a report before t_min is refused",
            [](Context& context) { check_window(context, 5, false); });
  group.add("report_behind_t_max", "a report behind t_max is refused",
            [](Context& context) { check_window(context, 5.5F, false); });
  group.add("report_at_t_min", "a report at t_min is accepted",
            [](Context& context) { check_window(context, 5.125F, true); });
  group.add("report_at_t_max", "a report at t_max is accepted",
            [](Context& context) { check_window(context, 5.375F, true); });
  group.add("descending_reports", "each of several reports that come nearer is accepted", descending_reports);
  group.add("ascending_reports", "reports behind an accepted one are refused, and its attributes stay",
            ascending_reports);
  group.add("mixed_reports", "of several reports the nearest wins, with its attributes", mixed_reports);
  group.add("t_max_after_accepted",
            "gl_RayTmaxEXT in an intersection shader is the t that it reported last and nearest", t_max_after_accepted);
  group.add("t_max_after_ignored",
            "gl_RayTmaxEXT in an intersection shader stays when the any-hit shader ignores the report",
            t_max_after_ignored);
  group.add("ignored_returns_false", "reportIntersectionEXT returns false when the any-hit shader ignores the hit",
            ignored_returns_false);
  group.add("terminate_ends_shader", "terminateRayEXT in the any-hit shader ends the intersection shader too",
            terminate_ends_shader);
  group.add("nearest_of_boxes", "the nearest report of several boxes wins, wherever the boxes are", nearest_of_boxes);
  group.add("opaque_boxes", "reports of opaque boxes are accepted without any-hit shader", opaque_boxes);
  group.add("without_any_hit_shader", "reports are accepted where the group has no any-hit shader",
            without_any_hit_shader);
  group.add("any_hit_sees_report", "t, kind and attributes of a reported hit reach the any-hit shader",
            any_hit_sees_report);
  group.add("ignored_keeps_committed_attributes", "ignored reports leave t, kind and attributes of the hit alone",
            ignored_keeps_committed_attributes);
  group.add("terminate_on_first_hit", "with the flag terminate-on-first-hit the first accepted report is the last",
            terminate_on_first_hit);
  group.add("skip_closest_hit", "with the flag skip-closest-hit intersection shaders still run", skip_closest_hit);
  group.add("ray_inside_box", "a ray that begins inside a box meets it", ray_inside_box);
  group.add("beside_triangles", "boxes and triangles of two instances hide each other", beside_triangles);
  group.add("group_of_geometry", "geometries with records of their own have their own shaders", group_of_geometry);
}

}  // namespace tandem::conformance
