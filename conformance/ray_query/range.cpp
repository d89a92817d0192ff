#include <algorithm>
#include <limits>

#include "conformance/kit/cases.hpp"
#include "conformance/kit/check.hpp"
#include "conformance/ray_query/probe.hpp"

/// ray_query.t_range, ray_query.direction_length and ray_query.cull_mask: which part of a line a ray is, and which
/// instances it sees.
namespace tandem::conformance {
namespace {

/// Triangles at z = 0 and z = 1, met at t = 5 and t = 4.
Scene two_layers(rhi::Device& device) {
  std::vector<glm::vec3> vertices = triangle_at({0, 0, 0});
  for (const glm::vec3& corner : triangle_at({0, 0, 1})) vertices.push_back(corner);
  return build_scene(device, {triangles(device, vertices)});
}

void add_range_cases(const Group& group) {
  const auto add = [&](const char* name, const char* behaviour, float t_min, float t_max, std::uint32_t primitive) {
    group.add(name, behaviour, [=](Context& context) {
      const Scene scene = two_layers(context.device());
      const Traversal seen = trace(context, scene.top_level, Ray{.t_min = t_min, .t_max = t_max});
      if (primitive == any) {
        check_miss("the ray", seen);
      } else {
        check_triangle("the ray", seen, {.primitive = primitive}, primitive == 1 ? 4 : 5);
      }
    });
  };
  const float infinity = std::numeric_limits<float>::infinity();
  add("all", "a ray meets the nearest triangle between its t_min and t_max", 0, 100, 1);
  add("ends_before", "a ray that ends in front of a triangle misses it", 0, 3.999f, any);
  add("ends_behind", "a ray that ends just behind a triangle meets it", 0, 4.001f, 1);
  add("begins_behind", "a ray that begins just behind a triangle meets the next", 4.001f, 100, 0);
  add("begins_before", "a ray that begins just in front of a triangle meets it", 3.999f, 100, 1);
  add("begins_behind_all", "a ray that begins behind every triangle misses", 5.001f, 100, any);
  add("between", "a ray that begins and ends between triangles misses", 4.25f, 4.75f, any);
  // A device may round t: what counts is the t that it reports itself.
  const auto add_excluded = [&](const char* name, const char* behaviour, bool is_maximum) {
    group.add(name, behaviour, [is_maximum](Context& context) {
      const Scene scene = two_layers(context.device());
      const float t = trace(context, scene.top_level, Ray{.t_max = 100}).committed.t;
      const Ray ray = is_maximum ? Ray{.t_max = t} : Ray{.t_min = t, .t_max = 100};
      const Traversal seen = trace(context, scene.top_level, ray);
      if (is_maximum)
        check_miss("the ray", seen);
      else
        check_triangle("the ray", seen, {.primitive = 0}, 5);
    });
  };
  add_excluded("t_max_excluded", "a triangle at exactly t_max is not met", true);
  add_excluded("t_min_excluded", "a triangle at exactly t_min is not met", false);
  add("empty", "a ray whose t_min is its t_max meets nothing", 4, 4, any);
  add("t_max_infinite", "a ray may end at infinity", 0, infinity, 1);
  add("t_max_largest", "a ray may end at the largest number", 0, std::numeric_limits<float>::max(), 1);
  group.add("behind_origin", "what lies behind the origin is not met", [](Context& context) {
    const Scene scene = two_layers(context.device());
    check_miss("the ray", trace(context, scene.top_level, Ray{.direction = {0, 0, 1}}));
  });
  group.add("origin_on_triangle", "a ray with t_min 0 does not meet the triangle that it begins on",
            [](Context& context) {
              const Scene scene = two_layers(context.device());
              check_triangle("the ray", trace(context, scene.top_level, Ray{.origin = {0.25f, 0.25f, 1}}),
                             {.primitive = 0}, 1);
            });
}

void add_length_cases(const Group& group) {
  const auto add = [&](const char* name, const char* behaviour, float length) {
    group.add(name, behaviour, [length](Context& context) {
      const Scene scene = two_layers(context.device());
      const float unit = 1 / length;
      const auto with_range = [&](float t_min, float t_max) {
        return Ray{.t_min = t_min * unit, .direction = {0, 0, -length}, .t_max = t_max * unit};
      };
      const std::vector<Traversal> seen =
          trace(context, scene.top_level, {with_range(0, 100), with_range(4.5f, 100), with_range(0, 3.5f)});
      check_triangle("the ray", seen[0], {.primitive = 1}, 4.0 / length);
      check_triangle("the ray with a t_min", seen[1], {.primitive = 0}, 5.0 / length);
      check_miss("the ray with a t_max", seen[2]);
      for (int i = 0; i < 2; ++i) check_close("a barycentric", seen[0].committed.barycentrics[i], 0.25, 1);
    });
  };
  add("unit", "t is the distance where the direction has length 1", 1);
  add("half", "t, t_min and t_max count in lengths of the direction: 1/2", 0.5f);
  add("three", "t, t_min and t_max count in lengths of the direction: 3", 3);
  add("thousand", "t, t_min and t_max count in lengths of the direction: 1000", 1000);
  add("thousandth", "t, t_min and t_max count in lengths of the direction: 1/1000", 1e-3f);
  add("huge", "t, t_min and t_max count in lengths of the direction: 1e6", 1e6f);
  add("tiny", "t, t_min and t_max count in lengths of the direction: 1e-6", 1e-6f);
  group.add("oblique", "t of a ray in general direction counts in its length", [](Context& context) {
    const Scene scene = two_layers(context.device());
    // From (0.25, 0.25, 1) two and a half directions back.
    const glm::vec3 direction(3, -7, -11);
    const Ray ray = {.origin = glm::vec3(0.25f, 0.25f, 1) - 2.5f * direction, .direction = direction};
    check_triangle("the ray", trace(context, scene.top_level, ray), {.primitive = 1}, 2.5);
  });
  group.add("box", "boxes are offered whatever the direction's length, and t counts in it", [](Context& context) {
    const Scene scene = build_scene(context.device(), {boxes(context.device(), {Box{}})});
    for (const float length : {1e-3f, 0.5f, 1e3f}) {
      const Ray ray = {.direction = {0, 0, -length},
                       .t_max = 100 / length,
                       .decisions = {{.actions = action::generate, .t = 4.5f / length}}};
      check_generated("the ray", trace(context, scene.top_level, ray), {}, 4.5f / length);
    }
  });
  group.add("scaled_instance", "the instance's scale does not change t", [](Context& context) {
    for (const float scale : {0.125f, 8.0f}) {
      const Scene scene = build_scene(context.device(), {triangles(context.device(), triangle_at({0, 0, 0}))},
                                      {scale, 0, 0, 0, 0, scale, 0, 0, 0, 0, scale, 0});
      const Ray ray = {.origin = {0.25f * scale, 0.25f * scale, 5}, .direction = {0, 0, -2}};
      check_triangle("the ray", trace(context, scene.top_level, ray), {}, 2.5);
    }
  });
}

void add_mask_cases(const Group& group) {
  group.add("each_pair",
            "an instance is met where its mask and the ray's share a bit: all pairs of single bits and 256 "
            "masks of rays",
            [](Context& context) {
              rhi::Device& device = context.device();
              const rhi::AccelerationStructureHandle bottom_level =
                  build_bottom_level(device, {triangles(device, triangle_at({0, 0, 0}))});
              std::vector<rhi::InstanceDesc> instances;
              std::vector<Ray> rays;
              for (std::uint32_t bit = 0; bit < 8; ++bit) {
                const float x = 2 * static_cast<float>(bit);
                instances.push_back(rhi::make_instance(*bottom_level, translation(x, 0, 0)));
                instances.back().mask = (1u << bit) & 0xff;
                for (std::uint32_t mask = 0; mask < 256; ++mask)
                  rays.push_back({.origin = {x + 0.25f, 0.25f, 5}, .mask = mask});
              }
              const std::vector<Traversal> seen = trace(context, build_top_level(device, instances), rays);
              for (std::uint32_t i = 0; i < rays.size(); ++i)
                check_equal(
                    fmt::format("whether mask {:#x} meets an instance of mask {:#x}", rays[i].mask, 1u << (i / 256)),
                    seen[i].hit(), (rays[i].mask & (1u << (i / 256))) != 0);
            });
  const auto add = [&](const char* name, const char* behaviour, std::uint32_t instance_mask, std::uint32_t ray_mask,
                       bool hit) {
    group.add(name, behaviour, [=](Context& context) {
      rhi::Device& device = context.device();
      const rhi::AccelerationStructureHandle bottom_level =
          build_bottom_level(device, {triangles(device, triangle_at({0, 0, 0}))});
      rhi::InstanceDesc instance = rhi::make_instance(*bottom_level);
      instance.mask = instance_mask & 0xff;
      const Traversal seen = trace(context, build_top_level(device, {instance}), Ray{.mask = ray_mask});
      check_equal("whether the ray meets the instance", seen.hit(), hit);
    });
  };
  add("instance_zero", "an instance with mask 0 is never met", 0, 0xff, false);
  add("ray_zero", "a ray with mask 0 meets nothing", 0xff, 0, false);
  add("ray_upper_bits", "only the lower eight bits of a ray's mask count", 0xff, 0xffffff00, false);
  add("ray_upper_bits_with_lower", "upper bits of a ray's mask do not hide the lower", 0x10, 0xabcdef10, true);
  group.add("nearest_seen", "an instance in front that the mask hides does not hide one behind", [](Context& context) {
    rhi::Device& device = context.device();
    const rhi::AccelerationStructureHandle bottom_level =
        build_bottom_level(device, {triangles(device, triangle_at({0, 0, 0}))});
    std::vector<rhi::InstanceDesc> instances = {rhi::make_instance(*bottom_level, translation(0, 0, 2)),
                                                rhi::make_instance(*bottom_level)};
    instances[0].mask = 1;
    instances[1].mask = 2;
    check_triangle("the ray", trace(context, build_top_level(device, instances), Ray{.mask = 2}), {.instance = 1}, 5);
  });
  group.add("boxes", "masks hide instances of boxes too", [](Context& context) {
    rhi::Device& device = context.device();
    const rhi::AccelerationStructureHandle bottom_level = build_bottom_level(device, {boxes(device, {Box{}})});
    rhi::InstanceDesc instance = rhi::make_instance(*bottom_level);
    instance.mask = 0x40;
    const rhi::AccelerationStructureHandle scene = build_top_level(device, {instance});
    const std::vector<Decision> generate = {{.actions = action::generate, .t = 4.5f}};
    check_miss("the ray of mask 0xbf", trace(context, scene, Ray{.mask = 0xbf, .decisions = generate}));
    check_generated("the ray of mask 0x40", trace(context, scene, Ray{.mask = 0x40, .decisions = generate}), {}, 4.5f);
  });
}

}  // namespace

void add_ray_query_range_cases(Cases& cases) {
  add_range_cases({cases, "ray_query.t_range"});
  add_length_cases({cases, "ray_query.direction_length"});
  add_mask_cases({cases, "ray_query.cull_mask"});
}

}  // namespace tandem::conformance
