#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "rhi/shader_module.hpp"

namespace tandem::rhi {

/// The value of one specialisation constant of 32 bits: int, uint or float bits; bool: 0 or 1.
struct SpecializationValue {
  std::uint32_t id = 0;
  std::uint32_t value = 0;
};

struct ComputePipelineDesc {
  ShaderModuleHandle shader;
  std::vector<SpecializationValue> specialization;  ///< constants that are not named keep their defaults
  std::string label;
};

/// A compute shader ready to run. Its bind group layouts are those that the shader's reflection gives.
class ComputePipeline {
 public:
  virtual ~ComputePipeline() = default;
  ComputePipeline(const ComputePipeline&) = delete;
  ComputePipeline& operator=(const ComputePipeline&) = delete;

  const std::string& label() const noexcept { return desc_.label; }
  const ComputePipelineDesc& desc() const noexcept { return desc_; }
  const ShaderReflection& reflection() const noexcept { return desc_.shader->reflection(); }

 protected:
  explicit ComputePipeline(ComputePipelineDesc desc) : desc_(std::move(desc)) {}

 private:
  ComputePipelineDesc desc_;
};

using ComputePipelineHandle = std::shared_ptr<ComputePipeline>;

}  // namespace tandem::rhi
