// Random permutations that are functions: no table, element by element.

#ifndef TANDEM_SAMPLING_PERMUTATION
#define TANDEM_SAMPLING_PERMUTATION

#include "sampling/alias_table.glsl"

/// A hash of 32 bits that is a bijection: one step of a PCG RXS-M-XS generator (O'Neill 2014).
uint hash_bits(uint v) {
  v = v * 747796405u + 2891336453u;
  v = ((v >> ((v >> 28u) + 4u)) ^ v) * 277803737u;
  return v ^ (v >> 22u);
}

/// The smallest 2^n - 1 that is not below v.
uint covering_mask(uint v) {
  v |= v >> 1u;
  v |= v >> 2u;
  v |= v >> 4u;
  v |= v >> 8u;
  return v | (v >> 16u);
}

/// Element `index` of the permutation of 0 ... length - 1 that `key` names: a rotation, which makes every element exactly
/// uniform over keys, and eight rounds of swap-or-not (Hoang, Morris and Rogaway 2012), each of which may exchange the
/// two elements of every pair with the same sum.
uint permuted_index(uint index, uint length, uint key) {
  index += uniform_index(hash_bits(key), length);
  if (index >= length) index -= length;
  for (uint i = 0; i < 8u; ++i) {
    key = hash_bits(key + 0x9e3779b9u);
    uint sum = uniform_index(key, length);
    uint partner = sum >= index ? sum - index : sum + length - index;
    if (hash_bits(key ^ max(index, partner)) >= 0x80000000u) index = partner;
  }
  return index;
}

/// The same for 0 ... 3. Their permutations are the affine maps of pairs of bits.
uint permuted_quadrant(uint quadrant, uint key) {
  uint choice = uniform_index(key, 24u);
  uint first = (choice >> 2u) % 3u;
  uint second = (first + 1u + (choice >> 2u) / 3u) % 3u;
  uint image = choice & 3u;
  if ((quadrant & 1u) != 0u) image ^= first + 1u;
  if ((quadrant & 2u) != 0u) image ^= second + 1u;
  return image;
}

/// Where in [0, 2^32) a point of part `index` of `count` equal ones lies; `jitter` is uniform over 32 bits and says
/// where in its part. count below 2^16.
uint stratum_bits(uint index, uint count, uint jitter) {
  if (count == 1u) return jitter;
  // 2^32 == width * count + rest
  uint width = 0xffffffffu / count;
  uint rest = 0xffffffffu % count + 1u;
  uint begin = index * width + index * rest / count;
  uint end = (index + 1u) * width + (index + 1u) * rest / count;
  return begin + uniform_index(jitter, end - begin);
}

#endif
