// Russian roulette: paths that carry little end at random, and those that survive count more for it.

#ifndef TANDEM_INTEGRATOR_ROULETTE
#define TANDEM_INTEGRATOR_ROULETTE

#include "integrator/events.glsl"
#include "integrator/options.glsl"
#include "math.glsl"
#include "random.glsl"

// Roulette begins at the vertex that this many segments lie before, and always leaves at least one path in twenty to
// die.
const uint ROULETTE_DEPTH = 3;
const float ROULETTE_SURVIVAL = 0.95;

/// Whether a path survives at a vertex; its throughput has then grown. @param eta_scale of PathState
bool survives_roulette(inout precise vec3 throughput, float eta_scale, uint depth, uint bits) {
  if (depth < ROULETTE_DEPTH || !option_roulette()) return true;
  precise float survival = max_component(throughput) * eta_scale;
  survival = survival < ROULETTE_SURVIVAL ? survival : ROULETTE_SURVIVAL;
  bool survives = unit_interval(bits) < survival;
  record_roulette(bits, survival, survives);
  if (survives) throughput *= det_div(1.0, survival);
  return survives;
}

#endif
