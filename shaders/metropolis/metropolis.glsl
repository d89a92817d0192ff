// What an invocation of Metropolis light transport does.

#ifndef TANDEM_METROPOLIS
#define TANDEM_METROPOLIS

#include "metropolis/primary_space.glsl"

#include "integrator/path.glsl"
#include "metropolis/splat.glsl"

// dispatch.tile_offset.y: what to do.
const uint STAGE_BOOTSTRAP = 0;  // the luminance of a path of its own
const uint STAGE_START = 1;      // a chain begins with a bootstrap path
const uint STAGE_MUTATE = 2;     // steps of a chain

/// Whether a step is large (x), whether it is accepted (y), and what decides about transparent triangles (z).
uvec4 decision_bits(uvec2 proposal) { return stream_bits(STREAM_CHAIN, proposal, 0); }

struct Proposal {
  vec3 radiance;
  float luminance;  // what the chain's stationary distribution is proportional to
  uint pixel;
};

/// Follows the path of the proposal.
Proposal evaluate(inout uint ray_count) {
  uvec2 pixel = proposed_pixel();
  // What decides about transparent triangles stays the same in small steps, and is part of the state.
  uvec2 origin = chain_is_large ? chain_proposal : chain_origin;
  uint sample_index = decision_bits(origin).z;
  Proposal proposal;
  precise vec3 radiance = path_radiance(pixel, sample_index, ray_count);
  radiance = drop_negligible(radiance);
  precise float luminance = (0.212671 * radiance.x + 0.71516 * radiance.y) + 0.072169 * radiance.z;
  if (!(luminance < 1e30)) radiance = vec3(0.0);
  proposal.radiance = radiance;
  proposal.luminance = luminance < 1e30 ? luminance : 0.0;
  proposal.pixel = pixel.y * render.resolution.x + pixel.x;
  return proposal;
}

/// The numbers of the proposal are those of the chain's state from now on.
void commit() {
  chain_time += 1;
  if (chain_is_large) {
    chain_large_time = chain_time;
    chain_origin = chain_proposal;
  }
  for (uint word = chain_base + CHAIN_HEADER; word < chain_base + metropolis.chain_words; word += SLOT_WORDS) {
    if (chains[word + SLOT_STEP] != chain_step) continue;
    for (uint i = 0; i < 4; ++i) chains[word + SLOT_CURRENT + i] = chains[word + SLOT_PROPOSED + i];
    chains[word + SLOT_TIME] = chain_time;
  }
}

Proposal loaded_chain() {
  chain_time = chains[chain_base + CHAIN_TIME];
  chain_large_time = chains[chain_base + CHAIN_LARGE_TIME];
  chain_origin = uvec2(chains[chain_base + CHAIN_ORIGIN], chains[chain_base + CHAIN_ORIGIN + 1]);
  Proposal state;
  state.radiance = vec3(uintBitsToFloat(chains[chain_base + CHAIN_RADIANCE]),
                        uintBitsToFloat(chains[chain_base + CHAIN_RADIANCE + 1]),
                        uintBitsToFloat(chains[chain_base + CHAIN_RADIANCE + 2]));
  state.luminance = uintBitsToFloat(chains[chain_base + CHAIN_LUMINANCE]);
  state.pixel = chains[chain_base + CHAIN_PIXEL];
  return state;
}

void store_chain(Proposal state) {
  chains[chain_base + CHAIN_LUMINANCE] = floatBitsToUint(state.luminance);
  chains[chain_base + CHAIN_RADIANCE] = floatBitsToUint(state.radiance.x);
  chains[chain_base + CHAIN_RADIANCE + 1] = floatBitsToUint(state.radiance.y);
  chains[chain_base + CHAIN_RADIANCE + 2] = floatBitsToUint(state.radiance.z);
  chains[chain_base + CHAIN_PIXEL] = state.pixel;
  chains[chain_base + CHAIN_TIME] = chain_time;
  chains[chain_base + CHAIN_LARGE_TIME] = chain_large_time;
  chains[chain_base + CHAIN_ORIGIN] = chain_origin.x;
  chains[chain_base + CHAIN_ORIGIN + 1] = chain_origin.y;
}

/// The radiance of a path over its luminance, or over what a large step finds it with where that is more (the balance
/// heuristic; Kelemen et al., section 3.3), in units of the scale.
precise vec3 weighted_radiance(Proposal path) {
  precise float denominator = path.luminance * metropolis.inverse_scale + metropolis.large_step;
  precise vec3 weighted = path.radiance * det_div(metropolis.inverse_scale, denominator);
  return weighted;
}

void count_large_step(uint chain, float luminance) {
  precise float sum = large_steps[chain].sum;
  precise float lost = large_steps[chain].lost;
  precise float next = sum + luminance;
  precise float larger = sum >= luminance ? sum : luminance;
  precise float smaller = sum >= luminance ? luminance : sum;
  precise float rest = (larger - next) + smaller;
  lost += rest;
  large_steps[chain].sum = next;
  large_steps[chain].lost = lost;
  large_steps[chain].count += 1;
}

/// What the next proposal is. Bootstrap paths are keyed by (index, 0), those of chains by (chain, step).
void propose(uint stage, uint index, uint step) {
  chain_step = step;
  chain_is_large = true;
  if (stage == STAGE_BOOTSTRAP) {
    chain_proposal = uvec2(index, 0);
  } else if (stage == STAGE_START) {
    chain_proposal = uvec2(starts[index], 0);
  } else {
    chain_proposal = uvec2(index, step);
    chain_is_large = unit_interval(decision_bits(chain_proposal).x) < metropolis.large_step;
  }
}

/// The compiler gets one call of the path tracer, whatever there is to do.
void metropolis_light_transport(uint invocation) {
  if (invocation >= dispatch.tile_size.x) return;
  uint stage = dispatch.tile_offset.y;
  uint index = dispatch.tile_offset.x + invocation;
  chain_remembers = stage != STAGE_BOOTSTRAP;
  chain_base = index * metropolis.chain_words;
  // The buffer of the chains is zero before they start.
  chain_time = 0;
  chain_large_time = 0;
  chain_origin = uvec2(0);
  precise Proposal state;
  state.radiance = vec3(0.0);
  state.luminance = 0.0;
  state.pixel = 0;
  if (stage == STAGE_MUTATE) state = loaded_chain();
  uint ray_count = 0;
  for (uint i = 0; i < dispatch.sample_count; ++i) {
    propose(stage, index, dispatch.first_sample + i + 1);
    Proposal proposal = evaluate(ray_count);
    bool accepted = true;
    if (stage == STAGE_MUTATE) {
      precise float acceptance =
          proposal.luminance >= state.luminance ? 1.0 : det_div(proposal.luminance, state.luminance);
      // Both the proposal and the state count, with the probability that they are the next state.
      precise vec3 proposed = weighted_radiance(proposal);
      uint group = (index & 1u) * render.resolution.x * render.resolution.y;
      precise vec3 of_proposal = proposed * acceptance;
      precise float rejection = 1.0 - acceptance;
      precise vec3 of_state = weighted_radiance(state) * rejection;
      splat(group + proposal.pixel, of_proposal);
      splat(group + state.pixel, of_state);
      if (chain_is_large) {
        splat_large(proposal.pixel, proposed);
        count_large_step(index, proposal.luminance);
      }
      accepted = unit_interval(decision_bits(chain_proposal).y) < acceptance;
    }
    if (!accepted) continue;
    state.radiance = proposal.radiance;
    state.luminance = proposal.luminance;
    state.pixel = proposal.pixel;
    if (chain_remembers) commit();
  }
  if (stage == STAGE_BOOTSTRAP) {
    bootstrap[index] = state.luminance;
  } else {
    store_chain(state);
  }
  ray_counts[index] += ray_count;
}

#endif
