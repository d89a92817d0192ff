#include "rhi_cpu/sampler.hpp"

#include <cstdint>
#include <utility>

namespace tandem::cpu {
namespace {

/// Both sides have Vulkan's numbers: kernels know nothing of the rhi.
template <typename A, typename B>
constexpr bool are_equal(A a, B b) {
  return static_cast<std::uint32_t>(a) == static_cast<std::uint32_t>(b);
}
static_assert(are_equal(rhi::Filter::linear, kernel::Filter::linear));
static_assert(are_equal(rhi::AddressMode::mirror_clamp_to_edge, kernel::AddressMode::mirror_clamp_to_edge));
static_assert(are_equal(rhi::CompareOp::always, kernel::CompareOp::always));
static_assert(are_equal(rhi::BorderColor::int_opaque_white, kernel::BorderColor::int_opaque_white));

kernel::Sampler view_of(const rhi::SamplerDesc& desc) {
  kernel::Sampler sampler;
  sampler.magnification = static_cast<kernel::Filter>(desc.magnification);
  sampler.minification = static_cast<kernel::Filter>(desc.minification);
  sampler.mipmap = static_cast<kernel::Filter>(desc.mipmap);
  for (std::size_t i = 0; i < 3; ++i) sampler.address[i] = static_cast<kernel::AddressMode>(desc.address[i]);
  sampler.lod_bias = desc.lod_bias;
  sampler.min_lod = desc.min_lod;
  sampler.max_lod = desc.max_lod;
  sampler.compare = static_cast<kernel::CompareOp>(desc.compare.value_or(rhi::CompareOp::never));
  sampler.border = static_cast<kernel::BorderColor>(desc.border);
  sampler.unnormalized = desc.unnormalized_coordinates;
  return sampler;
}

}  // namespace

Sampler::Sampler(DeviceStateHandle device, const rhi::SamplerDesc& desc)
    : rhi::Sampler(desc), device_(std::move(device)), view_(view_of(desc)) {}

}  // namespace tandem::cpu
