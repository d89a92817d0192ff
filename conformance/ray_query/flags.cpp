#include <algorithm>

#include "conformance/kit/cases.hpp"
#include "conformance/kit/check.hpp"
#include "conformance/ray_query/probe.hpp"

/// ray_query.cull_ray_flags: what becomes of one primitive, by the flags of its geometry, its instance and the ray.
namespace tandem::conformance {
namespace {

using rhi::GeometryFlags;
using rhi::InstanceFlags;

/// A triangle whose front or back the ray sees, or a box.
enum class Target { front, back, box };
/// What becomes of it.
enum class Fate { culled, candidate, committed };

std::string_view name_of(Fate fate) {
  switch (fate) {
    case Fate::culled:
      return "culled";
    case Fate::candidate:
      return "a candidate";
    case Fate::committed:
      return "committed at once";
  }
  return "";
}

struct Situation {
  Target target = Target::front;
  GeometryFlags geometry = GeometryFlags::opaque;
  InstanceFlags instance = InstanceFlags::none;
  std::uint32_t ray = ray_flags::none;
};

/// The rules of the specification: Vulkan, "Ray Traversal", sections on culling and opacity.
Fate expected_fate(const Situation& situation) {
  const auto ray_has = [&](std::uint32_t flag) { return (situation.ray & flag) != 0; };
  bool opaque = situation.geometry == GeometryFlags::opaque;
  if (has(situation.instance, InstanceFlags::force_opaque)) opaque = true;
  if (has(situation.instance, InstanceFlags::force_no_opaque)) opaque = false;
  if (ray_has(ray_flags::opaque)) opaque = true;
  if (ray_has(ray_flags::no_opaque)) opaque = false;
  if (ray_has(opaque ? ray_flags::cull_opaque : ray_flags::cull_no_opaque)) return Fate::culled;
  if (situation.target == Target::box) return ray_has(ray_flags::skip_boxes) ? Fate::culled : Fate::candidate;
  if (ray_has(ray_flags::skip_triangles)) return Fate::culled;
  const bool front =
      (situation.target == Target::front) != has(situation.instance, InstanceFlags::triangle_flip_facing);
  if (!has(situation.instance, InstanceFlags::triangle_facing_cull_disable) &&
      ray_has(front ? ray_flags::cull_front_facing : ray_flags::cull_back_facing))
    return Fate::culled;
  return opaque ? Fate::committed : Fate::candidate;
}

void check_fate(std::string_view what, const Traversal& seen, Fate expected) {
  const Fate fate = seen.hit() ? Fate::committed : (seen.candidate_count > 0 ? Fate::candidate : Fate::culled);
  if (fate != expected) throw Failure(fmt::format("{} is {}, expected {}", what, name_of(fate), name_of(expected)));
}

rhi::Geometry geometry_of(rhi::Device& device, Target target, GeometryFlags flags) {
  std::vector<glm::vec3> corners = triangle_at({0, 0, 0});
  if (target == Target::back) std::swap(corners[1], corners[2]);
  if (target == Target::box) return boxes(device, {Box{}}, flags);
  return triangles(device, corners, flags);
}

void check_situation(Context& context, const Situation& situation, Fate expected) {
  check(expected == expected_fate(situation), "the case contradicts the rules");
  const Scene scene =
      build_scene(context.device(), {geometry_of(context.device(), situation.target, situation.geometry)}, identity,
                  situation.instance);
  check_fate("the primitive", trace(context, scene.top_level, Ray{.flags = situation.ray}), expected);
}

void add_ray_flag_cases(const Group& group) {
  const auto add = [&](const char* name, const char* behaviour, const Situation& situation, Fate fate) {
    group.add(name, behaviour, [=](Context& context) { check_situation(context, situation, fate); });
  };
  const GeometryFlags clear = GeometryFlags::none;
  const GeometryFlags solid = GeometryFlags::opaque;
  add("none_opaque", "without flags an opaque triangle is committed", {}, Fate::committed);
  add("none_not_opaque", "without flags a triangle that is not opaque is a candidate", {.geometry = clear},
      Fate::candidate);
  add("none_back_face", "without flags a back face is met like a front face", {.target = Target::back},
      Fate::committed);
  add("opaque", "Opaque commits a triangle that is not opaque", {.geometry = clear, .ray = ray_flags::opaque},
      Fate::committed);
  add("no_opaque", "NoOpaque makes an opaque triangle a candidate", {.ray = ray_flags::no_opaque}, Fate::candidate);
  add("cull_opaque_opaque", "CullOpaque culls an opaque triangle", {.ray = ray_flags::cull_opaque}, Fate::culled);
  add("cull_opaque_not_opaque", "CullOpaque keeps a triangle that is not opaque",
      {.geometry = clear, .ray = ray_flags::cull_opaque}, Fate::candidate);
  add("cull_no_opaque_opaque", "CullNoOpaque keeps an opaque triangle", {.ray = ray_flags::cull_no_opaque},
      Fate::committed);
  add("cull_no_opaque_not_opaque", "CullNoOpaque culls a triangle that is not opaque",
      {.geometry = clear, .ray = ray_flags::cull_no_opaque}, Fate::culled);
  add("cull_back_back", "CullBackFacingTriangles culls a back face",
      {.target = Target::back, .ray = ray_flags::cull_back_facing}, Fate::culled);
  add("cull_back_front", "CullBackFacingTriangles keeps a front face", {.ray = ray_flags::cull_back_facing},
      Fate::committed);
  add("cull_front_front", "CullFrontFacingTriangles culls a front face", {.ray = ray_flags::cull_front_facing},
      Fate::culled);
  add("cull_front_back", "CullFrontFacingTriangles keeps a back face",
      {.target = Target::back, .ray = ray_flags::cull_front_facing}, Fate::committed);
  add("cull_back_candidate", "CullBackFacingTriangles culls a back face that is not opaque",
      {.target = Target::back, .geometry = clear, .ray = ray_flags::cull_back_facing}, Fate::culled);
  add("cull_front_candidate", "CullFrontFacingTriangles culls a front face that is not opaque",
      {.geometry = clear, .ray = ray_flags::cull_front_facing}, Fate::culled);
  add("skip_triangles", "SkipTriangles culls a triangle", {.ray = ray_flags::skip_triangles}, Fate::culled);
  add("skip_boxes_triangle", "SkipAABB keeps a triangle", {.ray = ray_flags::skip_boxes}, Fate::committed);
  add("skip_boxes", "SkipAABB culls a box", {.target = Target::box, .ray = ray_flags::skip_boxes}, Fate::culled);
  add("skip_triangles_box", "SkipTriangles keeps a box", {.target = Target::box, .ray = ray_flags::skip_triangles},
      Fate::candidate);
  add("opaque_box", "Opaque leaves a box a candidate",
      {.target = Target::box, .geometry = clear, .ray = ray_flags::opaque}, Fate::candidate);
  add("cull_opaque_box", "CullOpaque culls a box of an opaque geometry",
      {.target = Target::box, .geometry = solid, .ray = ray_flags::cull_opaque}, Fate::culled);
  add("cull_opaque_box_not_opaque", "CullOpaque keeps a box of a geometry that is not opaque",
      {.target = Target::box, .geometry = clear, .ray = ray_flags::cull_opaque}, Fate::candidate);
  add("cull_no_opaque_box", "CullNoOpaque culls a box of a geometry that is not opaque",
      {.target = Target::box, .geometry = clear, .ray = ray_flags::cull_no_opaque}, Fate::culled);
  add("cull_facing_box", "culling by facing keeps boxes", {.target = Target::box, .ray = ray_flags::cull_back_facing},
      Fate::candidate);
}

void add_instance_flag_cases(const Group& group) {
  const auto add = [&](const char* name, const char* behaviour, const Situation& situation, Fate fate) {
    group.add(name, behaviour, [=](Context& context) { check_situation(context, situation, fate); });
  };
  const GeometryFlags clear = GeometryFlags::none;
  add("force_opaque", "the instance's force_opaque overrides the geometry",
      {.geometry = clear, .instance = InstanceFlags::force_opaque}, Fate::committed);
  add("force_no_opaque", "the instance's force_no_opaque overrides the geometry",
      {.instance = InstanceFlags::force_no_opaque}, Fate::candidate);
  add("ray_over_force_opaque", "the ray's NoOpaque overrides the instance's force_opaque",
      {.instance = InstanceFlags::force_opaque, .ray = ray_flags::no_opaque}, Fate::candidate);
  add("ray_over_force_no_opaque", "the ray's Opaque overrides the instance's force_no_opaque",
      {.instance = InstanceFlags::force_no_opaque, .ray = ray_flags::opaque}, Fate::committed);
  add("cull_forced_opaque", "CullOpaque culls what the instance makes opaque",
      {.geometry = clear, .instance = InstanceFlags::force_opaque, .ray = ray_flags::cull_opaque}, Fate::culled);
  add("cull_forced_no_opaque", "CullNoOpaque culls what the instance makes not opaque",
      {.instance = InstanceFlags::force_no_opaque, .ray = ray_flags::cull_no_opaque}, Fate::culled);
  add("flip_facing_front", "flip_facing makes a front face culled as a back face",
      {.instance = InstanceFlags::triangle_flip_facing, .ray = ray_flags::cull_back_facing}, Fate::culled);
  add("flip_facing_back", "flip_facing makes a back face culled as a front face",
      {.target = Target::back, .instance = InstanceFlags::triangle_flip_facing, .ray = ray_flags::cull_front_facing},
      Fate::culled);
  add("cull_disable_back", "facing_cull_disable keeps a back face from being culled",
      {.target = Target::back,
       .instance = InstanceFlags::triangle_facing_cull_disable,
       .ray = ray_flags::cull_back_facing},
      Fate::committed);
  add("cull_disable_front", "facing_cull_disable keeps a front face from being culled",
      {.instance = InstanceFlags::triangle_facing_cull_disable, .ray = ray_flags::cull_front_facing}, Fate::committed);
  for (const Target target : {Target::front, Target::back}) {
    group.add(
        target == Target::front ? "flip_facing_getter_front" : "flip_facing_getter_back",
        "flip_facing exchanges what the front face getter says", [target](Context& context) {
          for (const InstanceFlags flags : {InstanceFlags::none, InstanceFlags::triangle_flip_facing}) {
            const Scene scene = build_scene(
                context.device(), {geometry_of(context.device(), target, GeometryFlags::opaque)}, identity, flags);
            const bool front = (target == Target::front) != (flags == InstanceFlags::triangle_flip_facing);
            check_equal("the front face", trace(context, scene.top_level, Ray{}).committed.front_face, front ? 1u : 0u);
          }
        });
  }
}

/// All flags that may be combined: at most one that decides on opacity, and at most one of those that cull triangles.
std::vector<std::uint32_t> ray_flag_combinations() {
  std::vector<std::uint32_t> combinations;
  for (const std::uint32_t opacity :
       {ray_flags::none, ray_flags::opaque, ray_flags::no_opaque, ray_flags::cull_opaque, ray_flags::cull_no_opaque})
    for (const std::uint32_t kind :
         {ray_flags::none, ray_flags::cull_back_facing, ray_flags::cull_front_facing, ray_flags::skip_triangles,
          ray_flags::skip_boxes, ray_flags::skip_boxes | ray_flags::cull_back_facing,
          ray_flags::skip_boxes | ray_flags::cull_front_facing})
      for (const std::uint32_t end : {ray_flags::none, ray_flags::terminate_on_first_hit})
        combinations.push_back(opacity | kind | end);
  return combinations;
}

std::vector<InstanceFlags> instance_flag_combinations() {
  std::vector<InstanceFlags> combinations;
  for (const InstanceFlags opacity : {InstanceFlags::none, InstanceFlags::force_opaque, InstanceFlags::force_no_opaque})
    for (std::uint32_t facing = 0; facing < 4; ++facing)
      combinations.push_back(opacity | static_cast<InstanceFlags>(facing));
  return combinations;
}

/// Every combination of flags of ray, instance and geometry on one kind of target.
void check_all_combinations(Context& context, Target target) {
  rhi::Device& device = context.device();
  std::vector<rhi::AccelerationStructureHandle> bottom_levels;
  std::vector<rhi::InstanceDesc> instances;
  std::vector<Situation> situations;
  std::vector<Ray> rays;
  for (const GeometryFlags geometry : {GeometryFlags::none, GeometryFlags::opaque}) {
    bottom_levels.push_back(build_bottom_level(device, {geometry_of(device, target, geometry)}));
    for (const InstanceFlags instance : instance_flag_combinations()) {
      const float x = 4 * static_cast<float>(instances.size());
      instances.push_back(rhi::make_instance(*bottom_levels.back(), translation(x, 0, 0)));
      instances.back().flags = static_cast<std::uint32_t>(instance) & 0xff;
      for (const std::uint32_t ray : ray_flag_combinations()) {
        situations.push_back({target, geometry, instance, ray});
        rays.push_back({.origin = {x + 0.25f, 0.25f, 5}, .flags = ray});
      }
    }
  }
  const std::vector<Traversal> seen = trace(context, build_top_level(device, instances), rays);
  for (std::size_t i = 0; i < rays.size(); ++i)
    check_fate(fmt::format("with geometry flags {:#x}, instance flags {:#x} and ray flags {:#x} the primitive",
                           static_cast<std::uint32_t>(situations[i].geometry),
                           static_cast<std::uint32_t>(situations[i].instance), situations[i].ray),
               seen[i], expected_fate(situations[i]));
}

}  // namespace

void add_ray_query_flag_cases(Cases& cases) {
  const Group group = {cases, "ray_query.cull_ray_flags"};
  add_ray_flag_cases(group);
  group.add("all_combinations_front", "front faces: all flags of ray, instance and geometry that may be combined",
            [](Context& context) { check_all_combinations(context, Target::front); });
  group.add("all_combinations_back", "back faces: all flags of ray, instance and geometry that may be combined",
            [](Context& context) { check_all_combinations(context, Target::back); });
  group.add("all_combinations_boxes", "boxes: all flags of ray, instance and geometry that may be combined",
            [](Context& context) { check_all_combinations(context, Target::box); });
  add_instance_flag_cases({cases, "ray_query.instance_flags"});
}

}  // namespace tandem::conformance
