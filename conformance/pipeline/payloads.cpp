#include <array>
#include <bit>
#include <utility>

#include "conformance/kit/check.hpp"
#include "conformance/pipeline/cases.hpp"
#include "conformance/pipeline/stack.hpp"

// Payloads of every shape, from the ray generation shader to those that a ray runs and back. GLSL_EXT_ray_tracing:
// rayPayloadEXT, rayPayloadInEXT.
namespace tandem::conformance {
namespace {

using namespace pipeline;

/// A payload's type, what the ray generation shader puts in, what the shader that gets it does to it, and what is in it
/// afterwards, as words.
struct PayloadShape {
  std::string name;
  std::string declarations;  ///< of structures
  std::string type;
  std::string fill;               ///< statements
  std::string change;             ///< statements
  std::vector<std::string> read;  ///< expressions of type uint
  std::vector<std::uint32_t> expected;
  std::vector<Capability> needs = {};
};

constexpr std::uint32_t bits(float value) { return std::bit_cast<std::uint32_t>(value); }

std::vector<PayloadShape> payload_shapes() {
  std::vector<PayloadShape> shapes = {
      {"float", "", "float", "p = 1.5;", "p = p * 2.0 + 0.25;", {"floatBitsToUint(p)"}, {bits(3.25F)}},
      {"int", "", "int", "p = -5;", "p = p * 3;", {"uint(p)"}, {static_cast<std::uint32_t>(-15)}},
      {"uint", "", "uint", "p = 0xF0000000u;", "p |= 7u;", {"p"}, {0xF0000007u}},
      {"bool", "", "bool", "p = true;", "p = !p;", {"p ? 1u : 2u"}, {2}},
      {"vec2",
       "",
       "vec2",
       "p = vec2(1.0, 2.0);",
       "p = p.yx * 2.0;",
       {"floatBitsToUint(p.x)", "floatBitsToUint(p.y)"},
       {bits(4), bits(2)}},
      {"vec3",
       "",
       "vec3",
       "p = vec3(1.0, 2.0, 3.0);",
       "p.y += p.x + p.z;",
       {"floatBitsToUint(p.x)", "floatBitsToUint(p.y)", "floatBitsToUint(p.z)"},
       {bits(1), bits(6), bits(3)}},
      {"vec4",
       "",
       "vec4",
       "p = vec4(1.0, 2.0, 3.0, 4.0);",
       "p = p.wzyx;",
       {"floatBitsToUint(p.x)", "floatBitsToUint(p.w)"},
       {bits(4), bits(1)}},
      {"uvec4", "", "uvec4", "p = uvec4(1u, 2u, 3u, 4u);", "p += p.yzwx;", {"p.x", "p.y", "p.z", "p.w"}, {3, 5, 7, 5}},
      {"bvec3",
       "",
       "bvec3",
       "p = bvec3(true, false, true);",
       "p = not(p);",
       {"p.x ? 1u : 0u", "p.y ? 1u : 0u", "p.z ? 1u : 0u"},
       {0, 1, 0}},
      {"mat3",
       "",
       "mat3",
       "p = mat3(1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0);",
       "p[1] = p[2];",
       {"floatBitsToUint(p[0].z)", "floatBitsToUint(p[1].x)", "floatBitsToUint(p[2].y)"},
       {bits(3), bits(7), bits(8)}},
      {"mat4x3",
       "",
       "mat4x3",
       "p = mat4x3(1.0); p[3] = vec3(2.0, 3.0, 4.0);",
       "p[3].y *= 2.0; p[2].z = 9.0;",
       {"floatBitsToUint(p[3].x)", "floatBitsToUint(p[3].y)", "floatBitsToUint(p[2].z)", "floatBitsToUint(p[0].x)"},
       {bits(2), bits(6), bits(9), bits(1)}},
      {"array",
       "",
       "uint[16]",
       "for (uint i = 0u; i < 16u; ++i) p[i] = i;",
       "for (uint i = 0u; i < 15u; ++i) p[i] += p[i + 1u];",
       {"p[0]", "p[7]", "p[14]", "p[15]"},
       {1, 15, 29, 15}},
      {"struct",
       "struct S { float a; uint b; vec3 c; bool d; };",
       "S",
       "p.a = 1.0; p.b = 2u; p.c = vec3(3.0); p.d = false;",
       "p.a += p.c.x; p.b += 5u; p.c.z = p.a; p.d = p.b == 7u;",
       {"floatBitsToUint(p.a)", "p.b", "floatBitsToUint(p.c.y)", "floatBitsToUint(p.c.z)", "p.d ? 1u : 0u"},
       {bits(4), 7, bits(3), bits(4), 1}},
      {"nested_struct",
       "struct Inner { vec2 a; uint b[3]; };\nstruct Outer { uint first; Inner inner[2]; mat2 m; uint last; };",
       "Outer",
       "p.first = 1u; p.last = 99u; p.m = mat2(1.0, 2.0, 3.0, 4.0);\n"
       "  for (uint i = 0u; i < 2u; ++i) { p.inner[i].a = vec2(float(i)); p.inner[i].b = uint[3](i, i + 1u, i + 2u); }",
       "p.inner[1].b[2] += p.last; p.inner[0].a.y = p.m[1].x; p.first = p.inner[1].b[0]; p.last += 1u;",
       {"p.first", "p.inner[1].b[2]", "floatBitsToUint(p.inner[0].a.y)", "floatBitsToUint(p.inner[1].a.x)", "p.last",
        "floatBitsToUint(p.m[1].y)"},
       {1, 102, bits(3), bits(1), 100, bits(4)}},
      {"array_of_struct",
       "struct S { vec3 a; uint b; };",
       "S[4]",
       "for (uint i = 0u; i < 4u; ++i) { p[i].a = vec3(float(i)); p[i].b = 10u * i; }",
       "for (uint i = 0u; i < 4u; ++i) { p[i].a.y += 0.5; p[3u - i].b += i; }",
       {"floatBitsToUint(p[3].a.x)", "floatBitsToUint(p[2].a.y)", "p[0].b", "p[3].b"},
       {bits(3), bits(2.5F), 3, 30}},
      {"struct_of_256_bytes",
       "struct S { vec4 a[15]; uint b[4]; };",
       "S",
       "for (int i = 0; i < 15; ++i) p.a[i] = vec4(float(i)); p.b = uint[4](1u, 2u, 3u, 4u);",
       "for (int i = 0; i < 14; ++i) p.a[i].x = p.a[i + 1].y; p.b[3] += p.b[0];",
       {"floatBitsToUint(p.a[0].x)", "floatBitsToUint(p.a[13].x)", "floatBitsToUint(p.a[14].x)", "p.b[3]"},
       {bits(1), bits(14), bits(14), 5}},
      {"array_of_1024_bytes",
       "",
       "uint[256]",
       "for (uint i = 0u; i < 256u; ++i) p[i] = i * i;",
       "for (uint i = 0u; i < 256u; ++i) p[i] ^= 255u - i;",
       {"p[0]", "p[100]", "p[255]"},
       {255, 10000 ^ 155, 255 * 255}},
      {"uint64",
       "",
       "uint64_t",
       "p = 0x123456789abcdef0ul;",
       "p += 0x100000000ul;",
       {"uint(p)", "uint(p >> 32)"},
       {0x9abcdef0u, 0x12345679u},
       {&rhi::Capabilities::shader_int64}},
      {"double",
       "",
       "double",
       "p = 1.0lf / 3.0lf;",
       "p = p * 3.0lf + 4.0lf;",
       {"uint(p)"},
       {5},
       {&rhi::Capabilities::shader_float64}},
  };
  return shapes;
}

std::string head_of(const PayloadShape& shape) {
  std::string head;
  for (const Capability capability : shape.needs)
    if (capability == &rhi::Capabilities::shader_int64)
      head += "#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require\n";
  return head + shape.declarations + "\n";
}

const std::string trace_text = R"(
layout(set = 0, binding = 0) uniform accelerationStructureEXT scene;
layout(set = 0, binding = 1, std430) writeonly buffer Results { uint results[]; };
void trace(float x, uint miss_index) {
  traceRayEXT(scene, 0u, 0xffu, 0u, 0u, miss_index, vec3(x, 0.25, 5.0), 0.0, vec3(0.0, 0.0, -1.0), 100.0, 0);
}
)";

/// The payload is changed by a closest-hit shader, and by a miss shader.
void check_shape(Context& context, const PayloadShape& shape) {
  const std::string head = head_of(shape);
  const std::string receiver =
      head + "layout(location = 0) rayPayloadInEXT " + shape.type + " p;\nvoid main() {\n  " + shape.change + "\n}\n";
  std::string generation = head + "layout(location = 0) rayPayloadEXT " + shape.type + " p;\n" + trace_text +
                           "void main() {\n  for (uint run = 0u; run < 2u; ++run) {\n  " + shape.fill +
                           "\n  trace(run == 0u ? 0.25 : -7.0, 0u);\n";
  for (std::size_t i = 0; i < shape.read.size(); ++i)
    generation += fmt::format("  results[run * {}u + {}u] = {};\n", shape.read.size(), i, shape.read[i]);
  generation += "  }\n}\n";
  const Scene scene =
      build_scene(context.device(), {stacked_triangles(context.device(), 1, rhi::GeometryFlags::opaque)});
  Launch launch;
  launch.scene = scene.top_level;
  const auto results = results_of<std::uint32_t>(
      context, {.ray_generation = {generation}, .miss = {receiver}, .hit_groups = {{.closest_hit = receiver}}}, launch,
      2 * shape.read.size(), "payload " + shape.name);
  for (std::size_t run = 0; run < 2; ++run)
    for (std::size_t i = 0; i < shape.read.size(); ++i)
      check_equal(fmt::format("{} after a {} shader", shape.read[i], run == 0 ? "closest-hit" : "miss"),
                  results[run * shape.read.size() + i], shape.expected[i]);
}

void several_locations(Context& context) {
  // Two payloads of one type and one of another: each trace changes the one that it names.
  const std::string generation = R"(
layout(set = 0, binding = 0) uniform accelerationStructureEXT scene;
layout(set = 0, binding = 1, std430) writeonly buffer Results { uint results[]; };
layout(location = 0) rayPayloadEXT uint a;
layout(location = 1) rayPayloadEXT uint b;
layout(location = 7) rayPayloadEXT uvec3 c;
void main() {
  a = 1u; b = 2u; c = uvec3(3u, 4u, 5u);
  vec3 down = vec3(0.0, 0.0, -1.0);
  traceRayEXT(scene, 0u, 0xffu, 0u, 0u, 0u, vec3(-7.0, 0.0, 5.0), 0.0, down, 100.0, 1);
  traceRayEXT(scene, 0u, 0xffu, 0u, 0u, 1u, vec3(-7.0, 0.0, 5.0), 0.0, down, 100.0, 7);
  traceRayEXT(scene, 0u, 0xffu, 0u, 0u, 0u, vec3(0.25, 0.25, 5.0), 0.0, down, 100.0, 0);
  results[0] = a; results[1] = b; results[2] = c.x; results[3] = c.y; results[4] = c.z;
}
)";
  const std::string add_ten = "layout(location = 0) rayPayloadInEXT uint p;\nvoid main() { p += 10u; }\n";
  const std::string add_vector = "layout(location = 3) rayPayloadInEXT uvec3 p;\nvoid main() { p += uvec3(100u); }\n";
  const std::string add_thousand = "layout(location = 0) rayPayloadInEXT uint p;\nvoid main() { p += 1000u; }\n";
  const Scene scene =
      build_scene(context.device(), {stacked_triangles(context.device(), 1, rhi::GeometryFlags::opaque)});
  Launch launch;
  launch.scene = scene.top_level;
  const auto results = results_of<std::uint32_t>(
      context,
      {.ray_generation = {generation}, .miss = {add_ten, add_vector}, .hit_groups = {{.closest_hit = add_thousand}}},
      launch, 5, "several payloads");
  const std::uint32_t expected[] = {1001, 12, 103, 104, 105};
  for (std::size_t i = 0; i < 5; ++i) check_equal(fmt::format("word {} of the payloads", i), results[i], expected[i]);
}

void untouched_without_shader(Context& context) {
  // Neither a hit nor a miss runs a shader: the payload keeps its value.
  const std::string generation = "layout(location = 0) rayPayloadEXT uvec2 p;\n" + trace_text +
                                 "void main() { p = uvec2(7u, 8u); trace(0.25, 0u); trace(-7.0, 0u);\n"
                                 "results[0] = p.x; results[1] = p.y; }\n";
  const std::string clear = "layout(location = 0) rayPayloadInEXT uvec2 p;\nvoid main() { p = uvec2(0u); }\n";
  const Scene scene =
      build_scene(context.device(), {stacked_triangles(context.device(), 1, rhi::GeometryFlags::opaque)});
  Launch launch;
  launch.scene = scene.top_level;
  launch.miss.records = {record_of(rhi::no_shader)};
  launch.hit.records = {record_of(rhi::no_shader)};
  const auto results = results_of<std::uint32_t>(
      context, {.ray_generation = {generation}, .miss = {clear}, .hit_groups = {{.closest_hit = clear}}}, launch, 2,
      "untouched payload");
  check_equal("the first component", results[0], 7u);
  check_equal("the second component", results[1], 8u);
}

void from_any_hit_to_closest_hit(Context& context) {
  const std::string generation = "layout(location = 0) rayPayloadEXT uint p;\n" + trace_text +
                                 "void main() { p = 1u; trace(0.25, 0u); results[0] = p; }\n";
  const std::string in = "layout(location = 0) rayPayloadInEXT uint p;\n";
  const Scene scene =
      build_scene(context.device(), {stacked_triangles(context.device(), 1, rhi::GeometryFlags::no_duplicate_any_hit)});
  Launch launch;
  launch.scene = scene.top_level;
  const auto results = results_of<std::uint32_t>(context,
                                                 {.ray_generation = {generation},
                                                  .miss = {in + "void main() { p = 0u; }\n"},
                                                  .hit_groups = {{.closest_hit = in + "void main() { p = p * 10u; }\n",
                                                                  .any_hit = in + "void main() { p += 4u; }\n"}}},
                                                 launch, 1, "payload of any hit");
  check_equal("the payload", results[0], 50u);
}

void every_invocation_has_its_own(Context& context) {
  const std::string generation = "layout(location = 0) rayPayloadEXT uint p;\n" + trace_text + R"(
void main() {
  uint index = gl_LaunchIDEXT.y * gl_LaunchSizeEXT.x + gl_LaunchIDEXT.x;
  p = index;
  trace(index % 2u == 0u ? 0.25 : -7.0, 0u);
  results[index] = p;
}
)";
  const std::string in = "layout(location = 0) rayPayloadInEXT uint p;\n";
  const Scene scene =
      build_scene(context.device(), {stacked_triangles(context.device(), 1, rhi::GeometryFlags::opaque)});
  Launch launch;
  launch.scene = scene.top_level;
  launch.trace.size = {61, 47, 1};
  const auto results =
      results_of<std::uint32_t>(context,
                                {.ray_generation = {generation},
                                 .miss = {in + "void main() { p = p * 3u + 1u; }\n"},
                                 .hit_groups = {{.closest_hit = in + "void main() { p = p * 5u + 2u; }\n"}}},
                                launch, 61 * 47, "payloads of many invocations");
  for (std::uint32_t i = 0; i < results.size(); ++i)
    check_equal(fmt::format("the payload of invocation {}", i), results[i], i % 2 == 0 ? i * 5 + 2 : i * 3 + 1);
}

}  // namespace

void add_pipeline_payload_cases(Cases& cases) {
  const auto add = [&cases](const std::string& name, const std::string& behaviour, std::function<void(Context&)> run,
                            std::vector<Capability> more_needs = {}) {
    more_needs.push_back(&rhi::Capabilities::ray_tracing_pipeline);
    Group{.cases = cases, .name = "ray_tracing_pipeline.payloads", .needs = std::move(more_needs)}.add(name, behaviour,
                                                                                                       std::move(run));
  };
  for (const PayloadShape& shape : payload_shapes())
    add(
        shape.name, "a payload of type " + shape.type + " goes to closest-hit and miss shaders and back",
        [shape](Context& context) { check_shape(context, shape); }, shape.needs);
  add("several_locations", "a trace changes only the payload that it names, whatever location its shader calls it",
      several_locations);
  add("untouched_without_shader", "a payload keeps its value where no shader runs", untouched_without_shader);
  add("from_any_hit_to_closest_hit", "any-hit and closest-hit shader of a ray share its payload",
      from_any_hit_to_closest_hit);
  add("every_invocation_has_its_own", "every invocation has a payload of its own", every_invocation_has_its_own);
}

}  // namespace tandem::conformance
