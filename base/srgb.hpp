#pragma once

#include <cstdint>

namespace tandem {

/// The transfer function of sRGB (IEC 61966-2-1): linear [0, 1] to encoded [0, 1]. Values beyond are clamped, NaN is 0.
float srgb_encode(float linear);

/// Its inverse.
float srgb_decode(float encoded);

/// srgb_encode to the nearest of 256 steps.
std::uint8_t srgb_encode_8bit(float linear);

}  // namespace tandem
