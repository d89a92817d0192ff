#include <algorithm>
#include <array>

#include "conformance/kit/cases.hpp"
#include "conformance/kit/check.hpp"
#include "conformance/ray_query/probe.hpp"

/// ray_query.multiple_ray_queries, ray_query.structures and ray_query.null_as: more than one query or structure in a
/// shader.
namespace tandem::conformance {
namespace {

constexpr std::uint32_t invocation_count = 32;
constexpr std::uint32_t layer_count = 3;

/// What the shaders below share. Invocation i has instance i of the scene to itself: candidate triangles 0, 1 and 2 at
/// t = 5, 4 and 3 of down(i).
const std::string prologue = R"(#version 460
#extension GL_EXT_ray_query : require
#extension GL_EXT_nonuniform_qualifier : enable
layout(local_size_x = 32) in;
layout(set = 0, binding = 0) uniform accelerationStructureEXT scene;
layout(set = 0, binding = 1, std430) writeonly buffer Results { uvec4 results[]; };
const uint NONE = 0xffffffffu;
vec3 down(uint i) { return vec3(2.0 * float(i) + 0.25, 0.25, 5.0); }
#define INITIALIZE(query, i) \
  rayQueryInitializeEXT(query, scene, 0u, 0xffu, down(i), 0.0, vec3(0.0, 0.0, -1.0), 100.0)
#define COMMITTED(query)                                                                            \
  (rayQueryGetIntersectionTypeEXT(query, true) == gl_RayQueryCommittedIntersectionNoneEXT           \
       ? NONE                                                                                       \
       : uint(rayQueryGetIntersectionInstanceIdEXT(query, true)) * 10u +                            \
             uint(rayQueryGetIntersectionPrimitiveIndexEXT(query, true)))
#define CONFIRM_ONLY(query, primitive)                                                              \
  if (uint(rayQueryGetIntersectionPrimitiveIndexEXT(query, false)) == (primitive)) rayQueryConfirmIntersectionEXT(query)
)";

constexpr std::uint32_t none = ~std::uint32_t{0};
using Answer = std::array<std::uint32_t, 4>;

/// What COMMITTED says.
constexpr std::uint32_t committed(std::uint32_t instance, std::uint32_t primitive) { return instance * 10 + primitive; }

Scene columns(rhi::Device& device, std::uint32_t count, float place = 0) {
  std::vector<glm::vec3> vertices;
  for (std::uint32_t layer = 0; layer < layer_count; ++layer)
    for (const glm::vec3& corner : triangle_at({place, 0, static_cast<float>(layer)})) vertices.push_back(corner);
  Scene scene;
  scene.bottom_level = build_bottom_level(device, {triangles(device, vertices, rhi::GeometryFlags::none)});
  std::vector<rhi::InstanceDesc> instances;
  for (std::uint32_t i = 0; i < count; ++i)
    instances.push_back(rhi::make_instance(*scene.bottom_level, translation(2 * static_cast<float>(i), 0, 0)));
  scene.top_level = build_top_level(device, instances);
  return scene;
}

std::vector<Answer> run_shader(Context& context, const std::string& source, const std::string& label,
                               const std::vector<rhi::BindGroupEntry>& structures) {
  rhi::Device& device = context.device();
  const rhi::ComputePipelineHandle pipeline = context.compute_pipeline(source, label);
  const rhi::BufferHandle results = buffer_of(device, std::vector<Answer>(invocation_count), "results");
  std::vector<rhi::BindGroupEntry> entries = structures;
  entries.push_back({.binding = 1, .resource = rhi::BufferRange{results}});
  const rhi::BindGroupHandle group =
      device.create_bind_group({.pipeline = pipeline, .entries = entries, .label = label});
  const rhi::CommandListHandle list = device.create_command_list(label);
  list->dispatch({.pipeline = pipeline, .bind_groups = {group}});
  device.submit(list);
  return rhi::read<Answer>(device, results, invocation_count);
}

/// Runs `body`, which is what follows the prologue, and compares what each invocation answers.
void check_shader(Context& context, const std::string& label, const std::string& body,
                  Answer (*expected)(std::uint32_t invocation)) {
  const Scene scene = columns(context.device(), invocation_count);
  const std::vector<Answer> seen =
      run_shader(context, prologue + body, label, {{.binding = 0, .resource = scene.top_level}});
  for (std::uint32_t i = 0; i < invocation_count; ++i)
    for (std::size_t j = 0; j < 4; ++j)
      check_equal(fmt::format("answer {} of invocation {}", j, i), seen[i][j], expected(i)[j]);
}

void add_multiple_cases(const Group& group) {
  const auto add = [&](const std::string& name, const char* behaviour, const char* body,
                       Answer (*expected)(std::uint32_t)) {
    group.add(name, behaviour, [=](Context& context) { check_shader(context, name, body, expected); });
  };
  add("interleaved", "two queries that proceed in turns do not disturb each other", R"(
void main() {
  uint i = gl_GlobalInvocationID.x;
  rayQueryEXT first;
  rayQueryEXT second;
  INITIALIZE(first, i);
  INITIALIZE(second, (i + 7u) % 32u);
  bool first_goes_on = true;
  bool second_goes_on = true;
  while (first_goes_on || second_goes_on) {
    if (first_goes_on) first_goes_on = rayQueryProceedEXT(first);
    if (first_goes_on) { CONFIRM_ONLY(first, 0u); }
    if (second_goes_on) second_goes_on = rayQueryProceedEXT(second);
    if (second_goes_on) { CONFIRM_ONLY(second, 1u); }
  }
  results[i] = uvec4(COMMITTED(first), COMMITTED(second), 0u, 0u);
}
)",
      [](std::uint32_t i) -> Answer {
        return {committed(i, 0), committed((i + 7) % 32, 1), 0, 0};
      });
  add("nested", "a query may be run to its end for each candidate of another", R"(
void main() {
  uint i = gl_GlobalInvocationID.x;
  rayQueryEXT outer;
  INITIALIZE(outer, i);
  uint inner_right = 1u;
  while (rayQueryProceedEXT(outer)) {
    uint primitive = uint(rayQueryGetIntersectionPrimitiveIndexEXT(outer, false));
    rayQueryEXT inner;
    INITIALIZE(inner, (i + primitive) % 32u);
    while (rayQueryProceedEXT(inner)) { CONFIRM_ONLY(inner, primitive); }
    if (COMMITTED(inner) != ((i + primitive) % 32u) * 10u + primitive) inner_right = 0u;
    CONFIRM_ONLY(outer, 1u);
  }
  results[i] = uvec4(COMMITTED(outer), inner_right, 0u, 0u);
}
)",
      [](std::uint32_t i) -> Answer {
        return {committed(i, 1), 1, 0, 0};
      });
  add("array", "queries may stand in an array that is indexed at run time", R"(
void main() {
  uint i = gl_GlobalInvocationID.x;
  rayQueryEXT queries[3];
  for (uint k = 0u; k < 3u; ++k) INITIALIZE(queries[k], (i + k) % 32u);
  for (uint k = 0u; k < 3u; ++k) {
    while (rayQueryProceedEXT(queries[k])) { CONFIRM_ONLY(queries[k], k); }
  }
  uvec4 answer = uvec4(0u);
  for (uint k = 0u; k < 3u; ++k) answer[k] = COMMITTED(queries[k]);
  results[i] = answer;
}
)",
      [](std::uint32_t i) -> Answer {
        return {committed(i, 0), committed((i + 1) % 32, 1), committed((i + 2) % 32, 2), 0};
      });
  add("function_argument", "a query may be passed to functions that proceed, decide and ask", R"(
void run(rayQueryEXT query, uint primitive) {
  while (rayQueryProceedEXT(query)) { CONFIRM_ONLY(query, primitive); }
}
uint answer_of(rayQueryEXT query) { return COMMITTED(query); }
void main() {
  uint i = gl_GlobalInvocationID.x;
  rayQueryEXT first;
  rayQueryEXT second;
  INITIALIZE(first, i);
  INITIALIZE(second, i);
  run(first, 2u);
  run(second, 0u);
  results[i] = uvec4(answer_of(first), answer_of(second), 0u, 0u);
}
)",
      [](std::uint32_t i) -> Answer {
        return {committed(i, 2), committed(i, 0), 0, 0};
      });
  add("global", "a query may be a global variable", R"(
rayQueryEXT query;
void run(uint primitive) {
  while (rayQueryProceedEXT(query)) { CONFIRM_ONLY(query, primitive); }
}
void main() {
  uint i = gl_GlobalInvocationID.x;
  INITIALIZE(query, i);
  run(1u);
  results[i] = uvec4(COMMITTED(query), 0u, 0u, 0u);
}
)",
      [](std::uint32_t i) -> Answer {
        return {committed(i, 1), 0, 0, 0};
      });
  add("initialised_again", "a query that is initialised again after its end forgets its hit", R"(
void main() {
  uint i = gl_GlobalInvocationID.x;
  uvec4 answer = uvec4(0u);
  rayQueryEXT query;
  for (uint k = 0u; k < 3u; ++k) {
    INITIALIZE(query, i);
    while (rayQueryProceedEXT(query)) {
      if (k != 1u) { CONFIRM_ONLY(query, k); }
    }
    answer[k] = COMMITTED(query);
  }
  results[i] = answer;
}
)",
      [](std::uint32_t i) -> Answer {
        return {committed(i, 0), none, committed(i, 2), 0};
      });
  add("abandoned", "a query that is initialised again before its end forgets its candidates and its hit", R"(
void main() {
  uint i = gl_GlobalInvocationID.x;
  rayQueryEXT query;
  INITIALIZE(query, i);
  if (rayQueryProceedEXT(query)) rayQueryConfirmIntersectionEXT(query);
  uint before = COMMITTED(query) / 10u;
  INITIALIZE(query, (i + 3u) % 32u);
  uint candidates = 0u;
  while (rayQueryProceedEXT(query)) ++candidates;
  results[i] = uvec4(before, COMMITTED(query), candidates >= 3u ? 1u : 0u, 0u);
}
)",
      [](std::uint32_t i) -> Answer {
        return {i, none, 1, 0};
      });
  add("divergent", "invocations may run different numbers of queries", R"(
void main() {
  uint i = gl_GlobalInvocationID.x;
  uint hits = 0u;
  uint last = NONE;
  for (uint k = 0u; k < i % 5u; ++k) {
    rayQueryEXT query;
    INITIALIZE(query, (i + k) % 32u);
    while (rayQueryProceedEXT(query)) {
      if ((i & 1u) == 0u) rayQueryConfirmIntersectionEXT(query);
    }
    last = COMMITTED(query);
    if (last != NONE) ++hits;
  }
  results[i] = uvec4(hits, last, 0u, 0u);
}
)",
      [](std::uint32_t i) -> Answer {
        const std::uint32_t count = i % 5;
        if (i % 2 != 0 || count == 0) return {0, none, 0, 0};
        return {count, committed((i + count - 1) % 32, 2), 0, 0};
      });
  add("many_in_sequence", "a thousand queries in one invocation each answer for themselves", R"(
void main() {
  uint i = gl_GlobalInvocationID.x;
  uint right = 0u;
  for (uint k = 0u; k < 1000u; ++k) {
    rayQueryEXT query;
    uint target = (i + k * 13u) % 32u;
    INITIALIZE(query, target);
    while (rayQueryProceedEXT(query)) { CONFIRM_ONLY(query, k % 3u); }
    if (COMMITTED(query) == target * 10u + k % 3u) ++right;
  }
  results[i] = uvec4(right, 0u, 0u, 0u);
}
)",
      [](std::uint32_t) -> Answer {
        return {1000, 0, 0, 0};
      });
}

/// Structure k of an array has its triangles at x = 100 k.
void check_array(Context& context, const std::string& label, const std::string& index) {
  constexpr std::uint32_t count = 4;
  std::vector<Scene> scenes;
  std::vector<rhi::BindGroupEntry> entries;
  for (std::uint32_t k = 0; k < count; ++k) {
    scenes.push_back(columns(context.device(), 1, 100 * static_cast<float>(k)));
    entries.push_back({.binding = 0, .resource = scenes.back().top_level, .array_element = k});
  }
  const std::string source = fmt::format(R"(#version 460
#extension GL_EXT_ray_query : require
#extension GL_EXT_nonuniform_qualifier : enable
layout(local_size_x = 32) in;
layout(set = 0, binding = 0) uniform accelerationStructureEXT scenes[4];
layout(set = 0, binding = 1, std430) writeonly buffer Results {{ uvec4 results[]; }};
void main() {{
  uint i = gl_GlobalInvocationID.x;
  uvec4 answer = uvec4(0u);
  for (uint place = 0u; place < 4u; ++place) {{
    rayQueryEXT query;
    rayQueryInitializeEXT(query, scenes[{}], gl_RayFlagsOpaqueEXT, 0xffu, vec3(100.0 * float(place) + 0.25, 0.25, 5.0),
                          0.0, vec3(0.0, 0.0, -1.0), 100.0);
    rayQueryProceedEXT(query);
    answer[place] = rayQueryGetIntersectionTypeEXT(query, true);
  }}
  results[i] = answer;
}}
)",
                                         index);
  const std::vector<Answer> seen = run_shader(context, source, label, entries);
  const bool varies = index.find('i') != std::string::npos;
  for (std::uint32_t i = 0; i < invocation_count; ++i)
    for (std::uint32_t place = 0; place < count; ++place)
      check_equal(fmt::format("whether invocation {} hits at place {}", i, place), seen[i][place],
                  place == (varies ? i % count : 2) ? 1u : 0u);
}

/// Structures that no descriptor names.
void check_addresses(Context& context) {
  constexpr std::uint32_t count = 2;
  std::vector<Scene> scenes;
  std::vector<std::uint64_t> addresses;
  for (std::uint32_t k = 0; k < count; ++k) {
    scenes.push_back(columns(context.device(), 1, 100 * static_cast<float>(k)));
    addresses.push_back(scenes.back().top_level->device_address());
  }
  const rhi::BufferHandle buffer = buffer_of(context.device(), addresses, "addresses");
  const std::string source = R"(#version 460
#extension GL_EXT_ray_query : require
layout(local_size_x = 32) in;
layout(set = 0, binding = 0, std430) readonly buffer Addresses { uvec2 addresses[]; };
layout(set = 0, binding = 1, std430) writeonly buffer Results { uvec4 results[]; };
void main() {
  uint i = gl_GlobalInvocationID.x;
  uvec4 answer = uvec4(0u);
  for (uint place = 0u; place < 2u; ++place) {
    rayQueryEXT query;
    rayQueryInitializeEXT(query, accelerationStructureEXT(addresses[i % 2u]), gl_RayFlagsOpaqueEXT, 0xffu,
                          vec3(100.0 * float(place) + 0.25, 0.25, 5.0), 0.0, vec3(0.0, 0.0, -1.0), 100.0);
    rayQueryProceedEXT(query);
    answer[place] = rayQueryGetIntersectionTypeEXT(query, true);
  }
  results[i] = answer;
}
)";
  const std::vector<Answer> seen =
      run_shader(context, source, "structures by address", {{.binding = 0, .resource = rhi::BufferRange{buffer}}});
  for (std::uint32_t i = 0; i < invocation_count; ++i)
    for (std::uint32_t place = 0; place < count; ++place)
      check_equal(fmt::format("whether invocation {} hits at place {}", i, place), seen[i][place],
                  place == i % count ? 1u : 0u);
}

void add_structure_cases(Cases& cases) {
  using rhi::Capabilities;
  const Group uniform = {cases, "ray_query.structures"};
  uniform.add("array", "a structure may be chosen from an array by a constant",
              [](Context& context) { check_array(context, "array of structures", "2"); });
  uniform.add("address", "a structure may be named by its address alone", check_addresses);
  const Group non_uniform = {
      cases, "ray_query.structures", {&Capabilities::ray_query, &Capabilities::non_uniform_indexing}};
  non_uniform.add("array_non_uniform", "each invocation may choose another structure of an array",
                  [](Context& context) { check_array(context, "non-uniform structures", "nonuniformEXT(i % 4u)"); });
  const Group null = {
      cases, "ray_query.null_as", {&Capabilities::ray_query, &Capabilities::null_acceleration_structure}};
  null.add("miss", "a ray in a null structure meets nothing", [](Context& context) {
    const Traversal seen = trace(context, nullptr, Ray{});
    check_miss("the ray", seen);
    check_equal("the number of candidates", seen.candidate_count, 0u);
  });
  null.add("flags", "a ray in a null structure meets nothing, whatever its flags", [](Context& context) {
    std::vector<Ray> rays;
    for (const std::uint32_t flags : {ray_flags::opaque, ray_flags::no_opaque, ray_flags::terminate_on_first_hit,
                                      ray_flags::cull_opaque, ray_flags::skip_triangles})
      rays.push_back({.flags = flags});
    for (const Traversal& seen : trace(context, nullptr, rays)) check_miss("the ray", seen);
  });
  null.add("getters", "a query in a null structure knows its ray", [](Context& context) {
    const Traversal seen = trace(context, nullptr, Ray{.t_min = 0.5f, .flags = ray_flags::opaque});
    check_equal("t_min", seen.t_min, 0.5f);
    check_equal("the flags", seen.flags, ray_flags::opaque);
    check_equal("the origin's z", seen.world_origin.z, 5.0f);
  });
}

}  // namespace

void add_ray_query_multiple_cases(Cases& cases) {
  add_multiple_cases({cases, "ray_query.multiple_ray_queries"});
  add_structure_cases(cases);
}

}  // namespace tandem::conformance
