#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <random>
#include <span>

#include "conformance/kit/cases.hpp"
#include "conformance/kit/check.hpp"
#include "conformance/kit/reference.hpp"
#include "conformance/ray_query/probe.hpp"

/// ray_query.procedural_geometry and ray_query.inside_aabbs: boxes, whose hits a shader generates. A box may be offered
/// to a ray that passes beside it, so no case forbids that.
namespace tandem::conformance {
namespace {

using rhi::GeometryFlags;

// The box from z = 0 to 1 and the one from z = 2 to 3; a ray that falls from z = 5 is in them from t = 4 and from t
// = 2.
rhi::Geometry two_boxes(rhi::Device& device) { return boxes(device, {{{0, 0, 0}, {1, 1, 1}}, {{0, 0, 2}, {1, 1, 3}}}); }

Traversal fall(Context& context, std::vector<rhi::Geometry> geometries, std::vector<Decision> decisions) {
  const Scene scene = build_scene(context.device(), std::move(geometries));
  return trace(context, scene.top_level, Ray{.decisions = std::move(decisions)});
}

Decision generate_at(float t, std::uint32_t primitive = any) {
  return {.actions = action::generate, .primitive = primitive, .t = t};
}

void check_offered(const Traversal& seen, std::uint32_t primitive = 0) {
  for (const Intersection& candidate : seen.candidates)
    if (candidate.type == candidate_type::box && candidate.primitive == primitive) return;
  throw Failure(fmt::format("box {} is not offered", primitive));
}

void add_generate_cases(const Group& group) {
  group.add("generate", "a generated hit is committed with the box's ids and exactly its t", [](Context& context) {
    check_generated("the ray", fall(context, {two_boxes(context.device())}, {generate_at(4.3f, 0)}), {.primitive = 0},
                    4.3f);
  });
  group.add("skip", "a box for which no hit is generated is not committed", [](Context& context) {
    const Traversal seen = fall(context, {two_boxes(context.device())}, {});
    check_miss("the ray", seen);
    check_offered(seen, 0);
    check_offered(seen, 1);
  });
  group.add("opaque_box_is_candidate", "a box is offered even where its geometry is opaque", [](Context& context) {
    check_offered(fall(context, {boxes(context.device(), {Box{}}, GeometryFlags::opaque)}, {}));
  });
  group.add("generate_one_of_two", "a hit is generated in one box only, and that is committed", [](Context& context) {
    for (const std::uint32_t chosen : {0u, 1u}) {
      const float t = chosen == 0 ? 4.5f : 2.5f;
      check_generated("the ray", fall(context, {two_boxes(context.device())}, {generate_at(t, chosen)}),
                      {.primitive = chosen}, t);
    }
  });
  group.add("generate_in_both", "of hits generated in two boxes the nearer is committed", [](Context& context) {
    check_generated("the ray",
                    fall(context, {two_boxes(context.device())}, {generate_at(4.5f, 0), generate_at(2.5f, 1)}),
                    {.primitive = 1}, 2.5f);
  });
  group.add("generate_nearer", "a second, nearer hit in the same box replaces the first", [](Context& context) {
    const Decision both = {.actions = action::generate | action::generate_second, .t = 4.5f, .second_t = 4.25f};
    check_generated("the ray", fall(context, {boxes(context.device(), {Box{}})}, {both}), {}, 4.25f);
  });
  group.add("generate_commits_at_once", "what is generated is committed before the next proceed", [](Context& context) {
    const Traversal seen = fall(context, {boxes(context.device(), {Box{}})}, {generate_at(4.5f)});
    check_offered(seen);
    check_equal("the committed type after generating", seen.candidates[0].committed_type_after,
                committed_type::generated);
    check_equal("the committed t after generating", seen.candidates[0].committed_t_after, 4.5f);
  });
  group.add("generate_then_terminate", "what was generated before the query was terminated stays committed",
            [](Context& context) {
              const Decision decision = {.actions = action::generate | action::terminate, .t = 4.5f};
              const Traversal seen = fall(context, {boxes(context.device(), {Box{}, Box{}})}, {decision});
              check_equal("the number of candidates", seen.candidate_count, 1u);
              check_equal("the committed type", seen.committed.type, committed_type::generated);
              check_equal("t", seen.committed.t, 4.5f);
            });
  for (const bool at_end : {false, true}) {
    group.add(at_end ? "generate_at_t_max" : "generate_at_t_min",
              at_end ? "a hit may be generated at the ray's t_max" : "a hit may be generated at the ray's t_min",
              [at_end](Context& context) {
                const Scene scene = build_scene(context.device(), {boxes(context.device(), {Box{}})});
                const Ray ray = {.t_min = 4.25f, .t_max = 4.75f, .decisions = {generate_at(at_end ? 4.75f : 4.25f)}};
                check_generated("the ray", trace(context, scene.top_level, ray), {}, at_end ? 4.75f : 4.25f);
              });
  }
  group.add("second_geometry", "boxes are numbered within their geometry", [](Context& context) {
    rhi::Device& device = context.device();
    const std::vector<rhi::Geometry> geometries = {boxes(device, {{{8, 8, 8}, {9, 9, 9}}}),
                                                   boxes(device, {{{6, 6, 6}, {7, 7, 7}}, Box{}})};
    check_generated("the ray", fall(context, geometries, {generate_at(4.5f)}), {.geometry = 1, .primitive = 1}, 4.5f);
  });
  group.add("many_boxes", "each of 4096 boxes is found by a ray of its own", [](Context& context) {
    std::vector<Box> grid;
    std::vector<Ray> rays;
    for (std::uint32_t i = 0; i < 4096; ++i) {
      const glm::vec3 corner(2.0f * static_cast<float>(i % 64), 2.0f * static_cast<float>(i / 64), 0);
      grid.push_back({corner, corner + glm::vec3(1)});
      rays.push_back({.origin = corner + glm::vec3(0.5f, 0.5f, 5), .decisions = {generate_at(4.5f, i)}});
    }
    const Scene scene = build_scene(context.device(), {boxes(context.device(), grid)});
    const std::vector<Traversal> seen = trace(context, scene.top_level, rays);
    for (std::uint32_t i = 0; i < rays.size(); ++i)
      check_generated(fmt::format("ray {}", i), seen[i], {.primitive = i}, 4.5f);
  });
}

/// A triangle at z = 2 in one instance and a box from z = 0 to 3 in another.
Traversal fall_on_both(Context& context, float generated_t) {
  rhi::Device& device = context.device();
  const rhi::AccelerationStructureHandle triangle =
      build_bottom_level(device, {triangles(device, triangle_at({0, 0, 2}))});
  const rhi::AccelerationStructureHandle box = build_bottom_level(device, {boxes(device, {{{0, 0, 0}, {1, 1, 3}}})});
  const rhi::AccelerationStructureHandle scene =
      build_top_level(device, {rhi::make_instance(*triangle), rhi::make_instance(*box)});
  return trace(context, scene, Ray{.decisions = {generate_at(generated_t)}});
}

void add_mixed_cases(const Group& group) {
  group.add("hit_before_triangle", "a hit generated in front of an opaque triangle is committed",
            [](Context& context) { check_generated("the ray", fall_on_both(context, 2.5f), {.instance = 1}, 2.5f); });
  group.add("hit_behind_triangle", "a hit that would lie behind an opaque triangle leaves the triangle committed",
            [](Context& context) { check_triangle("the ray", fall_on_both(context, 4.5f), {.instance = 0}, 3); });
}

void add_inside_cases(const Group& group) {
  const auto add = [&](const char* name, const char* behaviour, const Box& box, const Ray& ray) {
    group.add(name, behaviour, [=](Context& context) {
      const Scene scene = build_scene(context.device(), {boxes(context.device(), {box})});
      Ray deciding = ray;
      const float t = 0.5f * (ray.t_min + ray.t_max);
      deciding.decisions = {generate_at(t)};
      const Traversal seen = trace(context, scene.top_level, deciding);
      check_offered(seen);
      check_generated("the ray", seen, {}, t);
    });
  };
  const Box large = {{-10, -10, -10}, {10, 10, 10}};
  add("origin_inside", "a ray that begins in a box is offered the box", large, {.origin = {1, 2, 3}});
  add("segment_inside", "a ray that begins and ends in a box is offered the box", large,
      {.origin = {1, 2, 3}, .t_max = 0.125f});
  add("segment_with_t_min_inside", "a ray whose t_min and t_max are both in the box is offered the box", large,
      {.origin = {0, 0, 20}, .t_min = 15, .t_max = 16});
  add("leaves_box", "a ray that begins in a box and leaves it is offered the box", large,
      {.origin = {9, 9, 9}, .direction = {1, 1, 1}});
  add("diagonal_inside", "a ray along the diagonal from the centre is offered the box", large,
      {.origin = {0, 0, 0}, .direction = {-1, -1, -1}, .t_max = 1});
  add("enters_box", "a ray that ends in a box is offered the box", large, {.origin = {0, 0, 11}, .t_max = 2});
}

void add_flat_cases(const Group& group) {
  constexpr const char* names[] = {"flat_in_x", "flat_in_y", "flat_in_z"};
  for (int axis = 0; axis < 3; ++axis) {
    group.add(names[axis], "a box without thickness is offered to a ray through its inside", [axis](Context& context) {
      Box box = {{0, 0, 0}, {1, 1, 1}};
      box.minimum[axis] = box.maximum[axis] = 0.5f;
      Ray ray = {.origin = glm::vec3(0.3f), .direction = glm::vec3(0), .decisions = {generate_at(2.5f)}};
      ray.origin[axis] = 3;
      ray.direction[axis] = -1;
      const Scene scene = build_scene(context.device(), {boxes(context.device(), {box})});
      check_generated("the ray", trace(context, scene.top_level, ray), {}, 2.5f);
    });
  }
  group.add("inactive_box", "a box with a NaN in its minimum is never offered, and the others keep their numbers",
            [](Context& context) {
              const float nan = std::numeric_limits<float>::quiet_NaN();
              const rhi::Geometry pile =
                  boxes(context.device(), {{{nan, 0, 0}, {1, 1, 1}}, Box{}, {{nan, nan, nan}, {nan, nan, nan}}});
              const Traversal seen = fall(context, {pile}, {generate_at(4.5f)});
              for (const Intersection& candidate : seen.candidates)
                check_equal("the box that is offered", candidate.primitive, 1u);
              check_generated("the ray", seen, {.primitive = 1}, 4.5f);
            });
  group.add("stride", "boxes may be farther apart than their 24 bytes, and begin inside a buffer",
            [](Context& context) {
              rhi::Device& device = context.device();
              std::vector<float> data(4, -1);  // the boxes begin at byte 16
              for (const float z : {0.0f, 2.0f}) data.insert(data.end(), {0, 0, z, 1, 1, z + 1, -1, -1, -1, -1});
              rhi::AabbGeometry geometry;
              geometry.boxes = {buffer_of(device, data, "boxes"), 16};
              geometry.box_count = 2;
              geometry.stride = 40;
              check_generated("the ray", fall(context, {geometry}, {generate_at(4.5f, 0)}), {.primitive = 0}, 4.5f);
              check_generated("the ray", fall(context, {geometry}, {generate_at(2.5f, 1)}), {.primitive = 1}, 2.5f);
            });
}

/// Spheres of radius 1 in boxes of side 2; the nearest hit in front of the ray, in the instance's object space.
const std::string sphere_source = R"(#version 460
#extension GL_EXT_ray_query : require
layout(local_size_x = 32) in;
struct Ray { vec3 origin; float t_min; vec3 direction; float t_max; };
struct Hit { uint type; uint instance; uint primitive; float t; };
layout(set = 0, binding = 0) uniform accelerationStructureEXT scene;
layout(set = 0, binding = 1, std430) readonly buffer Rays { Ray rays[]; };
layout(set = 0, binding = 2, std430) readonly buffer Centres { vec4 centres[]; };
layout(set = 0, binding = 3, std430) writeonly buffer Hits { Hit hits[]; };
layout(push_constant) uniform Constants { uint ray_count; };
void main() {
  uint index = gl_GlobalInvocationID.x;
  if (index >= ray_count) return;
  Ray ray = rays[index];
  rayQueryEXT query;
  rayQueryInitializeEXT(query, scene, 0u, 0xffu, ray.origin, ray.t_min, ray.direction, ray.t_max);
  float closest = ray.t_max;
  while (rayQueryProceedEXT(query)) {
    vec3 centre = centres[rayQueryGetIntersectionPrimitiveIndexEXT(query, false)].xyz;
    vec3 origin = rayQueryGetIntersectionObjectRayOriginEXT(query, false) - centre;
    vec3 direction = rayQueryGetIntersectionObjectRayDirectionEXT(query, false);
    float a = dot(direction, direction);
    float middle = -dot(origin, direction) / a;
    vec3 foot = origin + middle * direction;
    float inside = 1.0 - dot(foot, foot);
    if (inside < 0.0) continue;
    float t = middle - sqrt(inside / a);
    if (t < ray.t_min || t > closest) continue;
    closest = t;
    rayQueryGenerateIntersectionEXT(query, t);
  }
  Hit hit = Hit(rayQueryGetIntersectionTypeEXT(query, true), 0u, 0u, 0.0);
  if (hit.type != gl_RayQueryCommittedIntersectionNoneEXT) {
    hit.instance = uint(rayQueryGetIntersectionInstanceIdEXT(query, true));
    hit.primitive = uint(rayQueryGetIntersectionPrimitiveIndexEXT(query, true));
    hit.t = rayQueryGetIntersectionTEXT(query, true);
  }
  hits[index] = hit;
}
)";

struct SphereRay {
  glm::vec3 origin;
  float t_min = 0;
  glm::vec3 direction;
  float t_max = 1000;
};
struct SphereHit {
  std::uint32_t type = 0;
  std::uint32_t instance = 0;
  std::uint32_t primitive = 0;
  float t = 0;
};

using Centres = std::vector<std::array<float, 4>>;

struct SphereAnswer {
  double t = 1000;
  std::uint32_t instance = any;
  std::uint32_t primitive = any;
  bool uncertain = false;  ///< rounding may decide: a sphere is grazed, or two are met at nearly the same t
};

SphereAnswer nearest_sphere(const std::vector<Transform>& transforms, const Centres& centres, const SphereRay& ray) {
  SphereAnswer answer;
  for (std::uint32_t instance = 0; instance < transforms.size(); ++instance) {
    const glm::dmat4x3 world_to_object = inverse(matrix_of(transforms[instance]));
    for (std::uint32_t primitive = 0; primitive < centres.size(); ++primitive) {
      const glm::dvec3 centre(centres[primitive][0], centres[primitive][1], centres[primitive][2]);
      const glm::dvec3 origin = transform_point(world_to_object, ray.origin) - centre;
      const glm::dvec3 direction = transform_direction(world_to_object, ray.direction);
      const double a = glm::dot(direction, direction);
      const double middle = -glm::dot(origin, direction) / a;
      const glm::dvec3 foot = origin + middle * direction;
      const double inside = 1 - glm::dot(foot, foot);
      if (std::abs(inside) < 1e-2) answer.uncertain = true;
      if (inside < 0) continue;
      const double t = middle - std::sqrt(inside / a);
      if (t < 0) continue;
      if (std::abs(t - answer.t) < 1e-4) answer.uncertain = true;
      if (t < answer.t) {
        answer.t = t;
        answer.instance = instance;
        answer.primitive = primitive;
      }
    }
  }
  return answer;
}

/// Rays from outside at points inside random spheres of a cloud; every answer against the nearest of all spheres.
void check_spheres(Context& context, const std::vector<Transform>& transforms) {
  rhi::Device& device = context.device();
  std::mt19937 random(7);
  std::uniform_real_distribution<float> uniform(-1, 1);
  const auto point = [&](float scale) { return scale * glm::vec3(uniform(random), uniform(random), uniform(random)); };
  Centres centres;
  std::vector<Box> bounds;
  for (int i = 0; i < 50; ++i) {
    const glm::vec3 centre = point(20);
    centres.push_back({centre.x, centre.y, centre.z, 0});
    bounds.push_back({centre - glm::vec3(1.001f), centre + glm::vec3(1.001f)});
  }
  const rhi::AccelerationStructureHandle bottom_level = build_bottom_level(device, {boxes(device, bounds)});
  std::vector<rhi::InstanceDesc> instances;
  for (const Transform& transform : transforms) instances.push_back(rhi::make_instance(*bottom_level, transform));
  std::vector<SphereRay> rays;
  for (std::size_t i = 0; i < 256; ++i) {
    const std::array<float, 4>& centre = centres[i % centres.size()];
    const glm::dvec3 target = transform_point(matrix_of(transforms[i % transforms.size()]),
                                              glm::dvec3(centre[0], centre[1], centre[2]) + glm::dvec3(point(0.4f)));
    const glm::vec3 origin = 100.0f * glm::normalize(point(1));
    rays.push_back({.origin = origin, .direction = glm::vec3(target) - origin});
  }
  const rhi::ComputePipelineHandle pipeline = context.compute_pipeline(sphere_source, "spheres");
  const rhi::BufferHandle hits = buffer_of(device, std::vector<SphereHit>(rays.size()), "hits");
  const rhi::BindGroupHandle group = device.create_bind_group(
      {.pipeline = pipeline,
       .entries = {{.binding = 0, .resource = build_top_level(device, instances)},
                   {.binding = 1, .resource = rhi::BufferRange{buffer_of(device, rays, "rays")}},
                   {.binding = 2, .resource = rhi::BufferRange{buffer_of(device, centres, "centres")}},
                   {.binding = 3, .resource = rhi::BufferRange{hits}}},
       .label = "spheres"});
  const auto ray_count = static_cast<std::uint32_t>(rays.size());
  const rhi::CommandListHandle list = device.create_command_list("spheres");
  list->dispatch({.pipeline = pipeline,
                  .bind_groups = {group},
                  .push_constants = std::as_bytes(std::span(&ray_count, 1)),
                  .workgroup_count = {(ray_count + 31) / 32, 1, 1}});
  device.submit(list);
  const std::vector<SphereHit> seen = rhi::read<SphereHit>(device, hits, rays.size());

  for (std::size_t i = 0; i < rays.size(); ++i) {
    const SphereAnswer expected = nearest_sphere(transforms, centres, rays[i]);
    if (expected.uncertain) continue;
    const std::string what = fmt::format("ray {}", i);
    check_equal(what + ": the committed type", seen[i].type, committed_type::generated);
    check_close(what + ": t", seen[i].t, expected.t, 1);
    check_equal(what + ": the instance", seen[i].instance, expected.instance);
    check_equal(what + ": the primitive", seen[i].primitive, expected.primitive);
  }
}

void add_sphere_cases(const Group& group) {
  group.add("spheres", "rays meet the nearest of many spheres where geometry says",
            [](Context& context) { check_spheres(context, {identity}); });
  group.add("spheres_transformed", "the same in a rotated, scaled and sheared instance", [](Context& context) {
    check_spheres(context, {{1.5f, -0.25f, 0.5f, 4, 0.75f, 1.25f, 0, -3, -0.5f, 0.25f, 0.75f, 7}});
  });
  group.add("spheres_mirrored", "the same in a mirrored instance", [](Context& context) {
    check_spheres(context, {{-1, 0, 0, 3, 0, 0.5f, 0, 1, 0, 0, 1.5f, 0}});
  });
  group.add("spheres_instances", "the same where several instances overlap", [](Context& context) {
    check_spheres(context, {identity, translation(3, 1, -2), {0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1, 4}});
  });
}

}  // namespace

void add_ray_query_procedural_cases(Cases& cases) {
  const Group group = {cases, "ray_query.procedural_geometry"};
  add_generate_cases(group);
  add_mixed_cases(group);
  add_flat_cases(group);
  add_sphere_cases(group);
  add_inside_cases({cases, "ray_query.inside_aabbs"});
}

}  // namespace tandem::conformance
