#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "rhi/device.hpp"

/// Random numbers of shaders/sampling, drawn on a device.
namespace tandem::test {

/// What draws them: a name for messages, and the call in GLSL with `key`, `dimension` and `total`.
struct Sampler {
  std::string name;
  std::string call;
};

inline const Sampler independent{"independent", "random_bits(key, dimension)"};
inline const Sampler stratified{"stratified", "stratified_bits(key, dimension, total)"};
inline const Sampler halton{"halton", "halton_bits(key, dimension, total, false)"};
inline const Sampler hammersley{"hammersley", "halton_bits(key, dimension, total, true)"};
inline const Sampler sobol{"sobol", "sobol_bits(key, dimension, total, false)"};
inline const Sampler blue_noise{"blue noise", "sobol_bits(key, dimension, total, true)"};
inline const std::array samplers = {independent, stratified, halton, hammersley, sobol, blue_noise};

struct Draw {
  std::uint32_t x = 0;  ///< of the pixel
  std::uint32_t y = 0;
  std::uint32_t sample = 0;
  std::uint32_t dimension = 0;
  std::uint32_t seed = 0;
};

using Bits = std::array<std::uint32_t, 4>;

/// The four numbers of each draw. @param total the samples planned
std::vector<Bits> draw(rhi::Device& device, const Sampler& sampler, std::uint32_t total,
                       const std::vector<Draw>& draws);

/// The numbers of samples 0 ... count - 1 of a pixel.
std::vector<Bits> draw_samples(rhi::Device& device, const Sampler& sampler, std::uint32_t total, Draw first,
                               std::uint32_t count);

/// In [0, 1).
inline double fraction(std::uint32_t bits) { return bits / 4294967296.0; }

}  // namespace tandem::test
