#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "rhi/texture_format.hpp"
#include "rhi_cpu/kernel/abi.hpp"

/// What a kernel is run with in place of textures.
namespace tandem::test {

/// A kernel's Resource points at a kernel::Image, Sampler or SampledImage, which it does not write.
template <typename T>
kernel::Resource resource_of(const T& described) {
  return {const_cast<std::byte*>(reinterpret_cast<const std::byte*>(&described)), 0};
}

/// An image of one level.
template <typename T>
kernel::Image image_of(std::vector<T>& texels, rhi::TextureFormat format, std::array<std::uint32_t, 3> size) {
  return {reinterpret_cast<std::byte*>(texels.data()), {size[0], size[1], size[2]}, static_cast<std::uint32_t>(format)};
}

}  // namespace tandem::test
