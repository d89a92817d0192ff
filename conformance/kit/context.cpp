#include "conformance/kit/context.hpp"

#include <fmt/format.h>

#include <vector>

#include "rhi/glsl/compile.hpp"

namespace tandem::conformance {

rhi::ShaderModuleHandle Context::shader(rhi::ShaderStage stage, const std::string& glsl, const std::string& label) {
  rhi::ShaderModuleHandle& module = shaders_[{stage, glsl}];
  if (module == nullptr) {
    const std::vector<std::uint32_t> spirv = glsl::compile(glsl, stage, label);
    module = device_.create_shader_module({.spirv = spirv, .label = label});
  }
  return module;
}

rhi::ComputePipelineHandle Context::compute_pipeline(const std::string& glsl, const std::string& label,
                                                     const ComputeOptions& options) {
  std::string key = fmt::format("{} {} ", options.required_subgroup_size, options.full_subgroups);
  for (const rhi::SpecializationValue& constant : options.specialization)
    key += fmt::format("{}={} ", constant.id, constant.value);
  rhi::ComputePipelineHandle& pipeline = compute_pipelines_[key + glsl];
  if (pipeline == nullptr) {
    pipeline = device_.create_compute_pipeline({.shader = shader(rhi::ShaderStage::compute, glsl, label),
                                                .specialization = options.specialization,
                                                .required_subgroup_size = options.required_subgroup_size,
                                                .full_subgroups = options.full_subgroups,
                                                .label = label});
  }
  return pipeline;
}

void Context::note(const std::string& sentence) { note_ += (note_.empty() ? "" : "; ") + sentence; }

}  // namespace tandem::conformance
