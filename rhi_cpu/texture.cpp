#include "rhi_cpu/texture.hpp"

namespace tandem::cpu {

Texture::Texture(DeviceStateHandle device, const rhi::TextureDesc& desc)
    : rhi::Texture(desc),
      device_(std::move(device)),
      memory_(allocate_host_memory(size_in_bytes(), desc.label, "a texture")),
      image_{.texels = memory_.get(),
             .size = {desc.size[0], desc.size[1], desc.size[2]},
             .format = static_cast<std::uint32_t>(desc.format)} {}

}  // namespace tandem::cpu
