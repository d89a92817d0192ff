#include "rhi/ray_tracing_pipeline.hpp"

#include <algorithm>

namespace tandem::rhi {

std::vector<ShaderModuleHandle> shaders_of(const RayTracingPipelineDesc& desc) {
  std::vector<ShaderModuleHandle> shaders;
  const auto add = [&shaders](const ShaderModuleHandle& shader) {
    if (shader != nullptr && std::find(shaders.begin(), shaders.end(), shader) == shaders.end())
      shaders.push_back(shader);
  };
  for (const ShaderModuleHandle& shader : desc.ray_generation) add(shader);
  for (const ShaderModuleHandle& shader : desc.miss) add(shader);
  for (const HitGroup& group : desc.hit_groups) {
    add(group.closest_hit);
    add(group.any_hit);
    add(group.intersection);
  }
  for (const ShaderModuleHandle& shader : desc.callable) add(shader);
  return shaders;
}

}  // namespace tandem::rhi
