#include <utility>

#include "program/execute/execution.hpp"
#include "program/print/print_code.hpp"

namespace tandem::program {

std::vector<std::string> refusals(rhi::Device& device, const Job& job) {
  std::vector<std::string> reasons;
  for (const Shader& shader : job.shaders) {
    try {
      const std::vector<std::uint32_t> words = without_prints(shader.spirv, shader.name);
      const rhi::ShaderModuleHandle module =
          device.create_shader_module({.spirv = words, .label = shader.name, .entry_point = shader.entry_point});
      for (const std::string& reason : device.refusals(module)) reasons.push_back(shader.name + ": " + reason);
    } catch (const rhi::Error& error) {  // what it says begins with the shader's name
      reasons.emplace_back(error.what());
    }
  }
  return reasons;
}

}  // namespace tandem::program
