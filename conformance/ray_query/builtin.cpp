#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>

#include "conformance/kit/cases.hpp"
#include "conformance/kit/check.hpp"
#include "conformance/kit/reference.hpp"
#include "conformance/ray_query/probe.hpp"

/// ray_query.builtin: every getter, of candidates and of the committed intersection, of triangles and of boxes.
namespace tandem::conformance {
namespace {

enum class Primitive { triangle, box };

constexpr std::uint32_t instance_count = 3;
constexpr std::uint32_t geometry_count = 3;  // geometry g has g + 1 primitives

/// Rotated, scaled by different amounts and sheared; mirrored; and a uniform scale.
constexpr Transform transforms[instance_count] = {
    {1.5f, -0.25f, 0.5f, 40, 0.75f, 1.25f, 0, -3, -0.5f, 0.25f, 2, 7},
    {-2, 0, 0, -40, 0, 0.5f, 0.25f, 9, 0, 0, 3, 1},
    {0.5f, 0, 0, 0, 0, 0, -0.5f, 80, 0, 0.5f, 0, 0},
};
constexpr std::uint32_t custom_indices[instance_count] = {0x123456, 7, 0xabcdef};
constexpr std::uint32_t sbt_offsets[instance_count] = {3, 0x654321, 0xfedcba};

glm::vec3 place_of(std::uint32_t geometry, std::uint32_t primitive) {
  return {4.0f * static_cast<float>(primitive), 4.0f * static_cast<float>(geometry), 0};
}

/// The answer to one ray, which meets one primitive.
struct Answer {
  Ray ray = {};
  std::uint32_t instance = 0;
  std::uint32_t geometry = 0;
  std::uint32_t primitive = 0;
  double t = 0;
  double u = 0;
  double v = 0;
  bool front_face = false;
  glm::dmat4x3 object_to_world = glm::dmat4x3(1);
  glm::dmat4x3 world_to_object = glm::dmat4x3(1);
  glm::dvec3 object_origin = {};
  glm::dvec3 object_direction = {};
};

constexpr float generated_t = 1.25f;

/// A ray at the primitive: through (0.3, 0.2) of its plane z = 0 at about t = 2, from alternating sides.
Answer answer_of(Primitive kind, std::uint32_t instance, std::uint32_t geometry, std::uint32_t primitive) {
  Answer answer = {.instance = instance, .geometry = geometry, .primitive = primitive};
  answer.object_to_world = matrix_of(transforms[instance]);
  answer.world_to_object = inverse(answer.object_to_world);
  const glm::dvec3 place = place_of(geometry, primitive);
  const glm::dvec3 target = place + glm::dvec3(0.3, 0.2, kind == Primitive::box ? 0.5 : 0.0);
  const glm::dvec3 direction(0.1, -0.05, (geometry + primitive) % 2 == 0 ? -1.0 : 1.0);
  answer.ray.origin = transform_point(answer.object_to_world, target - 2.0 * direction);
  answer.ray.direction = transform_direction(answer.object_to_world, direction);
  answer.ray.t_min = 0.125f;
  answer.ray.t_max = 4;
  // From here on with the rounded ray, which is what the device gets.
  answer.object_origin = transform_point(answer.world_to_object, answer.ray.origin);
  answer.object_direction = transform_direction(answer.world_to_object, answer.ray.direction);
  if (kind == Primitive::box) {
    answer.t = generated_t;
  } else {
    const TriangleHit hit = intersect({place, place + glm::dvec3(1, 0, 0), place + glm::dvec3(0, 1, 0)},
                                      answer.object_origin, answer.object_direction)
                                .value();
    answer.t = hit.t;
    answer.u = hit.u;
    answer.v = hit.v;
    answer.front_face = hit.front_face;
  }
  return answer;
}

std::vector<Answer> answers_of(Primitive kind) {
  std::vector<Answer> answers;
  for (std::uint32_t instance = 0; instance < instance_count; ++instance)
    for (std::uint32_t geometry = 0; geometry < geometry_count; ++geometry)
      for (std::uint32_t primitive = 0; primitive <= geometry; ++primitive)
        answers.push_back(answer_of(kind, instance, geometry, primitive));
  return answers;
}

rhi::Geometry geometry_of(rhi::Device& device, Primitive kind, std::uint32_t geometry, rhi::GeometryFlags flags) {
  std::vector<glm::vec3> vertices;
  std::vector<Box> bounds;
  for (std::uint32_t primitive = 0; primitive <= geometry; ++primitive) {
    const glm::vec3 place = place_of(geometry, primitive);
    const std::vector<glm::vec3> corners = triangle_at(place);
    vertices.insert(vertices.end(), corners.begin(), corners.end());
    bounds.push_back({place, place + glm::vec3(1)});
  }
  if (kind == Primitive::box) return boxes(device, bounds, flags);
  return triangles(device, vertices, flags);
}

/// Traces all rays; triangles are candidates where `with_candidates`, boxes always are.
std::vector<Traversal> trace_all(Context& context, Primitive kind, const std::vector<Answer>& answers,
                                 bool with_candidates) {
  rhi::Device& device = context.device();
  std::vector<rhi::Geometry> geometries;
  for (std::uint32_t geometry = 0; geometry < geometry_count; ++geometry)
    geometries.push_back(
        geometry_of(device, kind, geometry, with_candidates ? rhi::GeometryFlags::none : rhi::GeometryFlags::opaque));
  const rhi::AccelerationStructureHandle bottom_level = build_bottom_level(device, geometries);
  std::vector<rhi::InstanceDesc> instances;
  for (std::uint32_t i = 0; i < instance_count; ++i) {
    instances.push_back(rhi::make_instance(*bottom_level, transforms[i]));
    instances.back().custom_index = custom_indices[i] & 0xffffff;
    instances.back().sbt_offset = sbt_offsets[i] & 0xffffff;
  }
  std::vector<Ray> rays;
  for (const Answer& answer : answers) {
    rays.push_back(answer.ray);
    if (kind == Primitive::box) {
      rays.back().decisions = {{.actions = action::generate, .t = generated_t}};
    } else {
      rays.back().decisions = {{.actions = action::confirm}};
    }
  }
  return trace(context, build_top_level(device, instances), rays);
}

void check_vector(std::string_view what, const glm::vec3& seen, const glm::dvec3& expected) {
  for (int i = 0; i < 3; ++i)
    check_close(fmt::format("{} component {}", what, i), seen[i], expected[i], glm::length(expected));
}

void check_matrix(std::string_view what, const Transform& seen, const glm::dmat4x3& expected) {
  double scale = 0;
  for (int column = 0; column < 4; ++column) scale = std::max(scale, glm::length(expected[column]));
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 4; ++column)
      check_close(fmt::format("{} row {} column {}", what, row, column),
                  seen[static_cast<std::size_t>(row * 4 + column)], expected[column][row], scale);
}

/// A getter of intersections: its name in the cases, what it says, and how its answer is checked.
struct Getter {
  std::string name;
  std::string meaning;
  std::function<void(const Intersection& seen, const Answer& answer)> check;
};

const Getter getters_of_both[] = {
    {"instance_id", "the instance's position in the top level",
     [](const Intersection& seen, const Answer& answer) {
       check_equal("the instance id", seen.instance, answer.instance);
     }},
    {"instance_custom_index", "the instance's custom index",
     [](const Intersection& seen, const Answer& answer) {
       check_equal("the custom index", seen.custom_index, custom_indices[answer.instance]);
     }},
    {"instance_sbt_offset", "the instance's offset into the shader table",
     [](const Intersection& seen, const Answer& answer) {
       check_equal("the SBT offset", seen.sbt_offset, sbt_offsets[answer.instance]);
     }},
    {"geometry_index", "the geometry's position in the bottom level",
     [](const Intersection& seen, const Answer& answer) {
       check_equal("the geometry index", seen.geometry, answer.geometry);
     }},
    {"primitive_index", "the primitive's position in its geometry",
     [](const Intersection& seen, const Answer& answer) {
       check_equal("the primitive index", seen.primitive, answer.primitive);
     }},
    {"object_ray_origin", "the ray's origin in object space",
     [](const Intersection& seen, const Answer& answer) {
       check_vector("the object ray origin", seen.object_origin, answer.object_origin);
     }},
    {"object_ray_direction", "the ray's direction in object space, not normalised",
     [](const Intersection& seen, const Answer& answer) {
       check_vector("the object ray direction", seen.object_direction, answer.object_direction);
     }},
    {"object_to_world", "the instance's transform",
     [](const Intersection& seen, const Answer& answer) {
       check_matrix("object to world", seen.object_to_world, answer.object_to_world);
     }},
    {"world_to_object", "the inverse of the instance's transform",
     [](const Intersection& seen, const Answer& answer) {
       check_matrix("world to object", seen.world_to_object, answer.world_to_object);
     }},
};

const Getter getters_of_triangles[] = {
    {"barycentrics", "the weights of the second and the third corner",
     [](const Intersection& seen, const Answer& answer) {
       check_close("the first barycentric", seen.barycentrics.x, answer.u, 1);
       check_close("the second barycentric", seen.barycentrics.y, answer.v, 1);
     }},
    {"front_face", "whether the normal points against the ray in object space",
     [](const Intersection& seen, const Answer& answer) {
       check_equal("the front face", seen.front_face, answer.front_face ? 1u : 0u);
     }},
};

const Getter getter_of_t = {"t", "the distance in lengths of the ray's direction",
                            [](const Intersection& seen, const Answer& answer) { check_close("t", seen.t, answer.t); }};

std::string ray_name(const Answer& answer) {
  return fmt::format("instance {} geometry {} primitive {}", answer.instance, answer.geometry, answer.primitive);
}

void check_getter(Context& context, Primitive kind, bool candidate, const Getter& getter) {
  const std::vector<Answer> answers = answers_of(kind);
  const std::vector<Traversal> traversals = trace_all(context, kind, answers, candidate);
  const std::uint32_t committed = kind == Primitive::box ? committed_type::generated : committed_type::triangle;
  for (std::size_t i = 0; i < answers.size(); ++i) {
    const std::string place = ray_name(answers[i]);
    try {
      check_equal("the committed type", traversals[i].committed.type, committed);
      if (!candidate) {
        getter.check(traversals[i].committed, answers[i]);
        continue;
      }
      check(!traversals[i].candidates.empty(), "there is no candidate");
      for (const Intersection& offered : traversals[i].candidates) getter.check(offered, answers[i]);
    } catch (const Failure& failure) {
      throw Failure(fmt::format("at {} {}", place, failure.what()));
    }
  }
}

void add_getter(Cases& cases, const Getter& getter, Primitive kind, bool candidate) {
  const char* const kind_name = kind == Primitive::box ? "boxes" : "triangles";
  cases.push_back(
      {.name = fmt::format("ray_query.builtin.{}_{}_{}", getter.name, candidate ? "candidate" : "committed", kind_name),
       .behaviour = fmt::format("of {} {} the getter gives {}", candidate ? "candidate" : "committed", kind_name,
                                getter.meaning),
       .needs = {&rhi::Capabilities::ray_query},
       .run = [=](Context& context) { check_getter(context, kind, candidate, getter); }});
}

Getter type_getter(Primitive kind, bool candidate) {
  const bool box = kind == Primitive::box;
  const std::uint32_t expected = candidate ? (box ? candidate_type::box : candidate_type::triangle)
                                           : (box ? committed_type::generated : committed_type::triangle);
  return {"type", "what kind of intersection it is",
          [=](const Intersection& seen, const Answer&) { check_equal("the type", seen.type, expected); }};
}

void check_box_opacity(Context& context, rhi::GeometryFlags flags, std::uint32_t ray_flag, std::uint32_t expected) {
  const Scene scene = build_scene(context.device(), {boxes(context.device(), {Box{}}, flags)});
  const Traversal traversal = trace(context, scene.top_level, Ray{.flags = ray_flag});
  check(!traversal.candidates.empty(), "there is no candidate");
  for (const Intersection& candidate : traversal.candidates)
    check_equal("the candidate's opacity", candidate.box_opaque, expected);
}

/// The getters of the query itself: of a query that hits, and of one that misses.
void check_ray(Context& context, void (*check_getter)(const Traversal&, const Ray&)) {
  const Scene scene = build_scene(context.device(), {triangles(context.device(), triangle_at({0, 0, 0}))});
  const Ray hit = {.t_min = 0.375f, .flags = ray_flags::cull_back_facing | ray_flags::no_opaque};
  const Ray miss = {.origin = {9.5f, -3.25f, 1e-3f},
                    .t_min = 1e-20f,
                    .direction = {-1e6f, 0.1f, 7},
                    .t_max = 1e20f,
                    .flags = ray_flags::terminate_on_first_hit | ray_flags::skip_boxes};
  const std::vector<Ray> rays = {hit, miss};
  const std::vector<Traversal> traversals = trace(context, scene.top_level, rays);
  for (std::size_t i = 0; i < rays.size(); ++i) check_getter(traversals[i], rays[i]);
}

void check_exact(std::string_view what, const glm::vec3& seen, const glm::vec3& expected) {
  for (int i = 0; i < 3; ++i) check_equal(fmt::format("{} component {}", what, i), seen[i], expected[i]);
}

void add_ray_getters(Cases& cases) {
  const auto add = [&](const char* name, const char* behaviour, void (*check_getter)(const Traversal&, const Ray&)) {
    cases.push_back({.name = fmt::format("ray_query.builtin.{}", name),
                     .behaviour = behaviour,
                     .needs = {&rhi::Capabilities::ray_query},
                     .run = [=](Context& context) { check_ray(context, check_getter); }});
  };
  add("ray_t_min", "the ray's minimal t is the one that the query was initialised with",
      [](const Traversal& seen, const Ray& ray) { check_equal("t_min", seen.t_min, ray.t_min); });
  add("ray_flags", "the ray's flags are those that the query was initialised with",
      [](const Traversal& seen, const Ray& ray) { check_equal("the ray flags", seen.flags, ray.flags); });
  add("world_ray_origin", "the ray's origin is the one that the query was initialised with",
      [](const Traversal& seen, const Ray& ray) { check_exact("the origin", seen.world_origin, ray.origin); });
  add("world_ray_direction", "the ray's direction is the one that the query was initialised with, not normalised",
      [](const Traversal& seen, const Ray& ray) { check_exact("the direction", seen.world_direction, ray.direction); });
}

void add_box_opacity(Cases& cases, const char* name, const char* behaviour, rhi::GeometryFlags flags,
                     std::uint32_t ray_flag, std::uint32_t expected) {
  cases.push_back({.name = fmt::format("ray_query.builtin.{}", name),
                   .behaviour = behaviour,
                   .needs = {&rhi::Capabilities::ray_query},
                   .run = [=](Context& context) { check_box_opacity(context, flags, ray_flag, expected); }});
}

}  // namespace

void add_ray_query_builtin_cases(Cases& cases) {
  for (const Primitive kind : {Primitive::triangle, Primitive::box}) {
    for (const bool candidate : {true, false}) {
      add_getter(cases, type_getter(kind, candidate), kind, candidate);
      for (const Getter& getter : getters_of_both) add_getter(cases, getter, kind, candidate);
      if (kind == Primitive::triangle)
        for (const Getter& getter : getters_of_triangles) add_getter(cases, getter, kind, candidate);
      if (kind == Primitive::triangle || !candidate) add_getter(cases, getter_of_t, kind, candidate);
    }
  }
  using rhi::GeometryFlags;
  add_box_opacity(cases, "candidate_box_opaque", "a box of an opaque geometry is an opaque candidate",
                  GeometryFlags::opaque, ray_flags::none, 1);
  add_box_opacity(cases, "candidate_box_not_opaque", "a box of a geometry that is not opaque is no opaque candidate",
                  GeometryFlags::none, ray_flags::none, 0);
  add_box_opacity(cases, "candidate_box_forced_opaque", "the ray flag Opaque makes a box an opaque candidate",
                  GeometryFlags::none, ray_flags::opaque, 1);
  add_box_opacity(cases, "candidate_box_forced_not_opaque", "the ray flag NoOpaque makes a box no opaque candidate",
                  GeometryFlags::opaque, ray_flags::no_opaque, 0);
  add_ray_getters(cases);
}

}  // namespace tandem::conformance
