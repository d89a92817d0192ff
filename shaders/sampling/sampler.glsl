// Where the random numbers of a path come from.

#ifndef TANDEM_SAMPLING_SAMPLER
#define TANDEM_SAMPLING_SAMPLER

#include "random.glsl"
#include "sampling/halton.glsl"
#include "sampling/sobol.glsl"
#include "sampling/stratified.glsl"
#include "scene.glsl"

/// Four times 32 bits for a dimension of a path, from the sampler that the settings name. Each of the four is uniform
/// over samples; independent numbers are those of random_bits, to the last bit. What decides about transparent
/// triangles stays with random_bits.
uvec4 sampler_bits(RandomKey key, uint dimension) {
  if (!FEATURE_SAMPLERS || render.sampler_kind == SAMPLER_INDEPENDENT) return random_bits(key, dimension);
  if (render.sampler_kind == SAMPLER_STRATIFIED) return stratified_bits(key, dimension, render.sampler_total);
  if (render.sampler_kind == SAMPLER_HALTON || render.sampler_kind == SAMPLER_HAMMERSLEY)
    return halton_bits(key, dimension, render.sampler_total, render.sampler_kind == SAMPLER_HAMMERSLEY);
  return sobol_bits(key, dimension, render.sampler_total, render.sampler_kind == SAMPLER_BLUE_NOISE);
}

#endif
