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
