#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "rhi/texture_format.hpp"

/// What the bytes of a texel must be, computed with doubles from Vulkan's "Fixed-Point Data Conversions" and "Floating-
/// Point Format Conversions", for values whose rounding is beyond doubt.
namespace tandem::conformance {

using Value = std::array<double, 4>;

/// Of a format that is no depth format. Floats must be exact in the format.
std::vector<std::uint8_t> encoded(rhi::TextureFormat format, const Value& value);

/// What a shader reads of `value` once it was stored: clamped, rounded, and (0, 0, 0, 1) where the format lacks a
/// component.
Value read_back(rhi::TextureFormat format, const Value& value);

}  // namespace tandem::conformance
