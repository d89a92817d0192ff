// Adds light to a pixel that any invocation may add to at the same time. The sums are whole numbers, so the order does
// not matter: 64 bits each, in two words, since not every device has atomics on more than 32 bits.

#ifndef TANDEM_METROPOLIS_SPLAT
#define TANDEM_METROPOLIS_SPLAT

#include "metropolis/chain.glsl"

/// Units of a splat of 1. The luminance of a splat is at most 1, as splat_path weights it, so each channel is below 14
/// and has fewer than 2^32 units; the sum of 2^32 of them, more than a picture has, is below 2^64.
const float SPLAT_UNITS = 268435456.0;

uint splat_units(float value) {
  precise float scaled_value = value * SPLAT_UNITS;
  precise float units = scaled_value + 0.5;
  if (!(value > 0.0)) units = 0.0;
  return units < 4294967040.0 ? uint(units) : 4294967040u;
}

// GLSL gives no function an array of a buffer.
#define SPLAT_INTO(sums, pixel, value)                                                                      \
  uvec3 units = uvec3(splat_units((value).x), splat_units((value).y), splat_units((value).z));              \
  for (uint i = 0; i < 3; ++i) {                                                                            \
    if (units[i] == 0) continue;                                                                            \
    uint word = 6 * (pixel) + 2 * i;                                                                        \
    uint before = atomicAdd(sums[word], units[i]);                                                          \
    if (before + units[i] < before) atomicAdd(sums[word + 1], 1u);                                          \
  }

void splat(uint pixel, vec3 value) { SPLAT_INTO(splats, pixel, value) }
void splat_large(uint pixel, vec3 value) { SPLAT_INTO(large_splats, pixel, value) }

#endif
