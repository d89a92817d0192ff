#include "rhi/texture_view.hpp"

namespace tandem::rhi {

ResolvedView resolved(const TextureView& view, bool one_level) {
  const TextureDesc& desc = view.texture->desc();
  const std::uint32_t layers = is_layered(desc.dimension) ? desc.size[2] : 1;
  ResolvedView result = {.texture = view.texture,
                         .first_level = view.first_level,
                         .level_count = view.level_count,
                         .first_layer = view.first_layer,
                         .layer_count = view.layer_count,
                         .dimension = view.dimension.value_or(desc.dimension)};
  if (result.level_count == 0) result.level_count = one_level ? 1 : desc.level_count - view.first_level;
  if (result.layer_count == 0) result.layer_count = layers - view.first_layer;
  return result;
}

TextureView view_of(const BoundResource& resource) {
  if (const auto* texture = std::get_if<TextureHandle>(&resource)) return {.texture = *texture};
  if (const auto* view = std::get_if<TextureView>(&resource)) return *view;
  if (const auto* sampled = std::get_if<SampledTexture>(&resource)) return sampled->view;
  return {};
}

BufferRange range_of(const BoundResource& resource) {
  if (const auto* range = std::get_if<BufferRange>(&resource)) return *range;
  if (const auto* texels = std::get_if<TexelBuffer>(&resource)) return texels->range;
  return {};
}

SamplerHandle sampler_of(const BoundResource& resource) {
  if (const auto* sampler = std::get_if<SamplerHandle>(&resource)) return *sampler;
  if (const auto* sampled = std::get_if<SampledTexture>(&resource)) return sampled->sampler;
  return nullptr;
}

}  // namespace tandem::rhi
