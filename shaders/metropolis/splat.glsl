// Adds light to a pixel that any invocation may add to at the same time. The sums are whole numbers, so the order does
// not matter: 64 bits each, in two words, since not every device has atomics on more than 32 bits.

#ifndef TANDEM_METROPOLIS_SPLAT
#define TANDEM_METROPOLIS_SPLAT

#include "metropolis/chain.glsl"

/// Units of a splat of 1. A splat is below 2^8, so the sum of 2^32 of them, more than a picture has, is below 2^64.
const float SPLAT_UNITS = 16777216.0;

void splat_channel(uint channel, float value) {
  if (!(value > 0.0)) return;
  precise float units = value * SPLAT_UNITS + 0.5;
  uint addend = units < 4294967040.0 ? uint(units) : 4294967040u;
  if (addend == 0) return;
  uint before = atomicAdd(splats[2 * channel], addend);
  if (before + addend < before) atomicAdd(splats[2 * channel + 1], 1u);
}

void splat(uint pixel, vec3 value) {
  splat_channel(3 * pixel, value.x);
  splat_channel(3 * pixel + 1, value.y);
  splat_channel(3 * pixel + 2, value.z);
}

#endif
