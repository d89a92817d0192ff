#include <array>
#include <utility>

#include "conformance/kit/check.hpp"
#include "conformance/pipeline/cases.hpp"
#include "conformance/pipeline/stack.hpp"

// Rays traced from closest-hit and miss shaders. Vulkan: maxPipelineRayRecursionDepth, VkPhysicalDeviceRayTracing-
// PipelinePropertiesKHR::maxRayRecursionDepth.
namespace tandem::conformance {
namespace {

using namespace pipeline;

// A ray goes down a stack of triangles: each closest-hit shader traces on from its hit, until `depth` rays are in
// flight. The payload says how deep it is and how deep to go, and gathers what the levels say on the way back.
const std::string payload_declaration = R"(
struct Payload { uint depth; uint last_depth; uint path; uint sum; };
layout(set = 0, binding = 0) uniform accelerationStructureEXT scene;
)";

const std::string generation_text = payload_declaration + R"(
layout(set = 0, binding = 1, std430) readonly buffer Inputs { uint depths[]; };
layout(set = 0, binding = 2, std430) writeonly buffer Results { uvec4 results[]; };
layout(location = 0) rayPayloadEXT Payload payload;
void main() {
  payload = Payload(1u, depths[gl_LaunchIDEXT.x], 0u, 0u);
  if (payload.last_depth > 0u)
    traceRayEXT(scene, 0u, 0xffu, 0u, 0u, 0u, vec3(0.25, 0.25, 5.0), 0.0, vec3(0.0, 0.0, -1.0), 100.0, 0);
  results[gl_LaunchIDEXT.x] = uvec4(payload.depth, payload.last_depth, payload.path, payload.sum);
}
)";

/// Traces on and keeps what it knew before: locals, built-ins and its own payload survive.
const std::string closest_hit_text = payload_declaration + R"(
layout(location = 0) rayPayloadInEXT Payload incoming;
layout(location = 1) rayPayloadEXT Payload outgoing;
hitAttributeEXT vec2 barycentrics;
void main() {
  uint primitive = uint(gl_PrimitiveID);
  float x = barycentrics.x;
  float t = gl_HitTEXT;
  incoming.path = incoming.path * 10u + primitive + 1u;
  if (incoming.depth < incoming.last_depth) {
    outgoing = incoming;
    ++outgoing.depth;
    vec3 hit = gl_WorldRayOriginEXT + gl_HitTEXT * gl_WorldRayDirectionEXT;
    traceRayEXT(scene, 0u, 0xffu, 0u, 0u, 0u, hit, 0.5, vec3(0.0, 0.0, -1.0), 100.0, 1);
    incoming.path = outgoing.path;
    incoming.sum = outgoing.sum;
  }
  bool kept = primitive == uint(gl_PrimitiveID) && x == barycentrics.x && t == gl_HitTEXT;
  incoming.sum = incoming.sum * 10u + (kept ? primitive + 1u : 9u);
}
)";

const std::string miss_text = R"(
struct Payload { uint depth; uint last_depth; uint path; uint sum; };
layout(location = 0) rayPayloadInEXT Payload payload;
void main() { payload.path = payload.path * 10u + 9u; }
)";

/// 123...n and n...321.
std::uint32_t ascending(std::uint32_t n) {
  std::uint32_t number = 0;
  for (std::uint32_t i = 1; i <= n; ++i) number = number * 10 + i;
  return number;
}
std::uint32_t descending(std::uint32_t n) {
  std::uint32_t number = 0;
  for (std::uint32_t i = n; i >= 1; --i) number = number * 10 + i;
  return number;
}

void recurse(Context& context, std::uint32_t depth) {
  rhi::Device& device = context.device();
  const std::uint32_t limit = device.info().limits.max_ray_recursion_depth;
  if (limit < depth) throw Unsupported(fmt::format("max_ray_recursion_depth is {}, {} needed", limit, depth));
  const Scene scene = build_scene(device, {stacked_triangles(device, 8, rhi::GeometryFlags::opaque)});
  Launch launch;
  launch.scene = scene.top_level;
  std::vector<std::uint32_t> depths;
  for (std::uint32_t i = 0; i <= depth; ++i) depths.push_back(i);
  launch.buffers = {buffer_of(device, depths, "depths")};
  launch.trace.size = {depth + 1, 1, 1};
  const auto results = results_of<std::array<std::uint32_t, 4>>(context,
                                                                {.ray_generation = {generation_text},
                                                                 .miss = {miss_text},
                                                                 .hit_groups = {{.closest_hit = closest_hit_text}},
                                                                 .max_recursion_depth = depth},
                                                                launch, depth + 1, "recursion");
  for (std::uint32_t i = 0; i <= depth; ++i) {
    check_equal(fmt::format("the primitives hit on the way down {} rays", i), results[i][2], ascending(i));
    check_equal(fmt::format("what {} shaders knew after their ray", i), results[i][3], descending(i));
    check_equal("the first payload's depth", results[i][0], 1u);
  }
}

void trace_from_miss(Context& context) {
  // The ray from the ray generation shader misses; the miss shader traces another one, which hits.
  rhi::Device& device = context.device();
  if (device.info().limits.max_ray_recursion_depth < 2) throw Unsupported("max_ray_recursion_depth is 1, 2 needed");
  const std::string head = "layout(set = 0, binding = 0) uniform accelerationStructureEXT scene;\n";
  const std::string generation = head + R"(
layout(set = 0, binding = 1, std430) writeonly buffer Results { uint results[]; };
layout(location = 0) rayPayloadEXT uint payload;
void main() {
  payload = 1u;
  traceRayEXT(scene, 0u, 0xffu, 0u, 0u, 0u, vec3(-9.0, 0.0, 5.0), 0.0, vec3(0.0, 0.0, -1.0), 100.0, 0);
  results[0] = payload;
}
)";
  const std::string tracing_miss = head + R"(
layout(location = 0) rayPayloadInEXT uint incoming;
layout(location = 1) rayPayloadEXT uint outgoing;
void main() {
  outgoing = 7u;
  traceRayEXT(scene, 0u, 0xffu, 0u, 0u, 1u, vec3(0.25, 0.25, 5.0), 0.0, vec3(0.0, 0.0, -1.0), 100.0, 1);
  incoming = incoming * 1000u + outgoing;
  traceRayEXT(scene, 0u, 0xffu, 0u, 0u, 1u, vec3(-9.0, 0.25, 5.0), 0.0, vec3(0.0, 0.0, -1.0), 100.0, 1);
  incoming = incoming * 1000u + outgoing;
}
)";
  const std::string in = "layout(location = 0) rayPayloadInEXT uint payload;\n";
  const Scene scene = build_scene(device, {stacked_triangles(device, 1, rhi::GeometryFlags::opaque)});
  Launch launch;
  launch.scene = scene.top_level;
  const auto results =
      results_of<std::uint32_t>(context,
                                {.ray_generation = {generation},
                                 .miss = {tracing_miss, in + "void main() { payload *= 3u; }\n"},
                                 .hit_groups = {{.closest_hit = in + "void main() { payload += 100u; }\n"}},
                                 .max_recursion_depth = 2},
                                launch, 1, "trace from miss");
  check_equal("the payload", results[0], 1107321u);
}

void payload_passed_on(Context& context) {
  // A closest-hit shader traces with the payload that it got.
  rhi::Device& device = context.device();
  if (device.info().limits.max_ray_recursion_depth < 2) throw Unsupported("max_ray_recursion_depth is 1, 2 needed");
  const std::string head = "layout(set = 0, binding = 0) uniform accelerationStructureEXT scene;\n";
  const std::string generation = head + R"(
layout(set = 0, binding = 1, std430) writeonly buffer Results { uvec3 results[]; };
layout(location = 0) rayPayloadEXT uvec3 payload;
void main() {
  payload = uvec3(1u, 2u, 3u);
  traceRayEXT(scene, 0u, 0xffu, 0u, 0u, 0u, vec3(0.25, 0.25, 5.0), 0.0, vec3(0.0, 0.0, -1.0), 100.0, 0);
  results[0] = payload;
}
)";
  const std::string closest_hit = head + R"(
layout(location = 0) rayPayloadInEXT uvec3 payload;
void main() {
  payload.x += 10u;
  traceRayEXT(scene, 0u, 0xffu, 0u, 0u, 0u, vec3(-9.0, 0.25, 5.0), 0.0, vec3(0.0, 0.0, -1.0), 100.0, 0);
  payload.z += payload.y;
}
)";
  const std::string miss =
      "layout(location = 0) rayPayloadInEXT uvec3 payload;\nvoid main() { payload.y = payload.x * 2u; }\n";
  const Scene scene = build_scene(device, {stacked_triangles(device, 1, rhi::GeometryFlags::opaque)});
  Launch launch;
  launch.scene = scene.top_level;
  const auto results = results_of<std::array<std::uint32_t, 4>>(context,
                                                                {.ray_generation = {generation},
                                                                 .miss = {miss},
                                                                 .hit_groups = {{.closest_hit = closest_hit}},
                                                                 .max_recursion_depth = 2},
                                                                launch, 1, "payload passed on");
  check_equal("the first component", results[0][0], 11u);
  check_equal("the second component", results[0][1], 22u);
  check_equal("the third component", results[0][2], 25u);
}

void sibling_rays(Context& context) {
  // One shader after another traces two rays, the second after the first came back: a binary tree of depth 3.
  rhi::Device& device = context.device();
  if (device.info().limits.max_ray_recursion_depth < 3)
    throw Unsupported(
        fmt::format("max_ray_recursion_depth is {}, 3 needed", device.info().limits.max_ray_recursion_depth));
  const std::string head = R"(
struct Payload { uint depth; uint leaves; };
layout(set = 0, binding = 0) uniform accelerationStructureEXT scene;
)";
  const std::string generation = head + R"(
layout(set = 0, binding = 1, std430) writeonly buffer Results { uint results[]; };
layout(location = 0) rayPayloadEXT Payload payload;
void main() {
  payload = Payload(0u, 0u);
  traceRayEXT(scene, 0u, 0xffu, 0u, 0u, 0u, vec3(0.25, 0.25, 5.0), 0.0, vec3(0.0, 0.0, -1.0), 100.0, 0);
  results[gl_LaunchIDEXT.x] = payload.leaves;
}
)";
  const std::string closest_hit = head + R"(
layout(location = 0) rayPayloadInEXT Payload incoming;
layout(location = 1) rayPayloadEXT Payload outgoing;
void main() {
  if (incoming.depth == 2u) { incoming.leaves = 1u + uint(gl_PrimitiveID); return; }
  uint leaves = 0u;
  for (uint side = 0u; side < 2u; ++side) {
    outgoing = Payload(incoming.depth + 1u, 0u);
    float z = 4.5 - float(incoming.depth) - float(side);
    traceRayEXT(scene, 0u, 0xffu, 0u, 0u, 0u, vec3(0.25, 0.25, z), 0.0, vec3(0.0, 0.0, -1.0), 100.0, 1);
    leaves = leaves * 10u + outgoing.leaves;
  }
  incoming.leaves = leaves;
}
)";
  // Triangle i lies at z = 4 - i: from z = 4.5 - k a ray meets triangle k.
  const Scene scene = build_scene(device, {stacked_triangles(device, 8, rhi::GeometryFlags::opaque, 4)});
  Launch launch;
  launch.scene = scene.top_level;
  launch.trace.size = {64, 1, 1};
  const auto results = results_of<std::uint32_t>(context,
                                                 {.ray_generation = {generation},
                                                  .miss = {miss_text},
                                                  .hit_groups = {{.closest_hit = closest_hit}},
                                                  .max_recursion_depth = 3},
                                                 launch, 64, "sibling rays");
  // At depth 1 the sides start at z = 3.5 and 2.5 and meet triangles 1 and 2, whose leaves are 2 and 3.
  for (std::size_t i = 0; i < results.size(); ++i)
    check_equal(fmt::format("the leaves of invocation {}", i), results[i], (2u * 10 + 3) * 10 + (2u * 10 + 3));
}

}  // namespace

void add_pipeline_recursion_cases(Cases& cases) {
  const Group group{
      .cases = cases, .name = "ray_tracing_pipeline.recursion", .needs = {&rhi::Capabilities::ray_tracing_pipeline}};
  for (const std::uint32_t depth : {1u, 2u, 4u, 8u})
    group.add(fmt::format("depth_{}", depth),
              fmt::format("{} rays are in flight at once, and shaders keep what they knew before they traced", depth),
              [depth](Context& context) { recurse(context, depth); });
  group.add("trace_from_miss", "a miss shader traces rays", trace_from_miss);
  group.add("payload_passed_on", "a closest-hit shader traces with the payload that it got", payload_passed_on);
  group.add("sibling_rays", "shaders trace several rays one after the other at every depth", sibling_rays);
}

}  // namespace tandem::conformance
