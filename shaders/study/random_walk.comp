// Solves a Fredholm equation of the second kind at points of [0, 1] by random walks (Spanier and Gelbard, Monte Carlo
// Principles and Neutron Transport Problems, 1969, chapter 2). Each invocation adds up the scores of a block of walks
// from one point.
#version 460
#extension GL_GOOGLE_include_directive : require

layout(local_size_x = 64) in;

#include "random.glsl"
#include "study/fredholm.glsl"

const uint ESTIMATOR_FIXED_LENGTH = 0;
const uint ESTIMATOR_ABSORPTION = 1;
const uint ESTIMATOR_COLLISION = 2;
const uint ESTIMATOR_EXPECTED_VALUE = 3;

layout(set = 0, binding = 0, std430) writeonly buffer Sums { vec2 sums[]; };  // of the scores of a block, and of their squares

layout(push_constant, std430) uniform WalkConstants {
  uint equation;     // FREDHOLM_*
  uint estimator;    // ESTIMATOR_*
  uint point_count;  // invocation i is block i / point_count of point i % point_count
  uint block_count;
  uint block_size;  // walks
  uint first_walk;  // of block 0
  uint length_limit;  // steps of a walk that is not absorbed before
  float absorption;   // probability that a walk ends at a state; 0: never
  uint seed;
} walks;

/// The score of one walk from x. It moves to a uniformly distributed state, so the density of a transition is 1 -
/// absorption, and the weight gains k(x, y) over that.
precise float score(float x, RandomKey key) {
  precise float weight = 1.0;
  precise float total = walks.estimator == ESTIMATOR_EXPECTED_VALUE ? fredholm_source(walks.equation, x) : 0.0;
  precise float survival = 1.0 - walks.absorption;
  for (uint step = 0; step <= walks.length_limit; ++step) {
    uvec4 bits = random_bits(key, step);
    bool ends = unit_interval(bits.x) < walks.absorption;
    if (walks.estimator == ESTIMATOR_EXPECTED_VALUE) {
      total += weight * fredholm_scattered_source(walks.equation, x);
    } else if (walks.estimator != ESTIMATOR_ABSORPTION) {
      total += weight * fredholm_source(walks.equation, x);
    } else if (ends) {
      total = det_div(weight * fredholm_source(walks.equation, x), walks.absorption);
    }
    if (ends) break;
    precise float next = unit_interval(bits.y);
    weight *= det_div(fredholm_kernel(walks.equation, x, next), survival);
    if (!(abs(weight) > NEGLIGIBLE)) break;
    x = next;
  }
  return total;
}

void main() {
  uint index = gl_GlobalInvocationID.x;
  if (index >= walks.point_count * walks.block_count) return;
  uint point = index % walks.point_count;
  uint block = index / walks.point_count;
  precise float x = det_div(float(point) + 0.5, float(walks.point_count));
  RandomKey key;
  key.pixel = point + (walks.equation << 16) + (walks.estimator << 24);
  key.seed = walks.seed;
  precise vec2 sum = vec2(0.0);
  for (uint i = 0; i < walks.block_size; ++i) {
    key.sample_index = walks.first_walk + block * walks.block_size + i;
    precise float one = score(x, key);
    sum += vec2(one, one * one);
  }
  sums[index] = sum;
}
