#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "rhi/pipeline.hpp"

namespace tandem::rhi {

struct ComputePipelineDesc {
  ShaderModuleHandle shader;
  std::vector<SpecializationValue> specialization;  ///< constants that are not named keep their defaults
  /// The most elements that a bind group gives to an array of descriptors without a length, such as textures[].
  std::uint32_t unsized_array_length = usual_unsized_array_length;
  /// gl_SubgroupSize: a power of two from Limits::min_subgroup_size to max_subgroup_size. 0: Limits::subgroup_size, or
  /// for SPIR-V 1.6 and later any such power of two that the device chooses. Vulkan: VK_EXT_subgroup_size_control.
  std::uint32_t required_subgroup_size = 0;
  /// Every subgroup has as many invocations as its size. The first dimension of the workgroup must be a multiple of
  /// that size: of the largest, where the device chooses. Vulkan: VK_EXT_subgroup_size_control.
  bool full_subgroups = false;
  std::string label;
};

/// A compute shader ready to run. Its bind group layouts are those that the shader's reflection gives.
class ComputePipeline : public Pipeline {
 public:
  const ComputePipelineDesc& desc() const noexcept { return desc_; }
  const ShaderReflection& reflection() const noexcept { return desc_.shader->reflection(); }

 protected:
  explicit ComputePipeline(ComputePipelineDesc desc)
      : Pipeline(Kind::compute, desc.label,
                 combined_interface({&desc.shader, 1}, desc.label, desc.unsized_array_length)),
        desc_(std::move(desc)) {}

 private:
  ComputePipelineDesc desc_;
};

using ComputePipelineHandle = std::shared_ptr<ComputePipeline>;

}  // namespace tandem::rhi
