#include <doctest/doctest.h>

#include <cstring>
#include <string>
#include <vector>

#include "rhi/error.hpp"
#include "tests/rhi_cpu/scripted_pipeline.hpp"

// Any-hit, intersection and closest-hit shaders of the CPU device: which candidates they see, and what they decide.
namespace tandem::cpu {
namespace {

using kernel::HitDecision;
using kernel::ShaderCall;
using rhi::ShaderStage;
using test::box_at;
using test::ray_with;
using test::ScriptedPipeline;
using test::ScriptedScene;
using test::ScriptedShader;
using test::triangle_at;

/// What the closest-hit or the miss shader saw.
struct Seen {
  bool hit = false;
  bool miss = false;
  float t = 0;
  std::uint32_t hit_kind = 0;
  float attributes[8] = {};
  std::vector<float> any_hit_t = {};
};

using Script = std::function<void(ShaderCall&)>;

void accept(ShaderCall&) {}

/// Shaders: 0 ray generation, 1 miss, 2 closest hit, 3 any hit, 4 intersection. Hit groups: 0 for triangles, 1 for
/// triangles with any-hit, 2 for boxes, 3 for boxes with any-hit.
Seen trace_with(const ScriptedScene& scene, std::uint32_t flags, const std::vector<std::uint32_t>& records,
                const Script& any_hit = accept, const Script& intersection = accept) {
  Seen seen;
  const ScriptedPipeline pipeline(
      {{.stage = ShaderStage::ray_generation,
        .run = [&](ShaderCall& call) { test::trace(call, scene, ray_with(flags), seen); }},
       {.stage = ShaderStage::miss, .run = [](ShaderCall& call) { static_cast<Seen*>(call.payload)->miss = true; }},
       {.stage = ShaderStage::closest_hit,
        .run =
            [](ShaderCall& call) {
              auto& payload = *static_cast<Seen*>(call.payload);
              payload.hit = true;
              payload.t = call.t;
              payload.hit_kind = call.hit_kind;
              std::memcpy(payload.attributes, call.hit_attributes, sizeof(payload.attributes));
              CHECK(call.ray->t_max == 100);
              CHECK(call.instance != nullptr);
            },
        .payload_size = sizeof(Seen)},
       {.stage = ShaderStage::any_hit,
        .run =
            [&any_hit](ShaderCall& call) {
              static_cast<Seen*>(call.payload)->any_hit_t.push_back(call.t);
              any_hit(call);
            },
        .payload_size = sizeof(Seen)},
       {.stage = ShaderStage::intersection, .run = intersection}},
      {{.closest_hit = 2},
       {.closest_hit = 2, .any_hit = 3},
       {.closest_hit = 2, .intersection = 4},
       {.closest_hit = 2, .any_hit = 3, .intersection = 4}});
  pipeline.trace(records);
  return seen;
}

bool report(ShaderCall& call, float t, std::uint32_t hit_kind, float attribute) {
  std::memcpy(call.hit_attributes, &attribute, sizeof(attribute));
  return call.functions->report_intersection(call, t, hit_kind);
}

}  // namespace

TEST_CASE("A trace that no any-hit or intersection shader can see is one call of the tracer") {
  const ScriptedScene opaque({triangle_at(5, true), triangle_at(3, true)});
  const ScriptedScene translucent({triangle_at(5, false)});
  struct Case {
    const ScriptedScene& scene;
    std::uint32_t flags, record;
    int closest_calls, occluded_calls, visit_calls;
  };
  using namespace kernel;
  constexpr std::uint32_t first = ray_flag_terminate_on_first_hit;
  constexpr std::uint32_t skip = ray_flag_skip_closest_hit_shader;
  for (const Case& each : {
           Case{opaque, 0, 0, 1, 0, 0},
           Case{opaque, first, 0, 1, 0, 0},
           Case{opaque, skip, 0, 1, 0, 0},
           Case{opaque, first | skip, 0, 0, 1, 0},
           Case{opaque, 0, 1, 1, 0, 0},
           Case{opaque, first | skip, 1, 0, 1, 0},
           Case{opaque, ray_flag_no_opaque, 1, 0, 0, 1},
           Case{translucent, 0, 0, 1, 0, 0},
           Case{translucent, 0, 1, 0, 0, 1},
           Case{translucent, first | skip, 1, 0, 0, 1},
           Case{translucent, ray_flag_opaque, 1, 1, 0, 0},
           Case{translucent, ray_flag_opaque | first | skip, 1, 0, 1, 0},
           Case{translucent, ray_flag_cull_no_opaque, 1, 1, 0, 0},
       }) {
    CAPTURE(each.flags);
    CAPTURE(each.record);
    each.scene.closest_calls = each.scene.occluded_calls = each.scene.visit_calls = 0;
    const Seen seen = trace_with(each.scene, each.flags, {each.record});
    CHECK(each.scene.closest_calls == each.closest_calls);
    CHECK(each.scene.occluded_calls == each.occluded_calls);
    CHECK(each.scene.visit_calls == each.visit_calls);
    CHECK(seen.hit == ((each.flags & skip) == 0));
    CHECK_FALSE(seen.miss);
  }
}

TEST_CASE("The closest hit has the t, the kind and the barycentrics of its triangle") {
  ScriptedScene scene({triangle_at(5, true), triangle_at(3, true)});
  Seen seen = trace_with(scene, 0, {0});
  CHECK(seen.t == 3);
  CHECK(seen.hit_kind == 0xFE);
  CHECK(seen.attributes[0] == 0.25f);
  CHECK(seen.attributes[1] == 0.5f);
  scene.hits[1].front_face = false;
  CHECK(trace_with(scene, 0, {0}).hit_kind == 0xFF);
}

TEST_CASE("An any-hit shader sees its candidate, and may accept, ignore or end the ray") {
  const ScriptedScene scene({triangle_at(5, false), triangle_at(7, false), triangle_at(3, false)});
  Seen seen = trace_with(scene, 0, {1}, [](ShaderCall& call) {
    CHECK(call.hit_kind == 0xFE);
    CHECK(static_cast<const float*>(call.hit_attributes)[1] == 0.5f);
    CHECK(call.hit->t == call.t);
    CHECK(call.depth == 1);
  });
  CHECK(seen.any_hit_t == std::vector<float>{5, 3});
  CHECK(seen.t == 3);

  seen = trace_with(scene, 0, {1}, [](ShaderCall& call) { call.decision = HitDecision::ignore; });
  CHECK(seen.any_hit_t == std::vector<float>{5, 7, 3});
  CHECK(seen.miss);
  CHECK_FALSE(seen.hit);

  seen = trace_with(scene, 0, {1}, [](ShaderCall& call) { call.decision = HitDecision::terminate; });
  CHECK(seen.any_hit_t == std::vector<float>{5});
  CHECK(seen.t == 5);

  seen = trace_with(scene, 0, {0});  // without an any-hit shader, everything is accepted
  CHECK(seen.t == 3);
  CHECK(seen.any_hit_t.empty());
}

TEST_CASE("An intersection shader reports hits within the ray, each nearer than the one before") {
  const ScriptedScene scene({box_at(1, true)});
  const Seen seen = trace_with(scene, 0, {2}, accept, [](ShaderCall& call) {
    CHECK(call.t == 100);
    CHECK_FALSE(report(call, 100.5f, 1, 1));
    CHECK_FALSE(report(call, -0.5f, 2, 2));
    CHECK(report(call, 50, 3, 3));
    CHECK(call.t == 50);
    CHECK_FALSE(report(call, 60, 4, 4));
    CHECK(report(call, 20, 5, 5));
    CHECK(call.t == 20);
    CHECK_FALSE(report(call, 30, 6, 6));
    CHECK(call.decision == HitDecision::accept);
  });
  CHECK(seen.hit);
  CHECK(seen.t == 20);
  CHECK(seen.hit_kind == 5);
  CHECK(seen.attributes[0] == 5);
}

TEST_CASE("Both ends of the ray count for what an intersection shader reports") {
  const ScriptedScene scene({box_at(1, true)});
  CHECK(trace_with(scene, 0, {2}, accept, [](ShaderCall& call) { CHECK(report(call, 100, 0, 0)); }).t == 100);
  CHECK(trace_with(scene, 0, {2}, accept, [](ShaderCall& call) { CHECK(report(call, 0, 0, 0)); }).hit);
}

TEST_CASE("An intersection shader that reports nothing has no hit; nor has a box without one") {
  const ScriptedScene scene({box_at(1, true)});
  CHECK(trace_with(scene, 0, {2}).miss);
  CHECK(trace_with(scene, 0, {0}).miss);
  CHECK(trace_with(scene, 0, {1, 2}).miss);  // one with an intersection shader is in the table, but not this box's
  CHECK(trace_with(scene, 0, {rhi::no_shader, 2}).miss);
}

TEST_CASE("A triangle whose hit group is for boxes is not hit, be it opaque or not") {
  for (const bool opaque : {true, false}) {
    ScriptedScene scene({triangle_at(3, opaque), triangle_at(5, opaque)});
    scene.hits[1].geometry_index = 1;
    const Seen seen = trace_with(scene, 0, {2, 0});
    CHECK(seen.hit);
    CHECK(seen.t == 5);
    CHECK(trace_with(scene, 0, {2, 2}).miss);
    using namespace kernel;
    CHECK(trace_with(scene, ray_flag_terminate_on_first_hit | ray_flag_skip_closest_hit_shader, {2, 3}).miss);
  }
}

TEST_CASE("The any-hit shader of a box that is not opaque decides about each report") {
  const ScriptedScene scene({box_at(1, false)});
  const auto intersection = [](ShaderCall& call) {
    report(call, 50, 1, 1);
    if (call.decision == HitDecision::terminate) return;
    report(call, 40, 2, 2);
    if (call.decision == HitDecision::terminate) return;
    report(call, 30, 3, 3);
  };
  Seen seen = trace_with(
      scene, 0, {3},
      [](ShaderCall& call) {
        CHECK(call.hit_kind == static_cast<std::uint32_t>(*static_cast<const float*>(call.hit_attributes)));
        CHECK(call.hit->is_box);
        if (call.hit_kind != 2) call.decision = HitDecision::ignore;
      },
      intersection);
  CHECK(seen.any_hit_t == std::vector<float>{50, 40, 30});
  CHECK(seen.t == 40);
  CHECK(seen.hit_kind == 2);
  CHECK(seen.attributes[0] == 2);

  seen = trace_with(
      scene, 0, {3}, [](ShaderCall& call) { call.decision = HitDecision::terminate; }, intersection);
  CHECK(seen.any_hit_t == std::vector<float>{50});
  CHECK(seen.t == 50);

  seen = trace_with(scene, kernel::ray_flag_terminate_on_first_hit, {3}, accept, intersection);
  CHECK(seen.any_hit_t == std::vector<float>{50});

  CHECK(trace_with(scene, 0, {2}, accept, intersection).t == 30);
  CHECK(trace_with(ScriptedScene({box_at(1, true)}), 0, {3}, accept, intersection).any_hit_t.empty());
}

TEST_CASE("Candidates that are not committed leave the committed hit's attributes alone") {
  // The second box writes attributes and has its report refused; the third reports nothing at all.
  ScriptedScene scene({box_at(1, false), box_at(2, false), box_at(3, false)});
  for (std::uint32_t i = 0; i < 3; ++i) scene.hits[i].primitive_index = i;
  const Seen seen = trace_with(
      scene, 0, {3},
      [](ShaderCall& call) {
        if (call.hit->primitive_index != 0) call.decision = HitDecision::ignore;
      },
      [](ShaderCall& call) {
        const float number = static_cast<float>(call.hit->primitive_index);
        if (call.hit->primitive_index < 2)
          report(call, 50 - number, 7 + call.hit->primitive_index, 10 + number);
        else
          std::memcpy(call.hit_attributes, &number, sizeof(number));
      });
  CHECK(seen.t == 50);
  CHECK(seen.hit_kind == 7);
  CHECK(seen.attributes[0] == 10);
}

TEST_CASE("A nearer triangle takes the hit from a box, and the other way round") {
  const auto reports_four = [](ShaderCall& call) { report(call, 4, 9, 9); };
  ScriptedScene scene({box_at(1, true), triangle_at(3, true)});
  scene.hits[1].geometry_index = 1;
  Seen seen = trace_with(scene, 0, {2, 0}, accept, reports_four);
  CHECK(seen.t == 3);
  CHECK(seen.hit_kind == 0xFE);
  CHECK(seen.attributes[0] == 0.25f);
  std::swap(scene.hits[0], scene.hits[1]);
  scene.hits[0].t = 5;
  seen = trace_with(scene, 0, {2, 0}, accept, reports_four);
  CHECK(seen.t == 4);
  CHECK(seen.hit_kind == 9);
  CHECK(seen.attributes[0] == 9);
}

}  // namespace tandem::cpu
