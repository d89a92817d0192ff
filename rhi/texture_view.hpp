#pragma once

#include "rhi/bind_group.hpp"

namespace tandem::rhi {

/// A view with every count said and the dimension that the shader sees.
struct ResolvedView {
  TextureHandle texture;
  std::uint32_t first_level = 0;
  std::uint32_t level_count = 1;
  std::uint32_t first_layer = 0;
  std::uint32_t layer_count = 1;
  TextureDimension dimension = TextureDimension::d2;
};

/// @param one_level what a storage image is
ResolvedView resolved(const TextureView& view, bool one_level);

/// The view behind a TextureHandle, a TextureView or a SampledTexture; without a texture for every other resource.
TextureView view_of(const BoundResource& resource);

/// The range behind a BufferRange or a TexelBuffer; empty for every other resource.
BufferRange range_of(const BoundResource& resource);

/// The sampler behind a SamplerHandle or a SampledTexture; null for every other resource.
SamplerHandle sampler_of(const BoundResource& resource);

}  // namespace tandem::rhi
