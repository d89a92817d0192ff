#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "program/job/value_type.hpp"
#include "rhi/texture.hpp"

/// The texels of images as values.
namespace tandem::program {

/// A texel: a scalar or a vector of components, which are whole numbers where the texel holds them so; where they share
/// bits one whole number.
ValueType texel_type(rhi::TextureFormat format);

/// What lies in all bytes of a texture: of one level its rows, "[y][x].z", of several a structure of levels.
ValueType texture_type(const rhi::TextureDesc& desc);

/// Whether every component of a texel has bytes of its own.
bool has_plain_components(rhi::TextureFormat format);

/// Texels of a format with plain components from floats in RGBA, four for each texel: a number in [0, 1] or [-1, 1]
/// becomes the nearest of a normalised format, of an integer format the number without its fraction.
std::vector<std::byte> texels_of(rhi::TextureFormat format, std::span<const float> rgba);

/// The other way around; components that the format lacks are 0, alpha 1.
std::vector<float> rgba_of(rhi::TextureFormat format, std::span<const std::byte> texels);

}  // namespace tandem::program
