// Halton's sequence (1960) and Hammersley's point set, scrambled (Owen 1995) so that every sample is uniform and pixels
// are independent.

#ifndef TANDEM_SAMPLING_HALTON
#define TANDEM_SAMPLING_HALTON

#include "random.glsl"
#include "sampling/permutation.glsl"

// Bases of the first dimensions, which therefore are of one sequence. Larger ones need more samples than pictures have
// to be better than random. Further dimensions are padded: they have the first bases again, with the samples in
// another order.
const uint HALTON_DIMENSIONS = 4u;
const uint HALTON_BASES[16] = uint[](2u, 3u, 5u, 7u, 11u, 13u, 17u, 19u, 23u, 29u, 31u, 37u, 41u, 43u, 47u, 53u);

/// The radical inverse of `index`: its digits behind the point in reverse order, each permuted in a way that depends on
/// those before it, by a random affine map modulo the prime `base`: any two digits become any other two equally often,
/// which is all that the variance depends on (Matousek 1998). Digits that are 0 for all indices up to `last` would become
/// independent and uniform; they come from `jitter`, as do those beyond 2^16.
uint radical_inverse_bits(uint index, uint base, uint last, uint key, uint jitter) {
  uint parts = 1u;
  uint part = 0u;
  for (uint rest = max(index, last); rest > 0u && parts * base < 65536u; rest /= base) {
    uint factor_key = hash_bits(key ^ hash_bits((parts << 16u) + part));
    uint factor = 1u + uniform_index(factor_key, base - 1u);
    uint shift = uniform_index(hash_bits(factor_key), base);
    part = part * base + (index % base * factor + shift) % base;
    parts *= base;
    index /= base;
  }
  return stratum_bits(part, parts, jitter);
}

/// With `closed` Hammersley's set of `total` points: the first number of all is i / total, and the others have the bases
/// of those before them; every further `total` samples are another set.
uvec4 halton_bits(RandomKey key, uint dimension, uint total, bool closed) {
  uint count = min(total, 65535u);
  uint repetition = key.sample_index / count;
  uint slot = closed ? ~(2u * repetition) : ~0u;
  uvec4 keys = pcg4d(uvec4(key.pixel, slot, dimension, key.seed));
  bool padded = dimension >= HALTON_DIMENSIONS;
  uint index = key.sample_index;
  // The points of a closed set are visited in random order, so that those taken so far always are uniform.
  if (closed || padded) {
    uvec2 scope = uvec2(~(2u * repetition + 1u), padded ? dimension : 0u);
    index = permuted_index(index % count, count, pcg4d(uvec4(key.pixel, scope, key.seed)).x);
    if (!closed) index += repetition * count;
  }
  uvec4 jitter = random_bits(key, dimension);
  uvec4 bits = uvec4(0u);
  for (uint i = 0u; i < 4u; ++i) {
    uint number = (padded ? 0u : 4u * dimension) + i;
    if (closed && number == 0u) {
      bits[i] = stratum_bits(index, count, jitter[i]);
    } else {
      uint base = HALTON_BASES[closed ? number - 1u : number];
      bits[i] = radical_inverse_bits(index, base, count - 1u, keys[i], jitter[i]);
    }
  }
  return bits;
}

#endif
