#include "tests/faults/faulty_device.hpp"

#include <doctest/doctest.h>

#include <cstdint>
#include <span>
#include <vector>

#include "tests/support/device_test.hpp"

using namespace tandem;
using namespace tandem::test;

namespace {

const char* const counting_shader = R"(#version 460
layout(local_size_x = 1) in;
layout(set = 0, binding = 0, std430) buffer Values { uint values[]; };
layout(push_constant) uniform Constants { uint step; };
layout(constant_id = 3) const uint factor = 1;
uint scaled(uint value) { return value * factor; }
void main() { values[gl_GlobalInvocationID.x] += scaled(step); }
)";

/// Four values of 1 (an upload) or 2 (a fill of the last), to which a dispatch over all adds 10 * 3, another 20 * 3.
std::vector<std::uint32_t> values_of(rhi::Device& device) {
  const rhi::ComputePipelineHandle pipeline = compute_pipeline(device, counting_shader, "counting", {{3, 3}});
  const rhi::BufferHandle buffer =
      device.create_buffer({.size = 16, .usage = rhi::BufferUsage::storage, .label = "values"});
  rhi::BindGroupDesc bindings;
  bindings.pipeline = pipeline;
  bindings.entries.push_back({.binding = 0, .resource = rhi::BufferRange{buffer}});
  bindings.label = "values";
  const rhi::BindGroupHandle group = device.create_bind_group(bindings);
  const rhi::CommandListHandle list = device.create_command_list("counting");
  const std::vector<std::uint32_t> ones(3, 1);
  list->upload(buffer, 0, std::as_bytes(std::span(ones)));
  list->fill({buffer, 12, 4}, 2);
  for (const std::uint32_t step : {10u, 20u})
    list->dispatch({.pipeline = pipeline,
                    .bind_groups = {group},
                    .push_constants = std::as_bytes(std::span(&step, 1)),
                    .workgroup_count = {4, 1, 1}});
  device.submit(list)->wait();
  return contents<std::uint32_t>(device, buffer, 4);
}

using Values = std::vector<std::uint32_t>;

}  // namespace

TANDEM_DEVICE_TEST("A device without a fault passes everything on") {
  CHECK(values_of(*faulty_device(device_handle, {})) == Values{91, 91, 91, 92});
}

TANDEM_DEVICE_TEST("A shader, its constants, uploads, fills and dispatches are edited one by one") {
  DeviceEdits shader;
  shader.shader = [](SpirvModule& module, rhi::ShaderStage) {
    return module.edit_function("scaled", [](Instruction instruction, CodeWriter& code) {
      if (instruction.opcode != spv::OpIMul) return code.put(instruction);
      code.put_changed(instruction, [&](std::uint32_t result) {
        return code.value(spv::OpIAdd, instruction.type(), {result, code.module().constant(1u)});
      });
    });
  };
  CHECK(values_of(*faulty_device(device_handle, shader)) == Values{93, 93, 93, 94});

  DeviceEdits specialization;
  specialization.specialization = [](std::vector<rhi::SpecializationValue>& values) { values.clear(); };
  CHECK(values_of(*faulty_device(device_handle, specialization)) == Values{31, 31, 31, 32});

  DeviceEdits upload;
  upload.upload = [](const rhi::Buffer&, std::vector<std::byte>& bytes) { bytes.at(0) = std::byte{9}; };
  CHECK(values_of(*faulty_device(device_handle, upload)) == Values{99, 91, 91, 92});

  DeviceEdits fill;
  fill.skips_fills = true;
  CHECK(values_of(*faulty_device(device_handle, fill)) == Values{91, 91, 91, 0x3f000000u + 90});

  DeviceEdits dispatch;
  dispatch.dispatch = [](DispatchEdit& run, const DispatchEdit* previous) {
    run.size[0] -= 1;
    if (previous != nullptr) run.push_constants = previous->push_constants;
  };
  CHECK(values_of(*faulty_device(device_handle, dispatch)) == Values{61, 61, 61, 2});
}

TANDEM_DEVICE_TEST("A device may not change what it has not seen") {
  DeviceEdits edits;
  edits.vertex = [](std::array<float, 3>& position) { position[0] = 0; };
  const rhi::DeviceHandle faulty = faulty_device(device_handle, edits);
  rhi::TriangleGeometry geometry;
  geometry.vertices.buffer = faulty->create_buffer(
      {.size = 36, .usage = rhi::BufferUsage::acceleration_structure_input, .label = "never written"});
  geometry.vertex_count = 3;
  geometry.triangle_count = 1;
  const rhi::BottomLevelDesc desc{.geometries = {geometry}, .label = "triangle"};
  const rhi::AccelerationStructureHandle structure = faulty->create_bottom_level(desc);
  const rhi::CommandListHandle list = faulty->create_command_list("build");
  CHECK_THROWS_AS(list->build_bottom_level(structure, desc), rhi::Error);
}
