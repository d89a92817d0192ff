// Correlated multi-jittered samples (Kensler, Correlated Multi-Jittered Sampling, Pixar Technical Memo 13-01, 2013):
// the samples of a pixel hit each of `total` strata of every number once, and each cell of a grid over every pair once.

#ifndef TANDEM_SAMPLING_STRATIFIED
#define TANDEM_SAMPLING_STRATIFIED

#include "math.glsl"
#include "random.glsl"
#include "sampling/permutation.glsl"

/// Columns of the grid with `total` cells: the divisor that is closest to the root from below, or if it is less than
/// half of it the root itself; then some cells of the grid stay empty.
uint stratified_columns(uint total) {
  precise float shifted_root = det_sqrt(float(total) + 0.5);  // so that rounding cannot take a square's root down
  uint root = uint(shifted_root);
  for (uint columns = root; 2u * columns > root; --columns)
    if (total % columns == 0u) return columns;
  return root;
}

/// Each of the four numbers, and each of the pairs (x, y) and (z, w), is stratified over the samples 0 ... total - 1, and
/// anew over every further `total`. Of more than 65025 those are blocks of so many.
uvec4 stratified_bits(RandomKey key, uint dimension, uint total) {
  uint count = min(total, 65025u);
  uint repetition = key.sample_index / count;
  uint columns = stratified_columns(count);
  uint rows = (count + columns - 1u) / columns;
  uvec4 jitter = random_bits(key, dimension);
  uvec4 bits = uvec4(0u);
  for (uint pair = 0u; pair < 2u; ++pair) {
    uvec4 keys = pcg4d(uvec4(key.pixel, ~(2u * repetition + pair), dimension, key.seed));
    uint cell = permuted_index(key.sample_index % count, columns * rows, keys.x);
    uint column = cell % columns;
    uint row = cell / columns;
    uint x = stratum_bits(column * rows + permuted_index(row, rows, keys.y), columns * rows, jitter.x);
    uint y = stratum_bits(row * columns + permuted_index(column, columns, keys.z), columns * rows, jitter.y);
    bits = uvec4(bits.z, bits.w, x, y);
    jitter = jitter.zwxy;
  }
  return bits;
}

#endif
