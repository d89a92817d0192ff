#include <array>
#include <random>

#include "conformance/kit/check.hpp"
#include "conformance/pipeline/cases.hpp"
#include "conformance/pipeline/stack.hpp"
#include "conformance/ray_query/probe.hpp"

// Ray queries inside of ray tracing stages, and the same rays in both forms.
namespace tandem::conformance {
namespace {

/// Numbers in [0, 1) that are the same on every machine.
class Random {
 public:
  explicit Random(std::uint32_t seed) : engine_(seed) {}
  float next() { return static_cast<float>(engine_() >> 8) * 0x1p-24F; }
  glm::vec3 next_in(float low, float high) {
    const float x = next();
    const float y = next();
    const float z = next();
    return glm::vec3(x, y, z) * (high - low) + low;
  }

 private:
  std::mt19937 engine_;
};

constexpr std::uint32_t triangles_per_geometry = 24;

struct RandomScene {
  rhi::AccelerationStructureHandle bottom_level;
  rhi::AccelerationStructureHandle top_level;
};

/// Three instances, one mirrored and one scaled and sheared, of two geometries of large random triangles.
RandomScene random_scene(rhi::Device& device, rhi::GeometryFlags flags, Random& random) {
  std::vector<rhi::Geometry> geometries;
  for (int geometry = 0; geometry < 2; ++geometry) {
    std::vector<glm::vec3> vertices;
    for (std::uint32_t i = 0; i < triangles_per_geometry; ++i) {
      const glm::vec3 place = random.next_in(-2, 2);
      for (int corner = 0; corner < 3; ++corner) vertices.push_back(place + random.next_in(-1, 1));
    }
    geometries.emplace_back(triangles(device, vertices, flags));
  }
  RandomScene scene;
  scene.bottom_level = build_bottom_level(device, std::move(geometries));
  const std::array<Transform, 3> transforms = {
      identity, Transform{-1, 0, 0, 0.5F, 0, 1, 0, -0.25F, 0, 0, 1, 1},
      Transform{0.5F, 0.25F, 0, -1, -0.25F, 1.5F, 0.125F, 0.5F, 0, 0.5F, 0.75F, 0}};
  std::vector<rhi::InstanceDesc> instances;
  for (const Transform& transform : transforms) instances.push_back(rhi::make_instance(*scene.bottom_level, transform));
  scene.top_level = build_top_level(device, instances);
  return scene;
}

/// Traces the same random rays through a pipeline and through ray queries. Of each geometry the triangles for which
/// `ignored` holds are ignored.
template <typename Ignored>
void compare_forms(Context& context, rhi::GeometryFlags flags, std::uint32_t flags_of_rays, const Ignored& ignored) {
  Random random(20250607);
  const RandomScene scene = random_scene(context.device(), flags, random);
  pipeline::Probe probe;
  probe.scene = scene.top_level;
  std::vector<Decision> decisions;
  for (std::uint32_t primitive = 0; primitive < triangles_per_geometry; ++primitive) {
    const bool ignore = ignored(primitive);
    probe.decisions.push_back(ignore ? pipeline::Decision::ignore : pipeline::Decision::accept);
    if (ignore) decisions.push_back({.actions = action::skip, .primitive = primitive});
  }
  decisions.push_back({.actions = action::confirm});
  std::vector<Ray> rays(1000);
  for (Ray& ray : rays) {
    ray.origin = random.next_in(-3, 3);
    ray.direction = random.next_in(-1, 1);
    ray.t_max = 2 + 10 * random.next();
    ray.flags = flags_of_rays;
    ray.decisions = decisions;
    probe.rays.push_back(
        {.origin = ray.origin, .t_min = ray.t_min, .direction = ray.direction, .t_max = ray.t_max, .flags = ray.flags});
  }
  const std::vector<pipeline::Report> reports = run(context, probe, "both forms").reports;
  const std::vector<Traversal> traversals = trace(context, scene.top_level, rays);
  std::size_t hit_count = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const pipeline::Report& report = reports[i];
    const Intersection& query = traversals[i].committed;
    const std::string name = fmt::format("ray {}", i);
    check_equal(name + ": the pipeline's hit", report.shader == pipeline::reporter::closest_hit, traversals[i].hit());
    if (!traversals[i].hit()) continue;
    ++hit_count;
    check_equal(name + ": the pipeline's instance", report.instance, query.instance);
    check_equal(name + ": the pipeline's geometry", report.geometry, query.geometry);
    check_equal(name + ": the pipeline's primitive", report.primitive, query.primitive);
    check_equal(name + ": the pipeline's front face", report.hit_kind == 0xFE, query.front_face != 0);
    check_close(name + ": the pipeline's t", static_cast<double>(report.hit_t), static_cast<double>(query.t));
    for (int k = 0; k < 2; ++k)
      check_close(fmt::format("{}: the pipeline's barycentric coordinate {}", name, k),
                  static_cast<double>(report.attributes[k]), static_cast<double>(query.barycentrics[k]), 1.0);
  }
  check(hit_count > 50 && hit_count < 950, fmt::format("{} of {} rays hit: they test little", hit_count, rays.size()));
}

const std::string query_in_stage = R"(
bool meets(float x, float z) {
  rayQueryEXT query;
  rayQueryInitializeEXT(query, scene, 0u, 0xffu, vec3(x, 0.25, z), 0.0, vec3(0.0, 0.0, -1.0), 100.0);
  while (rayQueryProceedEXT(query)) rayQueryConfirmIntersectionEXT(query);
  return rayQueryGetIntersectionTypeEXT(query, true) == gl_RayQueryCommittedIntersectionTriangleEXT;
}
)";

void query_in_stages(Context& context) {
  const std::string head =
      "#extension GL_EXT_ray_query : require\n"
      "layout(set = 0, binding = 0) uniform accelerationStructureEXT scene;\n" +
      query_in_stage;
  const std::string in = head + "layout(location = 0) rayPayloadInEXT uint payload;\n";
  const std::string adds_queries =
      "void main() { payload += (meets(0.25, -1.5) ? 10u : 0u) + (meets(-9.0, 5.0) ? 100u : 0u); }\n";
  const pipeline::PipelineText text = {.ray_generation = {head + R"(
layout(set = 0, binding = 1, std430) writeonly buffer Results { uint results[]; };
layout(location = 0) rayPayloadEXT uint payload;
void main() {
  for (uint i = 0u; i < 2u; ++i) {
    payload = (meets(0.25, 5.0) ? 1u : 0u) + (meets(0.25, -9.0) ? 2u : 0u);
    traceRayEXT(scene, 0u, 0xffu, 0u, 0u, 0u, vec3(i == 0u ? 0.25 : -9.0, 0.25, 5.0), 0.0, vec3(0.0, 0.0, -1.0), 100.0,
                0);
    results[i] = payload;
  }
}
)"},
                                       .miss = {in + adds_queries},
                                       .hit_groups = {{.closest_hit = in + adds_queries}}};
  const Scene scene =
      build_scene(context.device(), {pipeline::stacked_triangles(context.device(), 3, rhi::GeometryFlags::none)});
  pipeline::Launch launch;
  launch.scene = scene.top_level;
  const auto results = pipeline::results_of<std::uint32_t>(context, text, launch, 2, "query in stages");
  check_equal("what the queries of ray generation and closest-hit shader met", results[0], 11u);
  check_equal("what the queries of ray generation and miss shader met", results[1], 11u);
}

}  // namespace

void add_pipeline_against_query_cases(Cases& cases) {
  using Caps = rhi::Capabilities;
  const Group group{.cases = cases,
                    .name = "ray_tracing_pipeline.with_ray_query",
                    .needs = {&Caps::ray_tracing_pipeline, &Caps::ray_query}};
  group.add("in_stages", "ray generation, closest-hit and miss shaders make ray queries", query_in_stages);
  const auto none = [](std::uint32_t) { return false; };
  const auto odd = [](std::uint32_t primitive) { return primitive % 2 == 1; };
  group.add("same_hits_opaque", "random rays meet the same triangles in both forms",
            [none](Context& context) { compare_forms(context, rhi::GeometryFlags::opaque, 0, none); });
  group.add("same_hits_ignoring", "both forms find the same hits behind candidates that are ignored",
            [odd](Context& context) { compare_forms(context, rhi::GeometryFlags::none, 0, odd); });
  group.add("same_hits_culling", "both forms leave out the same faces", [odd](Context& context) {
    compare_forms(context, rhi::GeometryFlags::none, ray_flags::cull_back_facing, odd);
  });
}

}  // namespace tandem::conformance
