#include <array>
#include <bit>
#include <cmath>
#include <utility>

#include "conformance/kit/check.hpp"
#include "conformance/pipeline/cases.hpp"
#include "conformance/pipeline/stack.hpp"

// How a trace starts: its size, given or read from a buffer, and its place among the commands.
namespace tandem::conformance {
namespace {

using namespace pipeline;
using Size = std::array<std::uint32_t, 3>;

// Counts every invocation where it belongs, and those that do not belong anywhere in word 0.
const std::string counting_text = R"(
layout(set = 0, binding = 1, std430) buffer Results { uint results[]; };
layout(set = 0, binding = 2, std430) readonly buffer Expected { uint width; uint height; uint depth; };
void main() {
  bool right = gl_LaunchSizeEXT == uvec3(width, height, depth) && all(lessThan(gl_LaunchIDEXT, gl_LaunchSizeEXT));
  uint index = right ? 1u + (gl_LaunchIDEXT.z * height + gl_LaunchIDEXT.y) * width + gl_LaunchIDEXT.x : 0u;
  atomicAdd(results[index], 1u);
}
)";

/// A pipeline of the counting shader, its resources, and what they hold after the commands of `record`.
struct Counting {
  rhi::RayTracingPipelineHandle pipeline = {};
  Launch launch = {};
  std::size_t result_count = 0;
};

Counting make_counting(Context& context, const Size& size) {
  Counting counting;
  counting.result_count = 1 + std::size_t{size[0]} * size[1] * size[2];
  counting.pipeline = make_pipeline(context, {.ray_generation = {counting_text}, .max_recursion_depth = 0}, "counting");
  counting.launch.buffers = {
      buffer_of(context.device(), std::vector<std::uint32_t>(counting.result_count), "results"),
      buffer_of(context.device(), std::vector<std::uint32_t>(size.begin(), size.end()), "expected size")};
  counting.launch.trace.size = size;
  return counting;
}

/// Every invocation ran `times`, no other did.
void check_counts(Context& context, const Counting& counting, std::uint32_t times) {
  const auto results = rhi::read<std::uint32_t>(context.device(), counting.launch.buffers[0], counting.result_count);
  check_equal("invocations with a wrong gl_LaunchIDEXT or gl_LaunchSizeEXT", results[0], 0u);
  for (std::size_t i = 1; i < results.size(); ++i)
    check_equal(fmt::format("how often invocation {} ran", i - 1), results[i], times);
}

void launch_of(Context& context, const Size& size) {
  const Counting counting = make_counting(context, size);
  run(context.device(), counting.pipeline, counting.launch);
  check_counts(context, counting, 1);
}

void size_zero(Context& context) {
  Counting counting = make_counting(context, {4, 4, 4});
  for (const Size& size : {Size{0, 4, 4}, Size{4, 0, 4}, Size{4, 4, 0}, Size{0, 0, 0}}) {
    counting.launch.trace.size = size;
    run(context.device(), counting.pipeline, counting.launch);
  }
  check_counts(context, counting, 0);
}

void indirect(Context& context) {
  // The size in the desc is not used; the one in the buffer has an offset.
  Counting counting = make_counting(context, {9, 5, 3});
  counting.launch.trace.size = {1, 1, 1};
  const std::vector<std::uint32_t> words = {77, 9, 5, 3, 88};
  counting.launch.trace.indirect_size = {buffer_of(context.device(), words, "size"), 4, 12};
  run(context.device(), counting.pipeline, counting.launch);
  check_counts(context, counting, 1);
}

void indirect_zero(Context& context) {
  Counting counting = make_counting(context, {4, 1, 1});
  const std::vector<std::uint32_t> words = {4, 0, 1};
  counting.launch.trace.indirect_size = {buffer_of(context.device(), words, "size")};
  run(context.device(), counting.pipeline, counting.launch);
  check_counts(context, counting, 0);
}

void indirect_from_shader(Context& context) {
  // A trace writes the size of the next one in the same list.
  const std::string writes_size = R"(
layout(set = 0, binding = 1, std430) writeonly buffer Size { uint size[]; };
void main() { size[gl_LaunchIDEXT.x] = 6u - gl_LaunchIDEXT.x; }
)";
  rhi::Device& device = context.device();
  const Counting counting = make_counting(context, {6, 5, 4});
  Launch first;
  first.buffers = {buffer_of(device, std::vector<std::uint32_t>(3), "size")};
  const auto writer =
      make_pipeline(context, {.ray_generation = {writes_size}, .max_recursion_depth = 0}, "writes size");
  const rhi::CommandListHandle list = device.create_command_list("indirect");
  rhi::TraceRaysDesc trace;
  trace.table = make_table(device, writer, first);
  trace.bind_groups = {make_bind_group(device, writer, first)};
  trace.size = {3, 1, 1};
  list->trace_rays(trace);
  trace.table = make_table(device, counting.pipeline, counting.launch);
  trace.bind_groups = {make_bind_group(device, counting.pipeline, counting.launch)};
  trace.size = {1, 1, 1};
  trace.indirect_size = {first.buffers[0]};
  list->trace_rays(trace);
  device.submit(list)->wait();
  check_counts(context, counting, 1);
}

void in_order(Context& context) {
  // Each of several traces of one list sees what the one before it wrote.
  const std::string text = R"(
layout(set = 0, binding = 1, std430) buffer Values { uint values[]; };
void main() {
  uint neighbour = values[(gl_LaunchIDEXT.x + 1u) % 64u + 64u * (values[128] % 2u)];
  values[gl_LaunchIDEXT.x + 64u * ((values[128] + 1u) % 2u)] = neighbour + 1u;
}
)";
  const std::string step_text = R"(
layout(set = 0, binding = 1, std430) buffer Values { uint values[]; };
void main() { ++values[128]; }
)";
  rhi::Device& device = context.device();
  const auto pipeline =
      make_pipeline(context, {.ray_generation = {text, step_text}, .max_recursion_depth = 0}, "in order");
  Launch launch;
  std::vector<std::uint32_t> values(129);
  for (std::uint32_t i = 0; i < 64; ++i) values[i] = i * 1000;
  launch.buffers = {buffer_of(device, values, "values")};
  rhi::TraceRaysDesc trace;
  trace.table = make_table(device, pipeline, launch);
  trace.bind_groups = {make_bind_group(device, pipeline, launch)};
  const rhi::CommandListHandle list = device.create_command_list("in order");
  for (int step = 0; step < 10; ++step) {
    trace.ray_generation_record = 0;
    trace.size = {64, 1, 1};
    list->trace_rays(trace);
    trace.ray_generation_record = 1;
    trace.size = {1, 1, 1};
    list->trace_rays(trace);
  }
  device.submit(list)->wait();
  const auto results = rhi::read<std::uint32_t>(device, launch.buffers[0], 129);
  for (std::uint32_t i = 0; i < 64; ++i)
    check_equal(fmt::format("value {} after ten traces", i), results[i], (i + 10) % 64 * 1000 + 10);
}

}  // namespace

void add_pipeline_launch_cases(Cases& cases) {
  using Caps = rhi::Capabilities;
  const Group launch{.cases = cases, .name = "ray_tracing_pipeline.launch", .needs = {&Caps::ray_tracing_pipeline}};
  launch.add("size_1d", "a launch of one dimension runs every invocation once", [](Context& context) {
    launch_of(context, {1021, 1, 1});
  });
  launch.add("size_2d", "a launch of two dimensions runs every invocation once", [](Context& context) {
    launch_of(context, {67, 43, 1});
  });
  launch.add("size_3d", "a launch of three dimensions runs every invocation once", [](Context& context) {
    launch_of(context, {13, 7, 11});
  });
  launch.add("size_flat", "a launch may have size 1 in its first dimensions", [](Context& context) {
    launch_of(context, {1, 1, 301});
  });
  launch.add("size_zero", "a launch with a size of zero does nothing", size_zero);
  launch.add("in_order", "each of several traces of a list sees what the one before it wrote", in_order);
  const Group indirect_group{.cases = cases,
                             .name = "ray_tracing_pipeline.indirect",
                             .needs = {&Caps::ray_tracing_pipeline, &Caps::trace_rays_indirect}};
  indirect_group.add("size_from_buffer", "an indirect launch has the size that is in the buffer", indirect);
  indirect_group.add("size_zero", "an indirect launch with a size of zero does nothing", indirect_zero);
  indirect_group.add("size_from_shader", "an indirect launch has the size that a shader wrote before",
                     indirect_from_shader);
}

}  // namespace tandem::conformance
