#include "rhi/texture_format.hpp"

#include <iterator>

namespace tandem::rhi {
namespace {

constexpr TextureFormatInfo infos[] = {
    {TextureFormat::r8_unorm, "r8_unorm", 1, 1, ComponentKind::unorm},
    {TextureFormat::r8_snorm, "r8_snorm", 1, 1, ComponentKind::snorm},
    {TextureFormat::r8_uint, "r8_uint", 1, 1, ComponentKind::uint},
    {TextureFormat::r8_sint, "r8_sint", 1, 1, ComponentKind::sint},
    {TextureFormat::rg8_unorm, "rg8_unorm", 2, 2, ComponentKind::unorm},
    {TextureFormat::rg8_snorm, "rg8_snorm", 2, 2, ComponentKind::snorm},
    {TextureFormat::rg8_uint, "rg8_uint", 2, 2, ComponentKind::uint},
    {TextureFormat::rg8_sint, "rg8_sint", 2, 2, ComponentKind::sint},
    {TextureFormat::rgba8_unorm, "rgba8_unorm", 4, 4, ComponentKind::unorm},
    {TextureFormat::rgba8_snorm, "rgba8_snorm", 4, 4, ComponentKind::snorm},
    {TextureFormat::rgba8_uint, "rgba8_uint", 4, 4, ComponentKind::uint},
    {TextureFormat::rgba8_sint, "rgba8_sint", 4, 4, ComponentKind::sint},
    {TextureFormat::r16_unorm, "r16_unorm", 2, 1, ComponentKind::unorm},
    {TextureFormat::r16_snorm, "r16_snorm", 2, 1, ComponentKind::snorm},
    {TextureFormat::r16_uint, "r16_uint", 2, 1, ComponentKind::uint},
    {TextureFormat::r16_sint, "r16_sint", 2, 1, ComponentKind::sint},
    {TextureFormat::r16_float, "r16_float", 2, 1, ComponentKind::floating},
    {TextureFormat::rg16_unorm, "rg16_unorm", 4, 2, ComponentKind::unorm},
    {TextureFormat::rg16_snorm, "rg16_snorm", 4, 2, ComponentKind::snorm},
    {TextureFormat::rg16_uint, "rg16_uint", 4, 2, ComponentKind::uint},
    {TextureFormat::rg16_sint, "rg16_sint", 4, 2, ComponentKind::sint},
    {TextureFormat::rg16_float, "rg16_float", 4, 2, ComponentKind::floating},
    {TextureFormat::rgba16_unorm, "rgba16_unorm", 8, 4, ComponentKind::unorm},
    {TextureFormat::rgba16_snorm, "rgba16_snorm", 8, 4, ComponentKind::snorm},
    {TextureFormat::rgba16_uint, "rgba16_uint", 8, 4, ComponentKind::uint},
    {TextureFormat::rgba16_sint, "rgba16_sint", 8, 4, ComponentKind::sint},
    {TextureFormat::rgba16_float, "rgba16_float", 8, 4, ComponentKind::floating},
    {TextureFormat::r32_uint, "r32_uint", 4, 1, ComponentKind::uint},
    {TextureFormat::r32_sint, "r32_sint", 4, 1, ComponentKind::sint},
    {TextureFormat::r32_float, "r32_float", 4, 1, ComponentKind::floating},
    {TextureFormat::rg32_uint, "rg32_uint", 8, 2, ComponentKind::uint},
    {TextureFormat::rg32_sint, "rg32_sint", 8, 2, ComponentKind::sint},
    {TextureFormat::rg32_float, "rg32_float", 8, 2, ComponentKind::floating},
    {TextureFormat::rgba32_uint, "rgba32_uint", 16, 4, ComponentKind::uint},
    {TextureFormat::rgba32_sint, "rgba32_sint", 16, 4, ComponentKind::sint},
    {TextureFormat::rgba32_float, "rgba32_float", 16, 4, ComponentKind::floating},
    {TextureFormat::r64_uint, "r64_uint", 8, 1, ComponentKind::uint},
    {TextureFormat::r64_sint, "r64_sint", 8, 1, ComponentKind::sint},
    {TextureFormat::rgb10a2_unorm, "rgb10a2_unorm", 4, 4, ComponentKind::unorm},
    {TextureFormat::rgb10a2_uint, "rgb10a2_uint", 4, 4, ComponentKind::uint},
    {TextureFormat::rg11b10_float, "rg11b10_float", 4, 3, ComponentKind::floating},
    {TextureFormat::rgba8_srgb, "rgba8_srgb", 4, 4, ComponentKind::unorm},
    {TextureFormat::bgra8_unorm, "bgra8_unorm", 4, 4, ComponentKind::unorm},
    {TextureFormat::d16_unorm, "d16_unorm", 2, 1, ComponentKind::depth},
    {TextureFormat::d32_float, "d32_float", 4, 1, ComponentKind::depth},
};

constexpr bool in_order() {
  for (std::size_t i = 0; i < std::size(infos); ++i)
    if (static_cast<std::size_t>(infos[i].format) != i) return false;
  return true;
}
static_assert(std::size(infos) == texture_format_count && in_order());

}  // namespace

const TextureFormatInfo& info_of(TextureFormat format) { return infos[static_cast<std::size_t>(format)]; }

}  // namespace tandem::rhi
