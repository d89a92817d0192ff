#include "base/srgb.hpp"

#include <cmath>

namespace tandem {

float srgb_encode(float linear) {
  if (!(linear > 0)) return 0;
  if (linear >= 1) return 1;
  return linear <= 0.0031308f ? 12.92f * linear : 1.055f * std::pow(linear, 1 / 2.4f) - 0.055f;
}

float srgb_decode(float encoded) {
  if (!(encoded > 0)) return 0;
  if (encoded >= 1) return 1;
  return encoded <= 0.04045f ? encoded / 12.92f : std::pow((encoded + 0.055f) / 1.055f, 2.4f);
}

std::uint8_t srgb_encode_8bit(float linear) {
  return static_cast<std::uint8_t>(std::lround(255 * srgb_encode(linear)));
}

}  // namespace tandem
