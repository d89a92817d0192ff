#include "tests/rhi_cpu/groups/device.hpp"

#include "rhi/glsl/compile.hpp"
#include "rhi/transfer.hpp"
#include "rhi_cpu/device.hpp"

namespace tandem::cpu::test {

rhi::DeviceHandle device_with(std::uint32_t subgroup_size) {
  rhi::DeviceDesc desc;
  desc.subgroup_size = subgroup_size;
  return create_device(desc, {});
}

/// Runs workgroups of the shader over one buffer of these words and returns what is in it then.
Words run(rhi::Device& device, const std::vector<std::uint32_t>& spirv, const Words& words, std::uint32_t workgroups) {
  const rhi::ComputePipelineHandle pipeline =
      device.create_compute_pipeline({.shader = device.create_shader_module({.spirv = spirv, .label = "shader"}),
                                      .specialization = {},
                                      .label = "groups"});
  const rhi::BufferHandle buffer = rhi::create_filled(device, words, rhi::BufferUsage::storage, "words");
  const rhi::CommandListHandle list = device.create_command_list("groups");
  rhi::BindGroupDesc bindings;
  bindings.pipeline = pipeline;
  bindings.entries.push_back({.binding = 0, .resource = rhi::BufferRange{buffer}});
  bindings.label = "group";
  const rhi::BindGroupHandle group = device.create_bind_group(bindings);
  list->dispatch({.pipeline = pipeline, .bind_groups = {group}, .workgroup_count = {workgroups, 1, 1}});
  device.submit(list);
  return rhi::read<std::uint32_t>(device, buffer, words.size());
}

Words run(rhi::Device& device, const std::string& glsl, const Words& words, std::uint32_t workgroups) {
  return run(device, glsl::compile("#version 460\n" + glsl, rhi::ShaderStage::compute, "shader.comp"), words,
             workgroups);
}

}  // namespace tandem::cpu::test
