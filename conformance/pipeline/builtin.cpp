#include <algorithm>
#include <functional>
#include <glm/geometric.hpp>
#include <utility>

#include "conformance/kit/check.hpp"
#include "conformance/pipeline/builtin_scene.hpp"
#include "conformance/pipeline/cases.hpp"

// Every built-in of every stage that has it. Vulkan: "Built-In Variables"; GLSL_EXT_ray_tracing: "Built-In Variables".
namespace tandem::conformance {
namespace {

using namespace pipeline;

/// A shader that reports.
enum class Reporter { closest_hit, any_hit, intersection, miss };

constexpr std::pair<Reporter, std::string_view> reporters[] = {{Reporter::closest_hit, "closest_hit"},
                                                               {Reporter::any_hit, "any_hit"},
                                                               {Reporter::intersection, "intersection"},
                                                               {Reporter::miss, "miss"}};

using CheckReport = std::function<void(const ExpectedHit&, const Report&, std::uint32_t ray)>;

/// Traces every ray of the builtin scene with shaders of which one reports, and checks each report.
void check_reports(Context& context, Reporter reporter, const CheckReport& check_report) {
  const bool by_box = reporter == Reporter::intersection;
  const rhi::GeometryFlags geometry_flags =
      reporter == Reporter::any_hit ? rhi::GeometryFlags::none : rhi::GeometryFlags::opaque;
  BuiltinScene scene =
      builtin_scene(context.device(), by_box ? PrimitiveKind::boxes : PrimitiveKind::triangles, geometry_flags);
  // Flags that change nothing here, so that there are bits to see.
  for (ExpectedHit& hit : scene.hits)
    hit.ray.flags = ray_flags::terminate_on_first_hit |
                    (reporter == Reporter::any_hit ? ray_flags::cull_opaque : ray_flags::cull_no_opaque);
  Probe probe;
  probe.scene = scene.scene.top_level;
  probe.rays = rays_of(scene);
  std::uint32_t expected_shader = reporter::closest_hit;
  HitGroupText group = {.closest_hit = probe::closest_hit};
  if (reporter == Reporter::any_hit) {
    group = {.any_hit = probe::any_hit_report};
    expected_shader = reporter::any_hit;
  } else if (reporter == Reporter::intersection) {
    group = {.intersection = probe::intersection_report};
    expected_shader = reporter::intersection;
  } else if (reporter == Reporter::miss) {
    for (TracedRay& ray : probe.rays) ray.mask = 0;
    expected_shader = reporter::miss;
  }
  probe.hit_groups = {group};
  const ProbeResult result = run(context, probe, "builtin");
  const std::vector<Report>& reports = by_box ? result.intersections : result.reports;
  for (std::uint32_t i = 0; i < scene.hits.size(); ++i) {
    check_equal(fmt::format("the shader that reports ray {}", i), reports[i].shader, expected_shader);
    check_report(scene.hits[i], reports[i], i);
  }
}

void check_vector(std::string_view what, const float (&seen)[3], const glm::dvec3& expected) {
  for (int i = 0; i < 3; ++i)
    check_close(fmt::format("{}[{}]", what, i), static_cast<double>(seen[i]), expected[i], glm::length(expected) + 1.0);
}

void check_same_vector(std::string_view what, const float (&seen)[3], const glm::vec3& expected) {
  for (int i = 0; i < 3; ++i) check_equal(fmt::format("{}[{}]", what, i), seen[i], expected[i]);
}

void check_object_to_world(const ExpectedHit& hit, const float (&seen)[12]) {
  for (std::size_t i = 0; i < 12; ++i)
    check_equal(fmt::format("row {}, column {}", i / 4, i % 4), seen[i], hit.object_to_world[i]);
}

void check_world_to_object(const ExpectedHit& hit, const float (&seen)[12]) {
  const glm::dvec3 translation = -(hit.world_to_object_linear * hit.translation);
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column)
      check_close(fmt::format("row {}, column {}", row, column), static_cast<double>(seen[row * 4 + column]),
                  hit.world_to_object_linear[column][row], 1.0);
    check_close(fmt::format("row {}, column 3", row), static_cast<double>(seen[row * 4 + 3]), translation[row],
                glm::length(translation) + 1.0);
  }
}

struct Builtin {
  std::string name;
  std::string variable;
  std::vector<Reporter> stages;
  CheckReport check_report;
};

std::vector<Builtin> builtins() {
  using R = Reporter;
  const std::vector<R> all = {R::closest_hit, R::any_hit, R::intersection, R::miss};
  const std::vector<R> hits = {R::closest_hit, R::any_hit, R::intersection};
  const std::vector<R> after_hit = {R::closest_hit, R::any_hit};
  return {
      {"launch_id", "gl_LaunchIDEXT", all,
       [](const ExpectedHit&, const Report& report, std::uint32_t ray) {
         check_equal("gl_LaunchIDEXT.x", report.launch_id[0], ray);
         check_equal("gl_LaunchIDEXT.y", report.launch_id[1], 0);
         check_equal("gl_LaunchIDEXT.z", report.launch_id[2], 0);
       }},
      {"launch_size", "gl_LaunchSizeEXT", all,
       [](const ExpectedHit& hit, const Report& report, std::uint32_t) {
         check_equal("gl_LaunchSizeEXT.x", report.launch_size[0], hit.launch_size);
         check_equal("gl_LaunchSizeEXT.y", report.launch_size[1], 1);
         check_equal("gl_LaunchSizeEXT.z", report.launch_size[2], 1);
       }},
      {"primitive_id", "gl_PrimitiveID", hits,
       [](const ExpectedHit& hit, const Report& report, std::uint32_t) {
         check_equal("gl_PrimitiveID", report.primitive, hit.primitive);
       }},
      {"instance_id", "gl_InstanceID", hits,
       [](const ExpectedHit& hit, const Report& report, std::uint32_t) {
         check_equal("gl_InstanceID", report.instance, hit.instance);
       }},
      {"instance_custom_index", "gl_InstanceCustomIndexEXT", hits,
       [](const ExpectedHit& hit, const Report& report, std::uint32_t) {
         check_equal("gl_InstanceCustomIndexEXT", report.custom_index, hit.custom_index);
       }},
      {"geometry_index", "gl_GeometryIndexEXT", hits,
       [](const ExpectedHit& hit, const Report& report, std::uint32_t) {
         check_equal("gl_GeometryIndexEXT", report.geometry, hit.geometry);
       }},
      {"world_ray_origin", "gl_WorldRayOriginEXT", all,
       [](const ExpectedHit& hit, const Report& report, std::uint32_t) {
         check_same_vector("gl_WorldRayOriginEXT", report.world_origin, hit.ray.origin);
       }},
      {"world_ray_direction", "gl_WorldRayDirectionEXT", all,
       [](const ExpectedHit& hit, const Report& report, std::uint32_t) {
         check_same_vector("gl_WorldRayDirectionEXT", report.world_direction, hit.ray.direction);
       }},
      {"object_ray_origin", "gl_ObjectRayOriginEXT", hits,
       [](const ExpectedHit& hit, const Report& report, std::uint32_t) {
         check_vector("gl_ObjectRayOriginEXT", report.object_origin, hit.object_origin);
       }},
      {"object_ray_direction", "gl_ObjectRayDirectionEXT", hits,
       [](const ExpectedHit& hit, const Report& report, std::uint32_t) {
         check_vector("gl_ObjectRayDirectionEXT", report.object_direction, hit.object_direction);
       }},
      {"ray_t_min", "gl_RayTminEXT", all,
       [](const ExpectedHit& hit, const Report& report, std::uint32_t) {
         check_equal("gl_RayTminEXT", report.t_min, hit.ray.t_min);
       }},
      {"ray_t_max", "gl_RayTmaxEXT, the hit's t", after_hit,
       [](const ExpectedHit& hit, const Report& report, std::uint32_t) {
         check_close("gl_RayTmaxEXT", static_cast<double>(report.t_max), hit.t);
       }},
      {"ray_t_max",
       "gl_RayTmaxEXT, the t of traceRayEXT while nothing is hit",
       {R::intersection, R::miss},
       [](const ExpectedHit& hit, const Report& report, std::uint32_t) {
         check_equal("gl_RayTmaxEXT", report.t_max, hit.ray.t_max);
       }},
      {"hit_t", "gl_HitTEXT", after_hit,
       [](const ExpectedHit& hit, const Report& report, std::uint32_t) {
         check_close("gl_HitTEXT", static_cast<double>(report.hit_t), hit.t);
       }},
      {"hit_kind_of_triangles", "gl_HitKindEXT", after_hit,
       [](const ExpectedHit& hit, const Report& report, std::uint32_t) {
         check_equal("gl_HitKindEXT", report.hit_kind, hit.front_face ? 0xFEu : 0xFFu);
       }},
      {"barycentrics", "hitAttributeEXT vec2", after_hit,
       [](const ExpectedHit& hit, const Report& report, std::uint32_t) {
         // A coordinate's error comes from those of the triangle's vertices, up to 8 here.
         check_close("the first barycentric coordinate", static_cast<double>(report.attributes[0]), hit.barycentrics.x,
                     8.0);
         check_close("the second barycentric coordinate", static_cast<double>(report.attributes[1]), hit.barycentrics.y,
                     8.0);
       }},
      {"object_to_world", "gl_ObjectToWorldEXT", hits,
       [](const ExpectedHit& hit, const Report& report, std::uint32_t) {
         check_object_to_world(hit, report.object_to_world);
       }},
      {"object_to_world_3x4", "gl_ObjectToWorld3x4EXT", hits,
       [](const ExpectedHit& hit, const Report& report, std::uint32_t) {
         check_object_to_world(hit, report.object_to_world_3x4);
       }},
      {"world_to_object", "gl_WorldToObjectEXT", hits,
       [](const ExpectedHit& hit, const Report& report, std::uint32_t) {
         check_world_to_object(hit, report.world_to_object);
       }},
      {"world_to_object_3x4", "gl_WorldToObject3x4EXT", hits,
       [](const ExpectedHit& hit, const Report& report, std::uint32_t) {
         check_world_to_object(hit, report.world_to_object_3x4);
       }},
      {"incoming_ray_flags", "gl_IncomingRayFlagsEXT", all,
       [](const ExpectedHit& hit, const Report& report, std::uint32_t) {
         check_equal("gl_IncomingRayFlagsEXT", report.flags, hit.ray.flags);
       }},
  };
}

}  // namespace

void add_pipeline_builtin_cases(Cases& cases) {
  for (const Builtin& builtin : builtins())
    for (const auto& [reporter, stage] : reporters) {
      if (std::find(builtin.stages.begin(), builtin.stages.end(), reporter) == builtin.stages.end()) continue;
      cases.push_back({.name = fmt::format("ray_tracing_pipeline.builtin.{}_in_{}", builtin.name, stage),
                       .behaviour = fmt::format("{} in a {} shader", builtin.variable, stage),
                       .needs = {&rhi::Capabilities::ray_tracing_pipeline},
                       .run = [builtin, reporter = reporter](Context& context) {
                         check_reports(context, reporter, builtin.check_report);
                       }});
    }
}

}  // namespace tandem::conformance
