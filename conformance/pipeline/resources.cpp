#include <array>
#include <bit>
#include <cmath>
#include <utility>

#include "conformance/kit/check.hpp"
#include "conformance/pipeline/cases.hpp"
#include "conformance/pipeline/stack.hpp"

// What the stages of a pipeline are given besides the scene: push constants, specialisation constants, bind groups,
// images and buffer references.
namespace tandem::conformance {
namespace {

using namespace pipeline;

const std::string scene_declaration = "layout(set = 0, binding = 0) uniform accelerationStructureEXT scene;\n";
const std::string results_declaration =
    "layout(set = 0, binding = 1, std430) writeonly buffer Results { uint results[]; };\n";
const std::string payload_out = "layout(location = 0) rayPayloadEXT uint payload;\n";
const std::string payload_in = "layout(location = 0) rayPayloadInEXT uint payload;\n";
const std::string hit_and_miss = R"(
  traceRayEXT(scene, 0u, 0xffu, 0u, 0u, 0u, vec3(0.25, 0.25, 5.0), 0.0, vec3(0.0, 0.0, -1.0), 100.0, 0);
  results[0] = payload;
  traceRayEXT(scene, 0u, 0xffu, 0u, 0u, 0u, vec3(-9.0, 0.25, 5.0), 0.0, vec3(0.0, 0.0, -1.0), 100.0, 0);
  results[1] = payload;
)";

Scene one_triangle(rhi::Device& device) {
  return build_scene(device, {stacked_triangles(device, 1, rhi::GeometryFlags::none)});
}

void push_constants(Context& context) {
  // Every stage declares a block of another size; all see the same bytes.
  const PipelineText text = {
      .ray_generation = {scene_declaration + results_declaration + payload_out +
                         "layout(push_constant) uniform Constants { uint a; };\nvoid main() { payload = a;" +
                         hit_and_miss + "}\n"},
      .miss = {payload_in + "layout(push_constant) uniform Constants { layout(offset = 4) uint b; uint c; };\n"
                            "void main() { payload += b + c; }\n"},
      .hit_groups = {{.closest_hit = payload_in + "layout(push_constant) uniform Constants { uvec4 v; uvec4 w; };\n"
                                                  "void main() { payload += v.w + w.w; }\n",
                      .any_hit = payload_in + "layout(push_constant) uniform Constants { uint v[5]; };\n"
                                              "void main() { payload = v[4]; }\n"}}};
  const std::array<std::uint32_t, 8> constants = {1, 20, 300, 4000, 50000, 600000, 7000000, 80000000};
  const Scene scene = one_triangle(context.device());
  Launch launch;
  launch.scene = scene.top_level;
  launch.trace.push_constants = std::as_bytes(std::span(constants));
  const auto results = results_of<std::uint32_t>(context, text, launch, 2, "push constants");
  check_equal("what any-hit and closest-hit shader made of them", results[0], 80054000u);
  check_equal("what the miss shader made of them", results[1], 80054320u);
}

void specialization(Context& context) {
  // Constant 1 is declared by two stages with different defaults, 2 by one, 3 is left at its default.
  const PipelineText text = {
      .ray_generation = {scene_declaration + results_declaration + payload_out +
                         "layout(constant_id = 1) const uint one = 5u;\nvoid main() { payload = one;" + hit_and_miss +
                         "}\n"},
      .miss = {payload_in + "layout(constant_id = 2) const float two = 1.0;\nlayout(constant_id = 3) const int three = "
                            "-7;\nvoid main() { payload = uint(two * 4.0) + uint(-three); }\n"},
      .hit_groups = {{.closest_hit = payload_in + "layout(constant_id = 1) const uint one = 6u;\nlayout(constant_id = "
                                                  "4) const bool four = false;\n"
                                                  "void main() { payload += one * (four ? 100u : 10000u); }\n"}},
      .specialization = {{1, 11}, {2, std::bit_cast<std::uint32_t>(2.5F)}, {4, 1}}};
  const Scene scene = one_triangle(context.device());
  Launch launch;
  launch.scene = scene.top_level;
  const auto results = results_of<std::uint32_t>(context, text, launch, 2, "specialisation");
  check_equal("what the closest-hit shader made of them", results[0], 1111u);
  check_equal("what the miss shader made of them", results[1], 17u);
}

void bind_group_with_compute(Context& context) {
  // One bind group, made for either pipeline, serves both.
  const std::string declarations = R"(
layout(set = 0, binding = 1, std430) readonly buffer Inputs { uint inputs[]; };
layout(set = 0, binding = 2, std430) buffer Values { uint values[]; };
)";
  rhi::Device& device = context.device();
  const auto tracing = make_pipeline(
      context,
      {.ray_generation = {declarations +
                          "void main() { uint i = gl_LaunchIDEXT.x; values[i] = values[i] * 2u + inputs[i]; }\n"},
       .max_recursion_depth = 0},
      "shares a bind group");
  const auto compute = context.compute_pipeline("#version 460\nlayout(local_size_x = 8) in;\n" + declarations +
                                                    "void main() { uint i = gl_GlobalInvocationID.x; values[i] = "
                                                    "values[i] * 3u + inputs[i]; }\n",
                                                "shares a bind group");
  for (const rhi::PipelineHandle& maker : {rhi::PipelineHandle(tracing), rhi::PipelineHandle(compute)}) {
    Launch launch;
    std::vector<std::uint32_t> inputs;
    for (std::uint32_t i = 0; i < 8; ++i) inputs.push_back(i);
    launch.buffers = {buffer_of(device, inputs, "inputs"),
                      buffer_of(device, std::vector<std::uint32_t>(8, 1), "values")};
    const rhi::BindGroupHandle group = make_bind_group(device, maker, launch);
    const rhi::CommandListHandle list = device.create_command_list("shared bind group");
    rhi::TraceRaysDesc trace;
    trace.table = make_table(device, tracing, launch);
    trace.bind_groups = {group};
    trace.size = {8, 1, 1};
    list->trace_rays(trace);
    list->dispatch({.pipeline = compute, .bind_groups = {group}});
    list->trace_rays(trace);
    device.submit(list)->wait();
    const auto results = rhi::read<std::uint32_t>(device, launch.buffers[1], 8);
    for (std::uint32_t i = 0; i < 8; ++i)
      check_equal(fmt::format("value {}", i), results[i], ((2 + i) * 3 + i) * 2 + i);
  }
}

void several_sets(Context& context) {
  // The ray generation shader uses sets 0 and 2, the miss shader sets 1 and 2.
  const PipelineText text = {.ray_generation = {scene_declaration + payload_out + R"(
layout(set = 2, binding = 3, std430) writeonly buffer Results { uint results[]; };
layout(set = 2, binding = 0, std430) readonly buffer Shared { uint shared_word; };
void main() {
  payload = shared_word;
  traceRayEXT(scene, 0u, 0xffu, 0u, 0u, 0u, vec3(-9.0, 0.25, 5.0), 0.0, vec3(0.0, 0.0, -1.0), 100.0, 0);
  results[0] = payload;
}
)"},
                             .miss = {payload_in + R"(
layout(set = 1, binding = 5, std140) uniform Uniforms { uvec4 numbers[2]; };
layout(set = 2, binding = 0, std430) readonly buffer Shared { uint shared_word; };
void main() { payload = payload * 1000u + numbers[1].z + shared_word; }
)"}};
  rhi::Device& device = context.device();
  const auto pipeline = make_pipeline(context, text, "several sets");
  const Scene scene = one_triangle(device);
  Launch launch;
  const auto results = buffer_of(device, std::vector<std::uint32_t>(1), "results");
  const auto shared = buffer_of(device, std::vector<std::uint32_t>{7}, "shared");
  const auto uniforms = buffer_of(device, std::vector<std::uint32_t>{1, 2, 3, 4, 5, 6, 70, 8}, "uniforms");
  rhi::BindGroupDesc groups[3];
  groups[0].entries = {{.binding = 0, .resource = scene.top_level}};
  groups[1].entries = {{.binding = 5, .resource = rhi::BufferRange{uniforms}}};
  groups[2].entries = {{.binding = 0, .resource = rhi::BufferRange{shared}},
                       {.binding = 3, .resource = rhi::BufferRange{results}}};
  rhi::TraceRaysDesc trace;
  trace.table = make_table(device, pipeline, launch);
  for (std::uint32_t set = 3; set-- > 0;) {
    groups[set].pipeline = pipeline;
    groups[set].set = set;
    groups[set].label = "several sets";
    trace.bind_groups.push_back(device.create_bind_group(groups[set]));
  }
  const rhi::CommandListHandle list = device.create_command_list("several sets");
  list->trace_rays(trace);
  device.submit(list)->wait();
  check_equal("the payload", rhi::read<std::uint32_t>(device, results, 1)[0], 7077u);
}

void storage_image(Context& context) {
  const PipelineText text = {
      .ray_generation = {scene_declaration + R"(
layout(set = 0, binding = 8, rgba32f) uniform writeonly image2D image;
layout(location = 0) rayPayloadEXT vec3 color;
void main() {
  vec2 place = (vec2(gl_LaunchIDEXT.xy) + 0.5) / vec2(gl_LaunchSizeEXT.xy) * 2.0 - 0.5;
  traceRayEXT(scene, 0u, 0xffu, 0u, 0u, 0u, vec3(place, 5.0), 0.0, vec3(0.0, 0.0, -1.0), 100.0, 0);
  imageStore(image, ivec2(gl_LaunchIDEXT.xy), vec4(color, 1.0));
}
)"},
      .miss = {"layout(location = 0) rayPayloadInEXT vec3 color;\nvoid main() { color = vec3(-1.0); }\n"},
      .hit_groups = {{.closest_hit = "layout(location = 0) rayPayloadInEXT vec3 color;\nhitAttributeEXT vec2 uv;\n"
                                     "void main() { color = vec3(uv, gl_HitTEXT); }\n"}}};
  rhi::Device& device = context.device();
  constexpr std::uint32_t width = 20;
  constexpr std::uint32_t height = 12;
  const Scene scene = one_triangle(device);
  Launch launch;
  launch.scene = scene.top_level;
  launch.textures = {device.create_texture(
      {.format = rhi::TextureFormat::rgba32_float, .size = {width, height, 1}, .label = "image"})};
  launch.trace.size = {width, height, 1};
  run(device, make_pipeline(context, text, "image"), launch);
  const auto texels = buffer_of(device, std::vector<float>(4 * width * height), "texels");
  const rhi::CommandListHandle list = device.create_command_list("read image");
  list->copy_from_texture(launch.textures[0], {texels});
  device.submit(list);
  const auto seen = rhi::read<float>(device, texels, 4 * width * height);
  for (std::uint32_t y = 0; y < height; ++y)
    for (std::uint32_t x = 0; x < width; ++x) {
      const double u = (x + 0.5) / width * 2.0 - 0.5;
      const double v = (y + 0.5) / height * 2.0 - 0.5;
      if (std::abs(u + v - 1.0) < 1e-3 || std::abs(u) < 1e-3 || std::abs(v) < 1e-3) continue;  // on the edge
      const bool inside = u > 0 && v > 0 && u + v < 1;
      const double expected[4] = {inside ? u : -1, inside ? v : -1, inside ? 5.0 : -1.0, 1.0};
      for (std::uint32_t channel = 0; channel < 4; ++channel)
        check_close(fmt::format("channel {} of texel ({}, {})", channel, x, y),
                    static_cast<double>(seen[(y * width + x) * 4 + channel]), expected[channel], 1.0);
    }
}

void buffer_reference_in_record(Context& context) {
  // Each hit record holds the address of its geometry's data.
  const PipelineText text = {
      .ray_generation = {scene_declaration + results_declaration + payload_out + R"(
void main() {
  for (uint i = 0u; i < 3u; ++i) {
    payload = 0u;
    traceRayEXT(scene, 0u, 0xffu, 0u, 1u, 0u, vec3(0.25 + 2.0 * float(i), 0.25, 5.0), 0.0, vec3(0.0, 0.0, -1.0), 100.0,
                0);
    results[i] = payload;
  }
}
)"},
      .miss = {payload_in + "void main() { payload = 1u; }\n"},
      .hit_groups = {{.closest_hit = "#extension GL_EXT_buffer_reference : require\n" + payload_in + R"(
layout(buffer_reference, std430) readonly buffer Numbers { uint numbers[]; };
layout(shaderRecordEXT, std430) buffer Record { uint index; Numbers data; } record;
void main() { payload = record.data.numbers[record.index]; }
)"}}};
  rhi::Device& device = context.device();
  std::vector<rhi::Geometry> geometries;
  for (int i = 0; i < 3; ++i)
    geometries.emplace_back(triangles(device, triangle_at({static_cast<float>(2 * i), 0, 0})));
  const Scene scene = build_scene(device, std::move(geometries));
  struct Record {
    std::uint32_t index;
    std::uint32_t padding;
    std::uint64_t address;
  };
  Launch launch;
  launch.scene = scene.top_level;
  std::vector<rhi::BufferHandle> numbers;
  for (std::uint32_t i = 0; i < 3; ++i) {
    numbers.push_back(buffer_of(device, std::vector<std::uint32_t>{10 * i, 10 * i + 1, 10 * i + 2}, "numbers"));
    launch.hit.records.push_back(record_with(0, Record{i, 0, numbers.back()->device_address()}));
  }
  const auto results = results_of<std::uint32_t>(context, text, launch, 3, "buffer references");
  for (std::uint32_t i = 0; i < 3; ++i) check_equal(fmt::format("the number of geometry {}", i), results[i], 11 * i);
}

}  // namespace

void add_pipeline_resource_cases(Cases& cases) {
  using Caps = rhi::Capabilities;
  const Group resources{
      .cases = cases, .name = "ray_tracing_pipeline.resources", .needs = {&Caps::ray_tracing_pipeline}};
  resources.add("push_constants", "every stage reads the push constants that it declares", push_constants);
  resources.add("specialization", "a specialisation constant reaches every stage that declares it", specialization);
  resources.add("bind_group_with_compute", "a bind group serves compute and ray tracing pipelines alike",
                bind_group_with_compute);
  resources.add("several_sets", "stages use bind groups of several sets", several_sets);
  resources.add("storage_image", "a ray generation shader writes a storage image", storage_image);
  const Group references{.cases = cases,
                         .name = "ray_tracing_pipeline.resources",
                         .needs = {&Caps::ray_tracing_pipeline, &Caps::buffer_references}};
  references.add("buffer_reference_in_record", "a shader record holds the address of a buffer",
                 buffer_reference_in_record);
}

}  // namespace tandem::conformance
