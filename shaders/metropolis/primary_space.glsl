// Where the random numbers of a path come from in Metropolis light transport: from the proposal of the chain. Stands in
// for sampling/sampler.glsl, whose guard it takes, so that the path tracer is the same code.

#ifndef TANDEM_SAMPLING_SAMPLER
#define TANDEM_SAMPLING_SAMPLER

#include "math.glsl"
#include "metropolis/chain.glsl"

const uint NO_SLOT = 0xffffffffu;

// Sizes of a small mutation: between a = 2^-14 and b = 2^-6, evenly distributed by logarithm (Kelemen et al., section 3.2,
// whose a is 2^-10: more of what lies behind a gap is lost then). Its standard deviation is ((b^2 - a^2) / (2 ln(b /
// a)))^1/2.
const float LARGEST_MUTATION = 0.015625;
const float LOG_MUTATION_RANGE = 5.54517744;
const float MUTATION_DEVIATION = 0.00469187;

/// Where the chain stores the four numbers of the dimension.
uint slot_of(uint dimension) {
  uint segments = metropolis.stored_segments;
  if (dimension <= 2 * segments) return dimension;
  if (dimension == DIMENSION_TIME) return 2 * segments + 1;
  uint segment = dimension - medium_dimension(0);
  if (FEATURE_MEDIA && segment < segments) return 2 * segments + 2 + segment;
  return NO_SLOT;
}

/// A number of the torus [0, 1) in units of 2^-32, moved by a small mutation.
uint mutated(uint value, uint bits) {
  precise float exponent = -LOG_MUTATION_RANGE * unit_interval(bits);
  precise float size = LARGEST_MUTATION * det_exp(exponent);
  precise float units = size * 4294967296.0;
  uint distance = uint(units);
  return (bits & 1u) != 0 ? value + distance : value - distance;
}

uvec4 mutated(uvec4 value, uvec4 bits) {
  return uvec4(mutated(value.x, bits.x), mutated(value.y, bits.y), mutated(value.z, bits.z), mutated(value.w, bits.w));
}

/// The same by about as much as `count` small mutations move it.
uint drifted(uint value, uint bits, uint count) {
  // The sum of four uniform numbers is nearly normal, with a variance of 1 / 3.
  precise float sum = float((bits & 0xffu) + (bits >> 8 & 0xffu) + (bits >> 16 & 0xffu) + (bits >> 24)) * 0.00390625;
  precise float distance = (sum - 1.9921875) * 1.73205078 * MUTATION_DEVIATION * det_sqrt(float(count));
  precise float part = distance - floor(distance);
  precise float units = part * 16777216.0;
  return value + (uint(units) << 8);
}

uvec4 chain_numbers(uint word) { return uvec4(chains[word], chains[word + 1], chains[word + 2], chains[word + 3]); }

void store_chain_numbers(uint word, uvec4 numbers) {
  chains[word] = numbers.x;
  chains[word + 1] = numbers.y;
  chains[word + 2] = numbers.z;
  chains[word + 3] = numbers.w;
}

/// The numbers of the chain's current state. They are mutated when they are read only (lazily): a path may have had no
/// use for them for a while. The first mutation missed has to be one of those of proposals, for the chain to be in
/// balance; any further ones may have every distribution that leaves uniform numbers uniform, because the states since
/// did not depend on them.
uvec4 current_bits(uint word, uint dimension) {
  uvec4 value = chain_numbers(word + SLOT_CURRENT);
  uint time = chains[word + SLOT_TIME];
  if (time == chain_time) return value;
  if (time < chain_large_time) {
    value = stream_bits(STREAM_FRESH, chain_origin, dimension);
    time = chain_large_time;
  }
  uint missed = chain_time - time;
  if (missed != 0) {
    uvec4 bits = stream_bits(STREAM_DRIFT, chain_proposal, dimension);
    value = mutated(value, bits);
    if (missed != 1) {
      bits = pcg4d(bits);
      value = uvec4(drifted(value.x, bits.x, missed - 1), drifted(value.y, bits.y, missed - 1),
                    drifted(value.z, bits.z, missed - 1), drifted(value.w, bits.w, missed - 1));
    }
  }
  store_chain_numbers(word + SLOT_CURRENT, value);
  chains[word + SLOT_TIME] = chain_time;
  return value;
}

/// The numbers of the proposal.
uvec4 proposed_bits(uint dimension) {
  uint slot = chain_remembers ? slot_of(dimension) : NO_SLOT;
  if (slot == NO_SLOT) return stream_bits(STREAM_FRESH, chain_proposal, dimension);
  uint word = chain_base + CHAIN_HEADER + SLOT_WORDS * slot;
  if (chains[word + SLOT_STEP] == chain_step)
    return chain_numbers(word + SLOT_PROPOSED);
  uvec4 value;
  if (chain_is_large) {
    value = stream_bits(STREAM_FRESH, chain_proposal, dimension);
  } else {
    uvec4 bits = stream_bits(STREAM_SMALL, chain_proposal, dimension);
    value = current_bits(word, dimension);
    value = mutated(value, bits);
  }
  store_chain_numbers(word + SLOT_PROPOSED, value);
  chains[word + SLOT_STEP] = chain_step;
  return value;
}

/// The whole part of x * size / 2^32, for sizes up to 2^16: in integers, so that every device has the same pixel.
uint scaled(uint x, uint size) { return ((x >> 16) * size + ((x & 0xffffu) * size >> 16)) >> 16; }

/// The pixel of the proposal.
uvec2 proposed_pixel() {
  uvec4 bits = proposed_bits(DIMENSION_CAMERA);
  return uvec2(scaled(bits.x, render.resolution.x), scaled(bits.y, render.resolution.y));
}

/// As that of sampling/sampler.glsl. What lies within the pixel is what is left of the numbers that chose it.
uvec4 sampler_bits(RandomKey key, uint dimension) {
  uvec4 bits = proposed_bits(dimension);
  if (dimension == DIMENSION_CAMERA) bits.xy *= render.resolution;
  return bits;
}

#endif
