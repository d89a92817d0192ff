#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <utility>

#include "rhi/glsl/compile.hpp"
#include "tests/rhi/dispatch.hpp"

using namespace tandem;
using test::contents;

namespace {

rhi::BindGroupHandle bind_group(rhi::Device& device, const rhi::ComputePipelineHandle& pipeline, std::uint32_t set,
                                std::vector<rhi::BindGroupEntry> entries) {
  return device.create_bind_group(
      {.pipeline = pipeline, .set = set, .entries = std::move(entries), .label = "set " + std::to_string(set)});
}

rhi::BufferHandle zeros(rhi::Device& device, std::size_t count) {
  return test::buffer_of(device, std::vector<std::uint32_t>(count), "zeros");
}

}  // namespace

TANDEM_DEVICE_TEST("a dispatch runs every invocation of every workgroup once") {
  const rhi::ComputePipelineHandle pipeline = test::compute_pipeline(device, R"(#version 460
layout(local_size_x = 4, local_size_y = 2, local_size_z = 3) in;
layout(set = 0, binding = 0) buffer Counts { uint counts[]; };
void main() {
  uvec3 size = gl_NumWorkGroups * gl_WorkGroupSize;
  uvec3 id = gl_GlobalInvocationID;
  if (id != gl_WorkGroupID * gl_WorkGroupSize + gl_LocalInvocationID) return;
  counts[(id.z * size.y + id.y) * size.x + id.x] += 1 + gl_LocalInvocationIndex;
}
)",
                                                                     "count");
  constexpr std::array<std::uint32_t, 3> groups = {3, 5, 2};
  constexpr std::uint32_t count = 12 * 10 * 6;
  const rhi::BufferHandle counts = zeros(device, count);
  const rhi::BindGroupHandle group =
      bind_group(device, pipeline, 0, {{.binding = 0, .resource = rhi::BufferRange{counts}}});
  const rhi::CommandListHandle list = device.create_command_list("count");
  list->dispatch({.pipeline = pipeline, .bind_groups = {group}, .workgroup_count = groups});
  list->dispatch({.pipeline = pipeline, .bind_groups = {group}, .workgroup_count = {3, 0, 2}});
  device.submit(list);
  std::vector<std::uint32_t> expected;
  for (std::uint32_t z = 0; z < 6; ++z)
    for (std::uint32_t y = 0; y < 10; ++y)
      for (std::uint32_t x = 0; x < 12; ++x) expected.push_back(1 + ((z % 3) * 2 + y % 2) * 4 + x % 4);
  CHECK(contents<std::uint32_t>(device, counts, count) == expected);
}

TANDEM_DEVICE_TEST("push constants arrive as they were when the dispatch was recorded") {
  struct Constants {
    std::array<float, 3> a;
    std::uint32_t b;
    std::array<std::uint32_t, 2> c;
  } constants = {{1, 2, 3}, 4, {5, 6}};
  const rhi::ComputePipelineHandle pipeline = test::compute_pipeline(device, R"(#version 460
layout(local_size_x = 1) in;
layout(set = 0, binding = 0) buffer Values { float values[]; };
layout(push_constant) uniform Constants { vec3 a; uint b; uvec2 c; };
void main() {
  values[c.x + 0] = a.x; values[c.x + 1] = a.y; values[c.x + 2] = a.z;
  values[c.x + 3] = float(b); values[c.x + 4] = float(c.y);
}
)",
                                                                     "push");
  const rhi::BufferHandle values = test::buffer_of(device, std::vector<float>(16), "values");
  const rhi::BindGroupHandle group =
      bind_group(device, pipeline, 0, {{.binding = 0, .resource = rhi::BufferRange{values}}});
  const rhi::CommandListHandle list = device.create_command_list("push");
  for (std::uint32_t start : {0u, 8u}) {
    constants.b = 10 + start;
    constants.c[0] = start;
    list->dispatch(
        {.pipeline = pipeline, .bind_groups = {group}, .push_constants = std::as_bytes(std::span(&constants, 1))});
  }
  constants = {};
  device.submit(list);
  CHECK(contents<float>(device, values, 16) == std::vector<float>{1, 2, 3, 10, 6, 0, 0, 0, 1, 2, 3, 18, 6, 0, 0, 0});
}

TANDEM_DEVICE_TEST("specialisation constants replace their defaults, the workgroup size among them") {
  const std::string source = R"(#version 460
layout(local_size_x_id = 7) in;
layout(constant_id = 0) const uint number = 11;
layout(constant_id = 1) const float real = 1.5;
layout(constant_id = 2) const bool choice = false;
layout(constant_id = 3) const int negative = -3;
layout(set = 0, binding = 0) buffer Values { float values[]; };
void main() {
  if (gl_LocalInvocationIndex + 1 < gl_WorkGroupSize.x) return;
  values[0] = float(number); values[1] = real; values[2] = choice ? 1.0 : 0.0;
  values[3] = float(negative); values[4] = float(gl_WorkGroupSize.x);
}
)";
  const auto run = [&](std::vector<rhi::SpecializationValue> specialization) {
    const rhi::ComputePipelineHandle pipeline =
        test::compute_pipeline(device, source, "specialised", std::move(specialization));
    const rhi::BufferHandle values = test::buffer_of(device, std::vector<float>(5), "values");
    test::run(device, pipeline, {values});
    return contents<float>(device, values, 5);
  };
  const auto bits = [](auto value) {
    std::uint32_t result;
    std::memcpy(&result, &value, sizeof(result));
    return result;
  };
  CHECK(run({{7, 1}}) == std::vector<float>{11, 1.5f, 0, -3, 1});
  CHECK(run({{3, bits(-9)}, {0, 42}, {7, 16}, {1, bits(0.25f)}, {2, 1}}) == std::vector<float>{42, 0.25f, 1, -9, 16});
  CHECK_ERROR(invalid_argument, "specialised: ", run({{5, 1}}));
  CHECK_ERROR(invalid_argument, "specialised: ", run({{0, 1}, {0, 2}}));
  CHECK_ERROR(invalid_argument, "specialised: a workgroup size of 0", run({{7, 0}}));
  CHECK_ERROR(invalid_argument, "specialised: a workgroup size of 1048576", run({{7, 1u << 20}}));
}

TANDEM_DEVICE_TEST("specialization constants have every width") {
  const rhi::Capabilities& can = device.info().capabilities;
  REQUIRE((can.shader_int8 && can.shader_int16 && can.shader_int64 && can.shader_float16 && can.shader_float64));
  const std::string source = R"(#version 460
#extension GL_EXT_shader_explicit_arithmetic_types : require
layout(constant_id = 1) const int8_t small = int8_t(-1);
layout(constant_id = 2) const uint16_t middle = uint16_t(65535);
layout(constant_id = 3) const int64_t wide = 5000000000l;
layout(constant_id = 4) const double real = 0.1lf;
layout(constant_id = 5) const float16_t half_real = float16_t(0.5);
layout(constant_id = 6) const bool flag = true;
layout(set = 0, binding = 0) buffer Values { double values[6]; };
void main() {
  values[0] = double(small);
  values[1] = double(middle);
  values[2] = double(wide);
  values[3] = real;
  values[4] = double(half_real);
  values[5] = flag ? 1 : 0;
}
)";
  const auto run = [&](std::vector<rhi::SpecializationValue> specialization) {
    const rhi::ComputePipelineHandle pipeline =
        test::compute_pipeline(device, source, "widths", std::move(specialization));
    const rhi::BufferHandle values = test::buffer_of(device, std::vector<double>(6), "values");
    test::run(device, pipeline, {values});
    return contents<double>(device, values, 6);
  };
  CHECK(run({}) == std::vector<double>{-1, 65535, 5e9, 0.1, 0.5, 1});
  CHECK(
      run({{1, 0x80}, {2, 7}, {3, 0xfffffffe00000000u}, {4, std::bit_cast<std::uint64_t>(0.3)}, {5, 0x4000}, {6, 0}}) ==
      std::vector<double>{-128, 7, -8589934592.0, 0.3, 2, 0});
}

TANDEM_DEVICE_TEST("two constants of one id keep their defaults until a value is given") {
  // The workgroup size has the default 1.
  const std::string source = R"(#version 460
layout(local_size_x_id = 0) in;
layout(constant_id = 0) const uint number = 32;
layout(set = 0, binding = 0) buffer Values { float values[]; };
void main() { values[0] = float(number); values[1] = float(gl_WorkGroupSize.x); }
)";
  const auto run = [&](std::vector<rhi::SpecializationValue> specialization) {
    const rhi::ComputePipelineHandle pipeline =
        test::compute_pipeline(device, source, "shared id", std::move(specialization));
    const rhi::BufferHandle values = test::buffer_of(device, std::vector<float>(2), "values");
    test::run(device, pipeline, {values});
    return contents<float>(device, values, 2);
  };
  CHECK(run({}) == std::vector<float>{32, 1});
  CHECK(run({{0, 4}}) == std::vector<float>{4, 4});
}

TANDEM_DEVICE_TEST("uniform and storage buffers of several sets, with offsets") {
  const rhi::ComputePipelineHandle pipeline = test::compute_pipeline(device, R"(#version 460
layout(local_size_x = 4) in;
layout(set = 0, binding = 3, std140) uniform Parameters { vec3 scale; float bias; float weights[2]; };
layout(set = 2, binding = 1, std430) readonly buffer Input { float inputs[]; };
layout(set = 2, binding = 5, std430) writeonly buffer Output { float outputs[]; };
void main() {
  uint i = gl_LocalInvocationIndex;
  outputs[i] = i < inputs.length() ? inputs[i] * scale.y * weights[1] + bias : -1.0;
}
)",
                                                                     "sets");
  const std::uint64_t uniform_offset = device.info().limits.uniform_buffer_offset_alignment;
  const std::uint64_t storage_offset = device.info().limits.storage_buffer_offset_alignment;
  REQUIRE(uniform_offset % 4 == 0);
  REQUIRE(storage_offset % 4 == 0);
  std::vector<float> parameters(uniform_offset / 4, -1);
  // std140: the array's elements are 16 bytes apart.
  parameters.insert(parameters.end(), {1, 2, 3, 100, 7, 0, 0, 0, 4, 0, 0, 0});
  std::vector<float> inputs(storage_offset / 4, -1);
  inputs.insert(inputs.end(), {1, 2, 3, 99});
  const rhi::BufferHandle outputs = test::buffer_of(device, std::vector<float>(4), "outputs");
  const rhi::BindGroupHandle uniforms =
      bind_group(device, pipeline, 0,
                 {{.binding = 3,
                   .resource = rhi::BufferRange{test::buffer_of(device, parameters, "parameters"), uniform_offset}}});
  const rhi::BindGroupHandle storage = bind_group(
      device, pipeline, 2,
      {{.binding = 5, .resource = rhi::BufferRange{outputs}},
       {.binding = 1, .resource = rhi::BufferRange{test::buffer_of(device, inputs, "inputs"), storage_offset, 12}}});
  const rhi::CommandListHandle list = device.create_command_list("sets");
  list->dispatch({.pipeline = pipeline, .bind_groups = {storage, uniforms}});
  device.submit(list);
  CHECK(contents<float>(device, outputs, 4) == std::vector<float>{108, 116, 124, -1});
}

TANDEM_DEVICE_TEST("arrays of buffers are bound element by element") {
  const rhi::ComputePipelineHandle pipeline = test::compute_pipeline(device, R"(#version 460
layout(local_size_x = 1) in;
layout(set = 0, binding = 0) readonly buffer Input { uint value; } inputs[3];
layout(set = 0, binding = 1) buffer Output { uint outputs[]; };
layout(push_constant) uniform Constants { uint element; };
void main() { outputs[element] = inputs[element].value; }
)",
                                                                     "arrays");
  const rhi::BufferHandle outputs = zeros(device, 3);
  std::vector<rhi::BindGroupEntry> entries = {{.binding = 1, .resource = rhi::BufferRange{outputs}}};
  for (std::uint32_t i : {2u, 0u, 1u})
    entries.push_back({.binding = 0,
                       .resource = rhi::BufferRange{test::buffer_of(device, std::vector{10 + i}, "element")},
                       .array_element = i});
  const rhi::BindGroupHandle group = bind_group(device, pipeline, 0, entries);
  const rhi::CommandListHandle list = device.create_command_list("arrays");
  for (std::uint32_t i = 0; i < 3; ++i)
    list->dispatch({.pipeline = pipeline, .bind_groups = {group}, .push_constants = std::as_bytes(std::span(&i, 1))});
  device.submit(list);
  CHECK(contents<std::uint32_t>(device, outputs, 3) == std::vector<std::uint32_t>{10, 11, 12});
}

TANDEM_DEVICE_TEST("a bind group serves every pipeline that declares the same bindings") {
  const auto pipeline_writing = [&](const std::string& value) {
    return test::compute_pipeline(device,
                                  "#version 460\nlayout(local_size_x = 1) in;\n"
                                  "layout(set = 0, binding = 0) buffer B { uint values[]; };\n"
                                  "void main() { values[" +
                                      value + "] = " + value + "; }\n",
                                  "write " + value);
  };
  const rhi::ComputePipelineHandle first = pipeline_writing("1");
  const rhi::ComputePipelineHandle second = pipeline_writing("2");
  const rhi::BufferHandle values = zeros(device, 3);
  const rhi::BindGroupHandle group =
      bind_group(device, first, 0, {{.binding = 0, .resource = rhi::BufferRange{values}}});
  const rhi::CommandListHandle list = device.create_command_list("share");
  list->dispatch({.pipeline = first, .bind_groups = {group}});
  list->dispatch({.pipeline = second, .bind_groups = {group}});
  device.submit(list);
  CHECK(contents<std::uint32_t>(device, values, 3) == std::vector<std::uint32_t>{0, 1, 2});
}

TANDEM_DEVICE_TEST("many bind groups live at once") {
  const rhi::ComputePipelineHandle pipeline = test::compute_pipeline(device, R"(#version 460
layout(local_size_x = 1) in;
layout(set = 0, binding = 0) buffer Values { uint value; };
void main() { value += 1; }
)",
                                                                     "increment");
  constexpr std::uint32_t count = 600;  // more than one descriptor pool of the Vulkan device holds
  const std::uint64_t stride = std::max<std::uint64_t>(device.info().limits.storage_buffer_offset_alignment, 4);
  const rhi::BufferHandle values = zeros(device, count * stride / 4);
  std::vector<rhi::BindGroupHandle> groups;
  const rhi::CommandListHandle list = device.create_command_list("many");
  for (std::uint32_t i = 0; i < count; ++i) {
    groups.push_back(
        bind_group(device, pipeline, 0, {{.binding = 0, .resource = rhi::BufferRange{values, i * stride, 4}}}));
    list->dispatch({.pipeline = pipeline, .bind_groups = {groups.back()}});
  }
  device.submit(list);
  std::vector<std::uint32_t> expected(count * stride / 4);
  for (std::uint32_t i = 0; i < count; ++i) expected[i * stride / 4] = 1;
  CHECK(contents<std::uint32_t>(device, values, expected.size()) == expected);
}

TANDEM_DEVICE_TEST("scalar block layout, 64-bit integers and doubles where the device says so") {
  const rhi::Capabilities& capabilities = device.info().capabilities;
  if (capabilities.scalar_block_layout) {
    const rhi::ComputePipelineHandle pipeline = test::compute_pipeline(device, R"(#version 460
#extension GL_EXT_scalar_block_layout : require
layout(local_size_x = 1) in;
struct Packed { vec3 a; vec3 b; };
layout(set = 0, binding = 0, scalar) buffer Values { Packed values[]; };
void main() { values[1].b = values[0].a + values[0].b; }
)",
                                                                       "scalar");
    const rhi::BufferHandle values =
        test::buffer_of(device, std::vector<float>{1, 2, 3, 10, 20, 30, 0, 0, 0, 0, 0, 0}, "packed");
    test::run(device, pipeline, {values});
    CHECK(contents<float>(device, values, 12) == std::vector<float>{1, 2, 3, 10, 20, 30, 0, 0, 0, 11, 22, 33});
  }
  if (capabilities.shader_int64) {
    const rhi::ComputePipelineHandle pipeline = test::compute_pipeline(device, R"(#version 460
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
layout(local_size_x = 1) in;
layout(set = 0, binding = 0) buffer Values { uint64_t values[]; };
void main() { values[1] = values[0] * values[0]; }
)",
                                                                       "int64");
    const rhi::BufferHandle values = test::buffer_of(device, std::vector<std::uint64_t>{3'000'000'019ull, 0}, "wide");
    test::run(device, pipeline, {values});
    CHECK(contents<std::uint64_t>(device, values, 2)[1] == 3'000'000'019ull * 3'000'000'019ull);
  }
  if (capabilities.shader_float64) {
    const rhi::ComputePipelineHandle pipeline = test::compute_pipeline(device, R"(#version 460
layout(local_size_x = 1) in;
layout(set = 0, binding = 0) buffer Values { double values[]; };
void main() { values[1] = values[0] + 1.0lf; }
)",
                                                                       "float64");
    const rhi::BufferHandle values = test::buffer_of(device, std::vector<double>{0x1p-50, 0}, "doubles");
    test::run(device, pipeline, {values});
    CHECK(contents<double>(device, values, 2)[1] == 1 + 0x1p-50);
  }
}

TANDEM_DEVICE_TEST("atomics see every invocation") {
  const rhi::ComputePipelineHandle pipeline = test::compute_pipeline(device, R"(#version 460
layout(local_size_x = 64) in;
layout(set = 0, binding = 0) buffer Values { uint total; uint largest; };
void main() {
  atomicAdd(total, gl_GlobalInvocationID.x);
  atomicMax(largest, gl_GlobalInvocationID.x);
}
)",
                                                                     "atomics");
  const rhi::BufferHandle values = zeros(device, 2);
  test::run(device, pipeline, {values}, 100);
  CHECK(contents<std::uint32_t>(device, values, 2) == std::vector<std::uint32_t>{6400 * 6399 / 2, 6399});
}

TANDEM_DEVICE_TEST("broken rules of shaders and pipelines are errors that name the object") {
  const std::vector<std::uint32_t> nonsense = {1, 2, 3};
  CHECK_ERROR(invalid_argument, "nonsense: ", device.create_shader_module({.spirv = nonsense, .label = "nonsense"}));
  CHECK_ERROR(invalid_argument, "empty: ", device.create_shader_module({.spirv = {}, .label = "empty"}));
  rhi::ComputePipelineDesc without_shader;
  without_shader.label = "no shader";
  CHECK_ERROR(invalid_argument, "no shader: ", device.create_compute_pipeline(without_shader));
}

TANDEM_DEVICE_TEST("broken rules of bind groups and dispatches are errors that name the object") {
  const rhi::ComputePipelineHandle pipeline = test::compute_pipeline(device, R"(#version 460
layout(local_size_x = 1) in;
layout(set = 0, binding = 0) buffer Values { uint values[]; };
layout(set = 0, binding = 1) uniform Parameters { uint parameter; };
layout(push_constant) uniform Constants { uint constant; };
void main() { values[0] = parameter + constant; }
)",
                                                                     "strict");
  const rhi::BufferRange good = {zeros(device, 64)};
  const auto group = [&](std::vector<rhi::BindGroupEntry> entries, std::uint32_t set = 0) {
    return bind_group(device, pipeline, set, std::move(entries));
  };
  CHECK_ERROR(invalid_argument, "set 0: ", group({{.binding = 0, .resource = good}}));
  CHECK_ERROR(invalid_argument, "set 1: ", group({}, 1));
  CHECK_ERROR(invalid_argument, "set 0: ", group({{.binding = 0, .resource = good}, {.binding = 2, .resource = good}}));
  CHECK_ERROR(invalid_argument, "set 0: ", group({{.binding = 0, .resource = good}, {.binding = 0, .resource = good}}));
  CHECK_ERROR(invalid_argument,
              "set 0: ", group({{.binding = 0, .resource = good}, {.binding = 1, .resource = rhi::BufferRange{}}}));
  CHECK_ERROR(invalid_argument, "set 0: ",
              group({{.binding = 0, .resource = good}, {.binding = 1, .resource = good, .array_element = 1}}));
  const rhi::BufferHandle plain = device.create_buffer({.size = 4, .label = "plain"});
  CHECK_ERROR(invalid_argument, "'plain'",
              group({{.binding = 0, .resource = good}, {.binding = 1, .resource = rhi::BufferRange{plain}}}));
  CHECK_ERROR(
      invalid_argument, "set 0: ",
      group({{.binding = 0, .resource = rhi::AccelerationStructureHandle()}, {.binding = 1, .resource = good}}));

  const rhi::BindGroupHandle complete = group({{.binding = 0, .resource = good}, {.binding = 1, .resource = good}});
  const rhi::CommandListHandle list = device.create_command_list("list");
  const std::uint64_t constant = 0;
  const auto constants = std::as_bytes(std::span(&constant, 1));
  CHECK_ERROR(invalid_argument, "strict: ", list->dispatch({.pipeline = pipeline, .bind_groups = {complete}}));
  CHECK_ERROR(invalid_argument, "strict: ",
              list->dispatch({.pipeline = pipeline, .bind_groups = {complete}, .push_constants = constants}));
  CHECK_ERROR(invalid_argument, "strict: ",
              list->dispatch({.pipeline = pipeline, .bind_groups = {}, .push_constants = constants.first(4)}));
  CHECK_ERROR(invalid_argument, "strict: ",
              list->dispatch(
                  {.pipeline = pipeline, .bind_groups = {complete, complete}, .push_constants = constants.first(4)}));
  if (device.info().limits.max_workgroup_count[1] < ~std::uint32_t{0})
    CHECK_ERROR(invalid_argument, "strict: ",
                list->dispatch({.pipeline = pipeline,
                                .bind_groups = {complete},
                                .push_constants = constants.first(4),
                                .workgroup_count = {1, device.info().limits.max_workgroup_count[1] + 1, 1}}));
}
