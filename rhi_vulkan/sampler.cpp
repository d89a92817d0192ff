#include "rhi_vulkan/sampler.hpp"

#include <utility>

namespace tandem::vulkan {
namespace {

// rhi's enumerations have Vulkan's numbers.
vk::Filter filter(rhi::Filter filter) { return static_cast<vk::Filter>(filter); }

vk::SamplerAddressMode address(rhi::AddressMode mode) { return static_cast<vk::SamplerAddressMode>(mode); }

}  // namespace

Sampler::Sampler(ContextHandle context, const rhi::SamplerDesc& desc)
    : rhi::Sampler(desc), context_(std::move(context)) {
  translating_errors(desc.label, "create the sampler", [&] {
    sampler_ = context_->device.createSampler(
        {.magFilter = filter(desc.magnification),
         .minFilter = filter(desc.minification),
         .mipmapMode = static_cast<vk::SamplerMipmapMode>(desc.mipmap),
         .addressModeU = address(desc.address[0]),
         .addressModeV = address(desc.address[1]),
         .addressModeW = address(desc.address[2]),
         .mipLodBias = desc.lod_bias,
         .compareEnable = desc.compare.has_value(),
         .compareOp = static_cast<vk::CompareOp>(desc.compare.value_or(rhi::CompareOp::never)),
         .minLod = desc.min_lod,
         .maxLod = desc.max_lod,
         .borderColor = static_cast<vk::BorderColor>(desc.border),
         .unnormalizedCoordinates = desc.unnormalized_coordinates});
    context_->name(sampler_, desc.label);
  });
}

}  // namespace tandem::vulkan
