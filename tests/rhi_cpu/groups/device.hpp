#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "rhi/glsl/compile.hpp"
#include "rhi/transfer.hpp"
#include "rhi_cpu/device.hpp"

/// Compute shaders on CPU devices with subgroups of a chosen size.
namespace tandem::cpu::test {

using Words = std::vector<std::uint32_t>;

inline rhi::DeviceHandle device_with(std::uint32_t subgroup_size) {
  rhi::DeviceDesc desc;
  desc.subgroup_size = subgroup_size;
  return create_device(desc, {});
}

/// Runs workgroups of the shader over one buffer of these words and returns what is in it then.
inline Words run(rhi::Device& device, const std::vector<std::uint32_t>& spirv, const Words& words,
                 std::uint32_t workgroups = 1) {
  const rhi::ComputePipelineHandle pipeline =
      device.create_compute_pipeline({.shader = device.create_shader_module({.spirv = spirv, .label = "shader"}),
                                      .specialization = {},
                                      .label = "groups"});
  const rhi::BufferHandle buffer = rhi::create_filled(device, words, rhi::BufferUsage::storage, "words");
  const rhi::CommandListHandle list = device.create_command_list("groups");
  list->dispatch(
      {.pipeline = pipeline,
       .bind_groups = {device.create_bind_group({.pipeline = pipeline,
                                                 .entries = {{.binding = 0, .resource = rhi::BufferRange{buffer}}},
                                                 .label = "group"})},
       .workgroup_count = {workgroups, 1, 1}});
  device.submit(list);
  return rhi::read<std::uint32_t>(device, buffer, words.size());
}

inline Words run(rhi::Device& device, const std::string& glsl, const Words& words, std::uint32_t workgroups = 1) {
  return run(device, glsl::compile("#version 460\n" + glsl, rhi::ShaderStage::compute, "shader.comp"), words,
             workgroups);
}

}  // namespace tandem::cpu::test
