// Sobol's sequence (1967) in four dimensions, Owen-scrambled by hashing and padded (Burley, Practical Hash-based Owen
// Scrambling, JCGT 9(4), 2020): every dimension of a path has the sequence again, scrambled and in an order of its own.

#ifndef TANDEM_SAMPLING_SOBOL
#define TANDEM_SAMPLING_SOBOL

#include "random.glsl"
#include "sampling/permutation.glsl"

/// Point `index` of the sequence, as fractions of 2^32. The direction numbers are those of Joe and Kuo
/// (new-joe-kuo-6.21201, 2008): x is the van der Corput sequence; the others begin with m = (1), (1, 3), (1, 3, 1) and
/// go on by the recurrences of the polynomials x + 1, x^2 + x + 1, x^3 + x + 1.
uvec4 sobol_point(uint index) {
  uvec4 bits = uvec4(bitfieldReverse(index), 0u, 0u, 0u);
  uint y = 1u << 31u;
  uvec2 z = uvec2(1u << 31u, 3u << 30u);
  uvec3 w = uvec3(1u << 31u, 3u << 30u, 1u << 29u);
  for (; index != 0u; index >>= 1u) {
    if ((index & 1u) != 0u) bits ^= uvec4(0u, y, z.x, w.x);
    y ^= y >> 1u;
    z = uvec2(z.y, z.y ^ z.x ^ (z.x >> 2u));
    w = uvec3(w.y, w.z, w.y ^ w.x ^ (w.x >> 3u));
  }
  return bits;
}

/// Flips each bit by a hash of the key and the bits above it: the scrambling of Owen (1995) by the kind of hash of Laine
/// and Karras (2011), whose products carry information upwards only; the one of Vegdahl (Building a Better LK Hash,
/// 2021). All bits of the key must be good, which the lower ones of pcg4d are not.
uint owen_scrambled(uint bits, uint key) {
  uint v = bitfieldReverse(bits);
  v ^= v * 0x3d20adeau;
  v += key;
  v *= (key >> 16u) | 1u;
  v ^= v * 0x05526c56u;
  v ^= v * 0x53a22864u;
  return bitfieldReverse(v);
}

/// The place of a pixel of a tile of 256 x 256 on a curve through all of them: the Morton curve with the quadrants of
/// each square in an order of its own.
uint dithering_order(uint x, uint y, uint key) {
  uint place = 1u;  // the leading 1 tells the levels apart
  for (uint level = 8u; level-- > 0u;) {
    uint quadrant = ((y >> level) & 1u) << 1u | ((x >> level) & 1u);
    place = place << 2u | permuted_quadrant(quadrant, hash_bits(key ^ hash_bits(place)));
  }
  return place & 0xffffu;
}

/// With `dithered` the samples of all pixels of a tile of 256 x 256 are one sequence, ordered so that what nearby pixels
/// have make a net together, and their errors cancel: blue noise (Ahmed and Wonka, Screen-Space Blue-Noise Diffusion of
/// Monte Carlo Sampling Error via Hierarchical Ordering of Pixels, 2020). `total` is best a power of two, which it is
/// rounded up to, and at most 2^16: further samples are sequences of their own.
uvec4 sobol_bits(RandomKey key, uint dimension, uint total, bool dithered) {
  uint mask = covering_mask(total - 1u);
  uint index = key.sample_index;
  uint scope = key.pixel;
  uint repetition = 0u;
  if (dithered) {
    mask &= 0xffffu;
    scope = (key.pixel >> 8u) & 0x00ff00ffu;
    repetition = index / (mask + 1u);
  }
  uvec4 keys = pcg4d(uvec4(scope, ~(2u * repetition), dimension, key.seed));
  uint order = hash_bits(pcg4d(uvec4(scope, ~(2u * repetition + 1u), dimension, key.seed)).x);
  uint base = 0u;
  if (dithered) {
    uint place = dithering_order(key.pixel & 0xffu, (key.pixel >> 16u) & 0xffu, order);
    base = place * (mask + 1u);
    order = hash_bits(order + place);
  } else if (index > mask) {
    // Beyond what is planned every doubling is in an order of its own.
    mask = covering_mask(index) >> 1u;
    base = mask + 1u;
  }
  // Scrambling the index keeps blocks of powers of two together.
  uvec4 bits = sobol_point(base + (owen_scrambled(index, order) & mask));
  for (uint i = 0u; i < 4u; ++i) bits[i] = owen_scrambled(bits[i], hash_bits(keys[i]));
  return bits;
}

#endif
