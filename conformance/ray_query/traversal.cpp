#include <algorithm>
#include <set>

#include "conformance/kit/cases.hpp"
#include "conformance/kit/check.hpp"
#include "conformance/ray_query/probe.hpp"

/// ray_query.traversal_control: what a shader does with candidates, and what is committed then. The order and number of
/// candidates are not defined, so no case depends on them.
namespace tandem::conformance {
namespace {

using rhi::GeometryFlags;

// Triangle i lies in the plane z = i. A ray that falls from z = 5 meets it at t = 5 - i, so the last is the closest.
constexpr std::uint32_t layer_count = 3;
constexpr std::uint32_t nearest_layer = 2;
double t_of_layer(std::uint32_t layer) { return 5.0 - layer; }

rhi::Geometry layers(rhi::Device& device, GeometryFlags flags) {
  std::vector<glm::vec3> vertices;
  for (std::uint32_t i = 0; i < layer_count; ++i)
    for (const glm::vec3& corner : triangle_at({0, 0, static_cast<float>(i)})) vertices.push_back(corner);
  return triangles(device, vertices, flags);
}

rhi::Geometry layer(rhi::Device& device, float z, GeometryFlags flags) {
  return triangles(device, triangle_at({0, 0, z}), flags);
}

Traversal fall(Context& context, std::vector<rhi::Geometry> geometries, std::vector<Decision> decisions,
               std::uint32_t flags = ray_flags::none) {
  const Scene scene = build_scene(context.device(), std::move(geometries));
  return trace(context, scene.top_level, Ray{.flags = flags, .decisions = std::move(decisions)});
}

Traversal fall_through_layers(Context& context, std::vector<Decision> decisions,
                              std::uint32_t flags = ray_flags::none) {
  return fall(context, {layers(context.device(), GeometryFlags::none)}, std::move(decisions), flags);
}

const Decision confirm_any = {.actions = action::confirm};

std::set<std::uint32_t> offered_primitives(const Traversal& traversal) {
  std::set<std::uint32_t> primitives;
  for (const Intersection& candidate : traversal.candidates) primitives.insert(candidate.primitive);
  return primitives;
}

void check_all_layers_offered(const Traversal& traversal) {
  check_equal("the number of different triangles offered", offered_primitives(traversal).size(), layer_count);
}

void add_candidate_cases(const Group& group) {
  group.add("opaque_commits", "an opaque triangle is committed without becoming a candidate", [](Context& context) {
    const Traversal seen = fall(context, {layers(context.device(), GeometryFlags::opaque)}, {});
    check_triangle("the ray", seen, {.primitive = nearest_layer}, t_of_layer(nearest_layer));
    check_equal("the number of candidates", seen.candidate_count, 0u);
  });
  group.add("skip_commits_nothing", "candidates that nothing is done with are not committed", [](Context& context) {
    const Traversal seen = fall_through_layers(context, {});
    check_miss("the ray", seen);
    check(seen.candidate_count >= layer_count, "fewer candidates than triangles");
  });
  group.add("skip_offers_all", "when all are skipped, every triangle along the ray is offered",
            [](Context& context) { check_all_layers_offered(fall_through_layers(context, {})); });
  group.add("candidates_keep_t", "each candidate has the t of its own triangle", [](Context& context) {
    for (const Intersection& candidate : fall_through_layers(context, {}).candidates)
      check_close("t of a candidate", candidate.t, t_of_layer(candidate.primitive));
  });
  group.add("confirm_all_gives_closest", "when all are confirmed, the closest is committed", [](Context& context) {
    check_triangle("the ray", fall_through_layers(context, {confirm_any}), {.primitive = nearest_layer},
                   t_of_layer(nearest_layer));
  });
  constexpr const char* names[layer_count] = {"confirm_farthest", "confirm_middle", "confirm_nearest"};
  for (std::uint32_t chosen = 0; chosen < layer_count; ++chosen) {
    group.add(names[chosen], "only the triangle that is confirmed is committed", [chosen](Context& context) {
      const Traversal seen = fall_through_layers(context, {{.actions = action::confirm, .primitive = chosen}});
      check_triangle("the ray", seen, {.primitive = chosen}, t_of_layer(chosen));
    });
  }
  group.add("confirm_commits_at_once", "what is confirmed is committed before the next proceed", [](Context& context) {
    const Traversal seen = fall_through_layers(context, {confirm_any});
    check(!seen.candidates.empty(), "there is no candidate");
    for (const Intersection& candidate : seen.candidates) {
      check_equal("the committed type after confirming", candidate.committed_type_after, committed_type::triangle);
      check_equal("the committed t after confirming", candidate.committed_t_after, candidate.t);
    }
  });
  group.add("committed_bounds_candidates", "no candidate lies behind what is committed", [](Context& context) {
    const Traversal seen = fall_through_layers(context, {confirm_any});
    for (std::size_t i = 1; i < seen.candidates.size(); ++i)
      check(seen.candidates[i].t <= seen.candidates[i - 1].committed_t_after,
            fmt::format("a candidate at t = {} after one was committed at {}", seen.candidates[i].t,
                        seen.candidates[i - 1].committed_t_after));
  });
}

void add_terminate_cases(const Group& group) {
  group.add("terminate_commits_nothing", "a query that is terminated offers no more and commits nothing by itself",
            [](Context& context) {
              const Traversal seen = fall_through_layers(context, {{.actions = action::terminate}});
              check_miss("the ray", seen);
              check_equal("the number of candidates", seen.candidate_count, 1u);
            });
  group.add("confirm_then_terminate", "what was confirmed before the query was terminated stays committed",
            [](Context& context) {
              const Traversal seen = fall_through_layers(context, {{.actions = action::confirm | action::terminate}});
              check_equal("the number of candidates", seen.candidate_count, 1u);
              const std::uint32_t primitive = seen.candidates.front().primitive;
              check_triangle("the ray", seen, {.primitive = primitive}, t_of_layer(primitive));
            });
  group.add("first_hit_opaque", "TerminateOnFirstHit commits one of the opaque triangles, with its own t",
            [](Context& context) {
              const Traversal seen = fall(context, {layers(context.device(), GeometryFlags::opaque)}, {},
                                          ray_flags::terminate_on_first_hit);
              check(seen.hit(), "the ray hits nothing, expected one of the triangles");
              check(seen.committed.primitive < layer_count, "the primitive does not exist");
              check_close("t", seen.committed.t, t_of_layer(seen.committed.primitive));
            });
  group.add("first_hit_confirm", "TerminateOnFirstHit ends the query with the first confirmed candidate",
            [](Context& context) {
              const Traversal seen = fall_through_layers(context, {confirm_any}, ray_flags::terminate_on_first_hit);
              check_equal("the number of candidates", seen.candidate_count, 1u);
              const std::uint32_t primitive = seen.candidates.front().primitive;
              check_triangle("the ray", seen, {.primitive = primitive}, t_of_layer(primitive));
            });
  group.add("first_hit_skip", "TerminateOnFirstHit does not end the query at candidates that are skipped",
            [](Context& context) {
              check_all_layers_offered(fall_through_layers(context, {}, ray_flags::terminate_on_first_hit));
            });
  group.add("first_hit_generate", "TerminateOnFirstHit ends the query with the first generated hit",
            [](Context& context) {
              const rhi::Geometry two = boxes(context.device(), {{{0, 0, 0}, {1, 1, 1}}, {{0, 0, 2}, {1, 1, 3}}});
              const Traversal seen = fall(context, {two},
                                          {{.actions = action::generate, .primitive = 0, .t = 4.5f},
                                           {.actions = action::generate, .primitive = 1, .t = 2.5f}},
                                          ray_flags::terminate_on_first_hit);
              check_equal("the number of candidates", seen.candidate_count, 1u);
              const std::uint32_t primitive = seen.candidates.front().primitive;
              check_generated("the ray", seen, {.primitive = primitive}, primitive == 0 ? 4.5f : 2.5f);
            });
  group.add("skip_closest_hit_shader", "SkipClosestHitShader changes nothing in a query", [](Context& context) {
    check_triangle("the ray", fall_through_layers(context, {confirm_any}, ray_flags::skip_closest_hit_shader),
                   {.primitive = nearest_layer}, t_of_layer(nearest_layer));
  });
}

void add_mixed_cases(const Group& group) {
  group.add("opaque_behind_skipped", "an opaque triangle behind a skipped candidate is committed",
            [](Context& context) {
              rhi::Device& device = context.device();
              const Traversal seen =
                  fall(context, {layer(device, 0, GeometryFlags::opaque), layer(device, 2, GeometryFlags::none)}, {});
              check_triangle("the ray", seen, {.geometry = 0}, 5);
            });
  group.add("opaque_before_candidate", "an opaque triangle in front wins over a confirmed candidate behind",
            [](Context& context) {
              rhi::Device& device = context.device();
              const Traversal seen =
                  fall(context, {layer(device, 2, GeometryFlags::opaque), layer(device, 0, GeometryFlags::none)},
                       {confirm_any});
              check_triangle("the ray", seen, {.geometry = 0}, 3);
            });
  group.add("candidate_before_opaque", "a confirmed candidate in front wins over an opaque triangle behind",
            [](Context& context) {
              rhi::Device& device = context.device();
              const Traversal seen =
                  fall(context, {layer(device, 0, GeometryFlags::opaque), layer(device, 2, GeometryFlags::none)},
                       {confirm_any});
              check_triangle("the ray", seen, {.geometry = 1}, 3);
            });
  group.add("many_layers", "of a hundred candidates one is confirmed, and that one is committed", [](Context& context) {
    std::vector<glm::vec3> vertices;
    for (std::uint32_t i = 0; i < 100; ++i)
      for (const glm::vec3& corner : triangle_at({0, 0, -0.25f * static_cast<float>(i)})) vertices.push_back(corner);
    const Traversal seen = fall(context, {triangles(context.device(), vertices, GeometryFlags::none)},
                                {{.actions = action::confirm, .primitive = 61}});
    check_triangle("the ray", seen, {.primitive = 61}, 5 + 0.25 * 61);
    check(seen.candidate_count >= 62,
          fmt::format("{} candidates are fewer than the 62 triangles up to the committed one", seen.candidate_count));
  });
  group.add("coplanar_candidates", "candidates at the same t are all offered", [](Context& context) {
    std::vector<glm::vec3> vertices;
    for (int i = 0; i < 5; ++i)
      for (const glm::vec3& corner : triangle_at({0, 0, 1})) vertices.push_back(corner);
    const Traversal seen = fall(context, {triangles(context.device(), vertices, GeometryFlags::none)}, {});
    check_equal("the number of different triangles offered", offered_primitives(seen).size(), 5u);
  });
  group.add("coplanar_confirm", "of candidates at the same t, the one that is confirmed is committed",
            [](Context& context) {
              std::vector<glm::vec3> vertices;
              for (int i = 0; i < 5; ++i)
                for (const glm::vec3& corner : triangle_at({0, 0, 1})) vertices.push_back(corner);
              for (std::uint32_t chosen = 0; chosen < 5; ++chosen) {
                const Traversal seen = fall(context, {triangles(context.device(), vertices, GeometryFlags::none)},
                                            {{.actions = action::confirm, .primitive = chosen}});
                check_triangle("the ray", seen, {.primitive = chosen}, 4);
              }
            });
}

/// Every primitive of a pile must be offered exactly once.
void check_no_duplicates(Context& context, const rhi::Geometry& pile, std::uint32_t primitive_count) {
  const Scene scene = build_scene(context.device(), {pile});
  const Traversal seen = trace(context, scene.top_level, Ray{});
  check_equal("the number of candidates", seen.candidate_count, primitive_count);
  check_equal("the number of different primitives offered", offered_primitives(seen).size(), primitive_count);
}

void add_no_duplicate_cases(const Group& group) {
  constexpr GeometryFlags flags = GeometryFlags::no_duplicate_any_hit;
  group.add("no_duplicates_triangles", "with the flag of the geometry each triangle is offered once",
            [](Context& context) {
              // Long and thin in the diagonal: what a builder that splits triangles would split.
              std::vector<glm::vec3> vertices;
              for (std::uint32_t i = 0; i < most_candidates; ++i) {
                const float z = -0.5f * static_cast<float>(i);
                vertices.insert(vertices.end(), {{-900, -900, z}, {1000, 999, z}, {999, 1000, z}});
              }
              check_no_duplicates(context, triangles(context.device(), vertices, flags), most_candidates);
            });
  group.add("no_duplicates_boxes", "with the flag of the geometry each box is offered once", [](Context& context) {
    std::vector<Box> pile;
    for (std::uint32_t i = 0; i < most_candidates; ++i) {
      const float size = 1.0f + static_cast<float>(i * i);
      pile.push_back({{-size, -size, -size}, {size, size, size}});
    }
    check_no_duplicates(context, boxes(context.device(), pile, flags), most_candidates);
  });
}

}  // namespace

void add_ray_query_traversal_cases(Cases& cases) {
  const Group group = {cases, "ray_query.traversal_control"};
  add_candidate_cases(group);
  add_terminate_cases(group);
  add_mixed_cases(group);
  add_no_duplicate_cases({cases, "ray_query.no_duplicates"});
}

}  // namespace tandem::conformance
