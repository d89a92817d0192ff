// Where the random numbers of a path come from.

#ifndef TANDEM_SAMPLING_SAMPLER
#define TANDEM_SAMPLING_SAMPLER

#include "random.glsl"
#include "scene.glsl"

/// Four times 32 bits for a dimension of a path, from the sampler that the settings name. Each of the four is uniform
/// over samples; independent numbers are those of random_bits, to the last bit. What decides about transparent
/// triangles stays with random_bits.
uvec4 sampler_bits(RandomKey key, uint dimension) { return random_bits(key, dimension); }

#endif
