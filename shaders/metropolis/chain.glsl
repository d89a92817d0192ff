// Metropolis light transport in primary sample space (Kelemen, Szirmay-Kalos, Antal and Csonka, A Simple and Robust
// Mutation Strategy for the Metropolis Light Transport Algorithm, 2002): a chain walks over the random numbers that a
// path is made of. Here: the buffers, and where a chain is. pathtracer/render/metropolis_picture.cpp says the same.

#ifndef TANDEM_METROPOLIS_CHAIN
#define TANDEM_METROPOLIS_CHAIN

#include "random.glsl"
#include "scene.glsl"

struct MetropolisConstants {
  uint chain_words;       // size of a chain in chains[]
  uint stored_segments;   // numbers of path segments beyond are new in every proposal
  float large_step;       // probability that a proposal is a path of its own
  float inverse_scale;    // 1 / the luminance that splats are counted in
};

// Of the large steps of a chain: the luminance of their paths, summed with compensation (Neumaier 1974).
struct LargeSteps {
  float sum;
  float lost;  // by rounding
  uint count;
  uint reserved;
};

// A chain: what its state is, then its primary sample space, SLOT_WORDS for each stored dimension.
const uint CHAIN_LUMINANCE = 0;   // float, of the current path
const uint CHAIN_RADIANCE = 1;    // three floats
const uint CHAIN_PIXEL = 4;       // index
const uint CHAIN_TIME = 5;        // proposals accepted so far, the first path included
const uint CHAIN_LARGE_TIME = 6;  // CHAIN_TIME of the last large step among them
const uint CHAIN_ORIGIN = 7;      // two words: which fresh numbers that step had
const uint CHAIN_HEADER = 9;
const uint SLOT_CURRENT = 0;      // four numbers
const uint SLOT_PROPOSED = 4;     // four numbers
const uint SLOT_TIME = 8;         // CHAIN_TIME at which the current numbers are up to date; 0: never touched
const uint SLOT_STEP = 9;         // the step whose proposal the proposed numbers are
const uint SLOT_WORDS = 10;

// r, g, b of each pixel: 64 bits each, low word first.
layout(set = 1, binding = 2, std430) buffer Splats { uint splats[]; };  // of states and proposals of even chains, then of odd ones
layout(set = 1, binding = 7, std430) buffer LargeSplats { uint large_splats[]; };  // of large steps, as paths of their own
layout(set = 1, binding = 8, std430) buffer LargeStepSums { LargeSteps large_steps[]; };  // of each chain
layout(set = 1, binding = 3, std430) buffer Chains { uint chains[]; };
layout(set = 1, binding = 4, std430) buffer Bootstrap { float bootstrap[]; };    // luminance of each bootstrap path
layout(set = 1, binding = 5, std430) readonly buffer Starts { uint starts[]; };  // bootstrap path that a chain begins with
layout(set = 1, binding = 6, std430) readonly buffer Metropolis { MetropolisConstants metropolis; };

// Streams of random numbers of one seed: none is used for two purposes.
const uint STREAM_FRESH = 0x6c078965u;  // a path of its own
const uint STREAM_SMALL = 0x9e3779b9u;  // small mutations
const uint STREAM_DRIFT = 0x85ebca6bu;  // small mutations caught up on
const uint STREAM_CHAIN = 0xc2b2ae35u;  // decisions of a chain

uvec4 stream_bits(uint stream, uvec2 origin, uint dimension) {
  return pcg4d(uvec4(origin, dimension, render.seed ^ stream));
}

// Where the invocation's chain is. A bootstrap path is a proposal of no chain: it has no memory.
bool chain_remembers;
bool chain_is_large;       // whether the proposal is a path of its own
uint chain_base;           // first word in chains[]
uint chain_step;           // the number of the proposal, from 1 on
uvec2 chain_proposal;      // what its random numbers are keyed by
uint chain_time;
uint chain_large_time;
uvec2 chain_origin;

#endif
