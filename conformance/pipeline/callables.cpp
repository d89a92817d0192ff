#include <array>
#include <bit>
#include <utility>

#include "conformance/kit/check.hpp"
#include "conformance/pipeline/cases.hpp"
#include "conformance/pipeline/stack.hpp"

// Callable shaders. GLSL_EXT_ray_tracing: executeCallableEXT, callableDataEXT, callableDataInEXT.
namespace tandem::conformance {
namespace {

using namespace pipeline;

const std::string results_declaration =
    "layout(set = 0, binding = 1, std430) writeonly buffer Results { uint results[]; };\n";
const std::string callable_in = "layout(location = 0) callableDataInEXT uint data;\n";
const std::string callable_out = "layout(location = 0) callableDataEXT uint data;\n";
const std::string scene_declaration = "layout(set = 0, binding = 0) uniform accelerationStructureEXT scene;\n";
const std::string trace_hit =
    "traceRayEXT(scene, 0u, 0xffu, 0u, 0u, 0u, vec3(0.25, 0.25, 5.0), 0.0, vec3(0.0, 0.0, -1.0), 100.0, 0);";
const std::string trace_miss =
    "traceRayEXT(scene, 0u, 0xffu, 0u, 0u, 0u, vec3(-9.0, 0.25, 5.0), 0.0, vec3(0.0, 0.0, -1.0), 100.0, 0);";

Scene one_triangle(rhi::Device& device) {
  return build_scene(device, {stacked_triangles(device, 1, rhi::GeometryFlags::opaque)});
}

void from_ray_generation(Context& context) {
  const PipelineText text = {.ray_generation = {results_declaration + callable_out +
                                                "void main() { data = gl_LaunchIDEXT.x; executeCallableEXT(0u, 0);\n"
                                                "results[gl_LaunchIDEXT.x] = data; }\n"},
                             .callable = {callable_in + "void main() { data = data * 3u + 1u; }\n"},
                             .max_recursion_depth = 0};
  Launch launch;
  launch.trace.size = {100, 1, 1};
  const auto results = results_of<std::uint32_t>(context, text, launch, 100, "callable");
  for (std::uint32_t i = 0; i < 100; ++i)
    check_equal(fmt::format("the data of invocation {}", i), results[i], i * 3 + 1);
}

void from_closest_hit_and_miss(Context& context) {
  const std::string payload_in = "layout(location = 0) rayPayloadInEXT uint payload;\n";
  const std::string calling = payload_in + "layout(location = 1) callableDataEXT uint data;\n" +
                              "void main() { data = payload; executeCallableEXT(0u, 1); payload = data + ";
  const PipelineText text = {
      .ray_generation = {results_declaration + scene_declaration +
                         "layout(location = 0) rayPayloadEXT uint payload;\nvoid main() {\n  payload = 5u; " +
                         trace_hit + " results[0] = payload;\n  payload = 6u; " + trace_miss +
                         " results[1] = payload;\n}\n"},
      .miss = {calling + "2000u; }\n"},
      .hit_groups = {{.closest_hit = calling + "1000u; }\n"}},
      .callable = {callable_in + "void main() { data *= 7u; }\n"}};
  const Scene scene = one_triangle(context.device());
  Launch launch;
  launch.scene = scene.top_level;
  const auto results = results_of<std::uint32_t>(context, text, launch, 2, "callable of hits");
  check_equal("the payload of a hit", results[0], 1035u);
  check_equal("the payload of a miss", results[1], 2042u);
}

void nested(Context& context) {
  const std::string calls_next = callable_in + "layout(location = 1) callableDataEXT uint inner;\n";
  const PipelineText text = {
      .ray_generation = {results_declaration + callable_out +
                         "void main() { data = 1u; executeCallableEXT(0u, 0); results[0] = data; }\n"},
      .callable = {calls_next + "void main() { inner = data + 1u; executeCallableEXT(1u, 1); data = inner * 10u; }\n",
                   calls_next + "void main() { inner = data + 2u; executeCallableEXT(2u, 1); data += inner * 10u; }\n",
                   callable_in + "void main() { data += 3u; }\n"},
      .max_recursion_depth = 0};
  const auto results = results_of<std::uint32_t>(context, text, {}, 1, "nested callables");
  // 1 -> 2 -> 4 -> 7; back: 2 + 70 = 72, then 720.
  check_equal("the data", results[0], 720u);
}

const std::string calls_by_index = results_declaration + callable_out + R"(
void main() {
  data = 1000u;
  executeCallableEXT(gl_LaunchIDEXT.x, 0);
  results[gl_LaunchIDEXT.x] = data;
}
)";
const std::string adds_record = "layout(shaderRecordEXT, std430) buffer Record { uint word; } record;\n" + callable_in +
                                "void main() { data += record.word; }\n";
const std::string doubles = callable_in + "void main() { data *= 2u; }\n";

void by_record(Context& context) {
  const PipelineText text = {
      .ray_generation = {calls_by_index}, .callable = {adds_record, doubles}, .max_recursion_depth = 0};
  Launch launch;
  launch.callable.records = {record_with(0, 1u), record_of(1), record_with(0, 30u), record_with(0, 400u),
                             record_of(rhi::no_shader)};
  launch.trace.size = {5, 1, 1};
  const auto results = results_of<std::uint32_t>(context, text, launch, 5, "callable by record");
  const std::uint32_t expected[] = {1001, 2000, 1030, 1400, 1000};
  for (std::size_t i = 0; i < 5; ++i)
    check_equal(fmt::format("the data after callable record {}", i), results[i], expected[i]);
}

void first_record(Context& context) {
  const PipelineText text = {.ray_generation = {calls_by_index}, .callable = {adds_record}, .max_recursion_depth = 0};
  Launch launch;
  for (std::uint32_t i = 0; i < 8; ++i) launch.callable.records.push_back(record_with(0, i));
  launch.trace.first_callable_record = 5;
  launch.trace.size = {3, 1, 1};
  const auto results = results_of<std::uint32_t>(context, text, launch, 3, "first callable record");
  for (std::uint32_t i = 0; i < 3; ++i) check_equal(fmt::format("the data after callable {}", i), results[i], 1005 + i);
}

void data_of_struct(Context& context) {
  const std::string declaration = R"(
struct Light { vec3 position; float power; };
struct Data { Light lights[3]; mat3 frame; uint count; bool done; };
)";
  const PipelineText text = {.ray_generation = {results_declaration + declaration + R"(
layout(location = 0) callableDataEXT Data data;
void main() {
  for (int i = 0; i < 3; ++i) { data.lights[i].position = vec3(float(i)); data.lights[i].power = 2.0; }
  data.frame = mat3(1.0); data.count = 3u; data.done = false;
  executeCallableEXT(0u, 0);
  results[0] = floatBitsToUint(data.lights[2].position.y);
  results[1] = floatBitsToUint(data.lights[1].power);
  results[2] = floatBitsToUint(data.frame[2].x);
  results[3] = data.count;
  results[4] = data.done ? 1u : 0u;
}
)"},
                             .callable = {declaration + R"(
layout(location = 0) callableDataInEXT Data data;
void main() {
  for (uint i = 0u; i < data.count; ++i) { data.lights[i].position.y += 0.5; data.lights[i].power *= float(i); }
  data.frame[2].x = data.frame[1].y * 8.0; data.count += 4u; data.done = !data.done;
}
)"},
                             .max_recursion_depth = 0};
  const auto results = results_of<std::uint32_t>(context, text, {}, 5, "callable data");
  check_equal("an element of a vector", std::bit_cast<float>(results[0]), 2.5F);
  check_equal("a scalar", std::bit_cast<float>(results[1]), 2.0F);
  check_equal("an element of a matrix", std::bit_cast<float>(results[2]), 8.0F);
  check_equal("an integer", results[3], 7u);
  check_equal("a bool", results[4], 1u);
}

void several_locations(Context& context) {
  const PipelineText text = {.ray_generation = {results_declaration + R"(
layout(location = 0) callableDataEXT uint a;
layout(location = 4) callableDataEXT uint b;
void main() {
  a = 1u; b = 2u;
  executeCallableEXT(0u, 4);
  executeCallableEXT(0u, 4);
  executeCallableEXT(0u, 0);
  results[0] = a; results[1] = b;
}
)"},
                             .callable = {callable_in + "void main() { data += 10u; }\n"},
                             .max_recursion_depth = 0};
  const auto results = results_of<std::uint32_t>(context, text, {}, 2, "several callable data");
  check_equal("the data at location 0", results[0], 11u);
  check_equal("the data at location 4", results[1], 22u);
}

void knows_launch(Context& context) {
  const PipelineText text = {.ray_generation = {results_declaration + callable_out + R"(
void main() {
  data = 0u;
  executeCallableEXT(0u, 0);
  results[(gl_LaunchIDEXT.z * 5u + gl_LaunchIDEXT.y) * 3u + gl_LaunchIDEXT.x] = data;
}
)"},
                             .callable = {callable_in + R"(
void main() {
  data = gl_LaunchIDEXT.x + 10u * gl_LaunchIDEXT.y + 100u * gl_LaunchIDEXT.z + 1000u * gl_LaunchSizeEXT.x +
         10000u * gl_LaunchSizeEXT.y + 100000u * gl_LaunchSizeEXT.z;
}
)"},
                             .max_recursion_depth = 0};
  Launch launch;
  launch.trace.size = {3, 5, 2};
  const auto results = results_of<std::uint32_t>(context, text, launch, 30, "callable launch");
  for (std::uint32_t z = 0; z < 2; ++z)
    for (std::uint32_t y = 0; y < 5; ++y)
      for (std::uint32_t x = 0; x < 3; ++x)
        check_equal(fmt::format("what invocation ({}, {}, {}) wrote", x, y, z), results[(z * 5 + y) * 3 + x],
                    253000 + 100 * z + 10 * y + x);
}

}  // namespace

void add_pipeline_callable_cases(Cases& cases) {
  const Group group{
      .cases = cases, .name = "ray_tracing_pipeline.callable", .needs = {&rhi::Capabilities::ray_tracing_pipeline}};
  group.add("from_ray_generation", "a ray generation shader calls a callable shader", from_ray_generation);
  group.add("from_closest_hit_and_miss", "closest-hit and miss shaders call callable shaders",
            from_closest_hit_and_miss);
  group.add("nested", "callable shaders call callable shaders", nested);
  group.add("by_record",
            "the index picks the callable record, its shader and its data; a record without shader runs nothing",
            by_record);
  group.add("first_record", "callable records are counted from first_callable_record on", first_record);
  group.add("data_of_struct", "structures, arrays and matrices go to a callable shader and back", data_of_struct);
  group.add("several_locations", "a call changes only the data that it names", several_locations);
  group.add("knows_launch", "gl_LaunchIDEXT and gl_LaunchSizeEXT in a callable shader", knows_launch);
}

}  // namespace tandem::conformance
