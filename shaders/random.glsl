// Random numbers without state: each is a hash of (pixel, sample, dimension, seed), so a number depends on nothing but
// what it is for. Four at a time by pcg4d (Jarzynski and Olano, Hash Functions for GPU Rendering, JCGT 9(3), 2020).

#ifndef TANDEM_RANDOM
#define TANDEM_RANDOM

/// What all random numbers of one path have in common.
struct RandomKey {
  uint pixel;  // x + y * 2^16
  uint sample_index;
  uint seed;
};

// The dimensions of a path, four numbers each: one for the camera, then two for each vertex. Vertices are counted by the
// segments before them, those that end where a medium begins included. What few paths need, and what decides about
// transparent triangles, has ranges of its own.
const uint DIMENSION_CAMERA = 0;          // the point on the film (x, y) and on the lens (z, w)
const uint DIMENSION_TIME = 0x40000000u;  // when, while the shutter is open (x)

/// Of the vertex at the end of path segment `segment` (0: the camera ray): the scattered direction (x, y, z) and roulette
/// (w).
uint scattering_dimension(uint segment) { return 1 + 2 * segment; }

/// Of the same vertex: the choice of a light (x, y) and of a point on it (z, w).
uint light_dimension(uint segment) { return 2 + 2 * segment; }

/// Of path segment `segment`, in a medium: the colour for which its length is sampled (x), and the length (y).
uint medium_dimension(uint segment) { return 0x20000000u + segment; }

/// Of path segment `segment`: which transparent triangles it meets.
uint segment_dimension(uint segment) { return 0x80000000u + 2 * segment; }

/// Of the shadow ray from the vertex at the segment's end: likewise.
uint shadow_dimension(uint segment) { return 0x80000001u + 2 * segment; }

uvec4 pcg4d(uvec4 v) {
  v = v * 1664525u + 1013904223u;
  v.x += v.y * v.w;
  v.y += v.z * v.x;
  v.z += v.x * v.y;
  v.w += v.y * v.z;
  v ^= v >> 16u;
  v.x += v.y * v.w;
  v.y += v.z * v.x;
  v.z += v.x * v.y;
  v.w += v.y * v.z;
  return v;
}

/// Four times 32 uniform bits.
uvec4 random_bits(RandomKey key, uint dimension) {
  return pcg4d(uvec4(key.pixel, key.sample_index, dimension, key.seed));
}

/// The upper 24 bits as a multiple of 2^-24 in [0, 1): exact, and never 1.
precise float unit_interval(uint bits) { return float(bits >> 8) * 5.96046448e-08; }

#endif
