#include <utility>

#include "program/execute/execution.hpp"

namespace tandem::program {

std::vector<std::string> refusals(rhi::Device& device, const Job& job) {
  std::vector<std::string> reasons;
  for (const Shader& shader : job.shaders) {
    try {
      const rhi::ShaderModuleHandle module =
          device.create_shader_module({.spirv = shader.spirv, .label = shader.name, .entry_point = shader.entry_point});
      for (const std::string& reason : device.refusals(module)) reasons.push_back(shader.name + ": " + reason);
    } catch (const rhi::Error& error) {  // what it says begins with the shader's name
      reasons.emplace_back(error.what());
    }
  }
  return reasons;
}

}  // namespace tandem::program
