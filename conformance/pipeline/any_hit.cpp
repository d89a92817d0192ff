#include "conformance/kit/check.hpp"
#include "conformance/pipeline/cases.hpp"
#include "conformance/pipeline/stack.hpp"

// What any-hit shaders are called for, and what becomes of their answers. Vulkan: "Ray Intersection Candidate
// Determination" and "Any-Hit Shaders": their number and order are not defined, but every candidate nearer than the hit
// committed in the end is offered.
namespace tandem::conformance {
namespace {

using namespace pipeline;
using rhi::GeometryFlags;
using rhi::InstanceFlags;

Report run_one(Context& context, const Probe& probe) { return run(context, probe, "any hit").reports.at(0); }

void accept(Context& context) {
  const StackProbe probe = triangle_stack(context.device(), 4);
  const Report report = run_one(context, probe);
  check_closest_hit(report, 0, 5);
  check((report.any_hit_primitives & 1) != 0, "the any-hit shader did not run for the hit that was committed");
}

void ignore(Context& context) {
  StackProbe probe = triangle_stack(context.device(), 4);
  probe.decisions = {Decision::ignore, Decision::ignore};
  const Report report = run_one(context, probe);
  check_closest_hit(report, 2, 7);
  check_equal("primitives 0 to 2 that were offered", report.any_hit_primitives & 7, 7);
}

void ignore_all(Context& context) {
  StackProbe probe = triangle_stack(context.device(), 4);
  probe.decisions = std::vector<Decision>(4, Decision::ignore);
  check_missed(run_one(context, probe));
}

void ignored_farther_than_accepted(Context& context) {
  StackProbe probe = triangle_stack(context.device(), 8);
  probe.decisions = {Decision::accept, Decision::ignore, Decision::accept, Decision::ignore,
                     Decision::ignore, Decision::ignore, Decision::ignore, Decision::ignore};
  check_closest_hit(run_one(context, probe), 0, 5);
}

void ignored_keeps_committed_attributes(Context& context) {
  // Each triangle is met at other barycentrics: the ray is not parallel to the stack.
  StackProbe probe = triangle_stack(context.device(), 6);
  probe.decisions = {Decision::ignore, Decision::ignore, Decision::accept,
                     Decision::ignore, Decision::ignore, Decision::ignore};
  probe.rays[0].origin = {0.125F, 0.125F, 5};
  probe.rays[0].direction = {0.0625F, 0.03125F, -1};
  const Report report = run_one(context, probe);
  check_closest_hit(report, 2, 7);
  check_close("the first barycentric coordinate", static_cast<double>(report.attributes[0]), 0.125 + 7 * 0.0625, 1.0);
  check_close("the second barycentric coordinate", static_cast<double>(report.attributes[1]), 0.125 + 7 * 0.03125, 1.0);
  check_equal("gl_HitKindEXT", report.hit_kind, 0xFEu);
}

void terminate(Context& context) {
  StackProbe probe = triangle_stack(context.device(), 8);
  probe.decisions = std::vector<Decision>(8, Decision::terminate);
  const Report report = run_one(context, probe);
  check_equal("any-hit invocations", report.any_hits, 1);
  check_equal("the shader that ran last", report.shader, reporter::closest_hit);
  check_equal("the primitive for which it ran, as a bit", report.any_hit_primitives, 1u << report.primitive);
  check_close("t", static_cast<double>(report.hit_t), 5.0 + report.primitive);
}

void terminate_and_skip_closest_hit(Context& context) {
  StackProbe probe = triangle_stack(context.device(), 3);
  probe.decisions = std::vector<Decision>(3, Decision::terminate);
  probe.rays[0].flags = ray_flags::skip_closest_hit_shader;
  const Report report = run_one(context, probe);
  check_equal("any-hit invocations", report.any_hits, 1);
  check_equal("the shader that ran last", report.shader, reporter::none);
}

void every_candidate_offered(Context& context) {
  constexpr std::uint32_t count = 24;
  StackProbe probe = triangle_stack(context.device(), count);
  probe.decisions = std::vector<Decision>(count, Decision::ignore);
  const Report report = run_one(context, probe);
  check_equal("the primitives offered, as bits", report.any_hit_primitives, (1u << count) - 1);
  check(report.any_hits >= count, fmt::format("{} any-hit invocations for {} candidates", report.any_hits, count));
}

void no_duplicates(Context& context) {
  constexpr std::uint32_t count = 24;
  StackProbe probe = triangle_stack(context.device(), count, GeometryFlags::no_duplicate_any_hit);
  probe.decisions = std::vector<Decision>(count, Decision::ignore);
  const Report report = run_one(context, probe);
  check_equal("the primitives offered, as bits", report.any_hit_primitives, (1u << count) - 1);
  check_equal("any-hit invocations", report.any_hits, count);
}

void opaque_geometry_skips(Context& context) {
  StackProbe probe = triangle_stack(context.device(), 3, GeometryFlags::opaque);
  probe.decisions = std::vector<Decision>(3, Decision::ignore);
  const Report report = run_one(context, probe);
  check_closest_hit(report, 0, 5);
  check_equal("any-hit invocations", report.any_hits, 0);
}

void payload_survives_ignore(Context& context) {
  StackProbe probe = triangle_stack(context.device(), 2);
  probe.decisions = {Decision::ignore, Decision::ignore};
  const Report report = run_one(context, probe);
  check_missed(report);
  check(report.any_hits >= 2,
        fmt::format("the payload counts {} any-hit invocations, at least 2 expected", report.any_hits));
}

void outside_t_window_not_offered(Context& context) {
  StackProbe probe = triangle_stack(context.device(), 8);
  probe.decisions = std::vector<Decision>(8, Decision::ignore);
  probe.rays[0].t_min = 6.5F;
  probe.rays[0].t_max = 9.5F;
  const Report report = run_one(context, probe);
  check_missed(report);
  check_equal("the primitives offered, as bits", report.any_hit_primitives, 0b11100u);
}

/// A non-opaque and an opaque geometry in one structure; `opaque_z` is where the opaque triangle lies.
StackProbe beside_opaque(rhi::Device& device, float opaque_z) {
  StackProbe probe = triangle_stack(device, 1);
  probe.built = build_scene(device, {stacked_triangles(device, 3, GeometryFlags::none),
                                     stacked_triangles(device, 1, GeometryFlags::opaque, opaque_z)});
  probe.scene = probe.built.top_level;
  probe.decisions = std::vector<Decision>(3, Decision::ignore);
  return probe;
}

void opaque_behind_ignored(Context& context) {
  const Report report = run_one(context, beside_opaque(context.device(), -7));
  check_closest_hit(report, 0, 12);
  check_equal("gl_GeometryIndexEXT", report.geometry, 1);
  check_equal("the primitives offered, as bits", report.any_hit_primitives, 7u);
}

void opaque_in_front(Context& context) {
  StackProbe probe = beside_opaque(context.device(), 2);
  probe.decisions = std::vector<Decision>(3, Decision::accept);
  const Report report = run_one(context, probe);
  check_closest_hit(report, 0, 3);
  check_equal("gl_GeometryIndexEXT", report.geometry, 1);
}

void without_any_hit_shader(Context& context) {
  StackProbe probe = triangle_stack(context.device(), 3);
  probe.hit_groups = {{.closest_hit = probe::closest_hit}};
  check_closest_hit(run_one(context, probe), 0, 5);
}

void without_closest_hit_shader(Context& context) {
  StackProbe probe = triangle_stack(context.device(), 3);
  probe.hit_groups = {{.any_hit = probe::any_hit}};
  const Report report = run_one(context, probe);
  check_equal("the shader that ran last", report.shader, reporter::none);
  check((report.any_hit_primitives & 1) != 0, "the any-hit shader did not run for the nearest triangle");
}

void own_record(Context& context) {
  // Two geometries with records of their own: every any-hit shader sees the word of its geometry's.
  StackProbe probe = triangle_stack(context.device(), 1);
  rhi::Device& device = context.device();
  probe.built = build_scene(device, {stacked_triangles(device, 1, GeometryFlags::none),
                                     stacked_triangles(device, 1, GeometryFlags::none, -1)});
  probe.scene = probe.built.top_level;
  probe.decisions = {Decision::ignore};
  probe.hit.records = {record_with(0, 1u), record_with(0, 2u)};
  probe.rays[0].record_stride = 1;
  const Report report = run_one(context, probe);
  check_missed(report);
  check_equal("the words of the records, or-ed", report.any_hit_records, 3u);
}

void other_shaders_by_geometry(Context& context) {
  // The nearer geometry's group has an any-hit shader that ignores, the farther one's has none.
  rhi::Device& device = context.device();
  StackProbe probe = triangle_stack(device, 1);
  probe.built = build_scene(device, {stacked_triangles(device, 1, GeometryFlags::none),
                                     stacked_triangles(device, 1, GeometryFlags::none, -1)});
  probe.scene = probe.built.top_level;
  probe.hit_groups = {{.closest_hit = probe::closest_hit, .any_hit = probe::any_hit},
                      {.closest_hit = probe::closest_hit}};
  probe.decisions = {Decision::ignore};
  probe.rays[0].record_stride = 1;
  const Report report = run_one(context, probe);
  check_closest_hit(report, 0, 6);
  check_equal("gl_GeometryIndexEXT", report.geometry, 1);
}

void terminate_on_first_hit_flag(Context& context) {
  StackProbe probe = triangle_stack(context.device(), 8);
  probe.decisions = {Decision::ignore, Decision::ignore};
  probe.rays[0].flags = ray_flags::terminate_on_first_hit;
  const Report report = run_one(context, probe);
  check_equal("the shader that ran last", report.shader, reporter::closest_hit);
  check(report.primitive >= 2, fmt::format("primitive {} was committed although it was ignored", report.primitive));
  const std::uint32_t accepted = report.any_hit_primitives & ~3u;
  check_equal("the accepted primitives that were offered, as bits", accepted, 1u << report.primitive);
}

/// An any-hit shader that leaves from a function called by a function, for primitive 0 only.
std::string leaving_from_nested(const std::string& statement) {
  const std::string head = probe::any_hit.substr(0, probe::any_hit.rfind("void main()"));
  return head + R"(
void leave(uint decision) {
  if (decision != 0u) )" +
         statement + R"(;
  report.any_hit_records |= 256u;
}
uint middle(uint decision) {
  leave(decision);
  report.any_hit_records |= 512u;
  return decision;
}
void main() {
  ++report.any_hits;
  report.any_hit_primitives |= 1u << uint(gl_PrimitiveID);
  report.any_hit_records |= record.word;
  if (middle(decisions[gl_PrimitiveID]) != 0u) report.any_hit_records |= 1024u;
}
)";
}

void ignore_in_nested_function(Context& context) {
  StackProbe probe = triangle_stack(context.device(), 2);
  probe.hit_groups = {{.closest_hit = probe::closest_hit, .any_hit = leaving_from_nested("ignoreIntersectionEXT")}};
  probe.decisions = {Decision::ignore, Decision::ignore};
  const Report report = run_one(context, probe);
  check_missed(report);
  check_equal("the primitives offered, as bits", report.any_hit_primitives, 3u);
  check_equal("what the statements before and after left behind", report.any_hit_records, first_hit_word);
}

void terminate_in_nested_function(Context& context) {
  StackProbe probe = triangle_stack(context.device(), 4);
  probe.hit_groups = {{.closest_hit = probe::closest_hit, .any_hit = leaving_from_nested("terminateRayEXT")}};
  probe.decisions = std::vector<Decision>(4, Decision::terminate);
  const Report report = run_one(context, probe);
  check_equal("the shader that ran last", report.shader, reporter::closest_hit);
  check_equal("any-hit invocations", report.any_hits, 1);
  check_equal("what the statements before and after left behind", report.any_hit_records, first_hit_word);
}

struct Opacity {
  std::string_view name;
  std::string_view behaviour;
  GeometryFlags geometry;
  InstanceFlags instance;
  std::uint32_t ray;
  bool any_hit;
};
constexpr Opacity opacities[] = {
    {"instance_forces_no_opaque", "an instance that forces no-opaque overrides an opaque geometry",
     GeometryFlags::opaque, InstanceFlags::force_no_opaque, 0, true},
    {"instance_forces_opaque", "an instance that forces opaque overrides a geometry that is not opaque",
     GeometryFlags::none, InstanceFlags::force_opaque, 0, false},
    {"ray_forces_no_opaque", "the ray flag no-opaque overrides an opaque geometry", GeometryFlags::opaque,
     InstanceFlags::none, ray_flags::no_opaque, true},
    {"ray_forces_opaque", "the ray flag opaque overrides a geometry that is not opaque", GeometryFlags::none,
     InstanceFlags::none, ray_flags::opaque, false},
    {"ray_overrides_instance_no_opaque", "the ray flag no-opaque overrides an instance that forces opaque",
     GeometryFlags::opaque, InstanceFlags::force_opaque, ray_flags::no_opaque, true},
    {"ray_overrides_instance_opaque", "the ray flag opaque overrides an instance that forces no-opaque",
     GeometryFlags::none, InstanceFlags::force_no_opaque, ray_flags::opaque, false},
};

void check_opacity(Context& context, const Opacity& opacity) {
  StackProbe probe = triangle_stack(context.device(), 2, opacity.geometry, opacity.instance);
  probe.decisions = {Decision::ignore, Decision::accept};
  probe.rays[0].flags = opacity.ray;
  const Report report = run_one(context, probe);
  if (opacity.any_hit) {
    check_closest_hit(report, 1, 6);
    check_equal("the primitives offered, as bits", report.any_hit_primitives, 3u);
  } else {
    check_closest_hit(report, 0, 5);
    check_equal("any-hit invocations", report.any_hits, 0);
  }
}

}  // namespace

void add_pipeline_any_hit_cases(Cases& cases) {
  const Group group{
      .cases = cases, .name = "ray_tracing_pipeline.any_hit", .needs = {&rhi::Capabilities::ray_tracing_pipeline}};
  group.add("accept", "the nearest of the accepted candidates is the closest hit", accept);
  group.add("ignore", "an ignored candidate is no hit, and the next behind it is offered", ignore);
  group.add("ignore_all", "a ray whose candidates are all ignored misses", ignore_all);
  group.add("ignored_farther_than_accepted", "candidates ignored behind the hit change nothing",
            ignored_farther_than_accepted);
  group.add("ignored_keeps_committed_attributes", "ignored candidates leave t, kind and attributes of the hit alone",
            ignored_keeps_committed_attributes);
  group.add("terminate", "terminateRayEXT accepts its candidate, and no further any-hit shader runs", terminate);
  group.add("terminate_and_skip_closest_hit", "after terminateRayEXT the flag skip-closest-hit still holds",
            terminate_and_skip_closest_hit);
  group.add("every_candidate_offered", "every candidate is offered at least once", every_candidate_offered);
  group.add("no_duplicates", "a geometry with no-duplicate-any-hit offers every candidate exactly once", no_duplicates);
  group.add("opaque_geometry_skips", "no any-hit shader runs for an opaque geometry", opaque_geometry_skips);
  group.add("payload_survives_ignore",
            "what an any-hit shader writes to the payload stays, though it ignores its candidate",
            payload_survives_ignore);
  group.add("outside_t_window_not_offered", "candidates outside of (t_min, t_max) are not offered",
            outside_t_window_not_offered);
  group.add("opaque_behind_ignored", "an opaque triangle is hit behind candidates that are ignored",
            opaque_behind_ignored);
  group.add("opaque_in_front", "an opaque triangle in front of accepted candidates is the closest hit",
            opaque_in_front);
  group.add("without_any_hit_shader", "a group without any-hit shader accepts every candidate", without_any_hit_shader);
  group.add("without_closest_hit_shader", "a group may have an any-hit shader alone", without_closest_hit_shader);
  group.add("own_record", "an any-hit shader reads the record of its geometry", own_record);
  group.add("other_shaders_by_geometry", "geometries with records of their own have their own any-hit shaders",
            other_shaders_by_geometry);
  group.add("terminate_on_first_hit_flag",
            "with the flag terminate-on-first-hit the first accepted candidate is the last",
            terminate_on_first_hit_flag);
  group.add("ignore_in_nested_function", "ignoreIntersectionEXT in a function ends the whole shader",
            ignore_in_nested_function);
  group.add("terminate_in_nested_function", "terminateRayEXT in a function ends the whole shader",
            terminate_in_nested_function);
  for (const Opacity& opacity : opacities)
    group.add("opacity_" + std::string(opacity.name), std::string(opacity.behaviour),
              [opacity](Context& context) { check_opacity(context, opacity); });
}

}  // namespace tandem::conformance
