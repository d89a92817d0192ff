#pragma once

#include "rhi/sampler.hpp"
#include "rhi_vulkan/context.hpp"

namespace tandem::vulkan {

class Sampler final : public rhi::Sampler {
 public:
  Sampler(ContextHandle context, const rhi::SamplerDesc& desc);

  const ContextHandle& context() const noexcept { return context_; }
  vk::Sampler handle() const { return *sampler_; }

 private:
  ContextHandle context_;
  vk::raii::Sampler sampler_ = nullptr;
};

}  // namespace tandem::vulkan
