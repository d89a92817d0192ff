// Which options of the integrator are in force. Without FEATURE_OPTIONS they are the defaults, and facts to a compiler.

#ifndef TANDEM_INTEGRATOR_OPTIONS
#define TANDEM_INTEGRATOR_OPTIONS

#include "bsdf/bsdf_sample.glsl"
#include "math.glsl"
#include "scene.glsl"

uint option_integrator() { return FEATURE_OPTIONS ? render.integrator : INTEGRATOR_PATH; }
uint option_mis() { return FEATURE_OPTIONS ? render.mis : MIS_POWER; }
uint option_bsdf_sampling() { return FEATURE_OPTIONS ? render.bsdf_sampling : BSDF_SAMPLING_BSDF; }
bool option_roulette() { return !FEATURE_OPTIONS || render.roulette != 0; }

/// Whether there is light that next event estimation looks for.
bool samples_lights() { return (!FEATURE_OPTIONS || render.light_sampling != 0) && render.light_count != 0; }

/// How often a path has scattered by lobes of each kind.
struct ScatteringCount {
  uint diffuse;
  uint glossy;
  uint specular;
};

void count_scattering(inout ScatteringCount count, uint lobe) {
  if ((lobe & LOBE_SPECULAR) != 0) {
    count.specular += 1;
  } else if ((lobe & LOBE_GLOSSY) != 0) {
    count.glossy += 1;
  } else {
    count.diffuse += 1;
  }
}

/// Whether the path has scattered more often than the settings allow: from here on it may only meet a light.
bool exceeds_depths(ScatteringCount count) {
  if (!FEATURE_OPTIONS) return false;
  bool direct = render.integrator == INTEGRATOR_DIRECT;
  return count.diffuse > (direct ? 0u : render.max_diffuse_depth) ||
         count.glossy > (direct ? 0u : render.max_glossy_depth) || count.specular > render.max_specular_depth;
}

/// What a path adds to its sample. `segments`: how many of them the light came along; up to two of them, it is direct.
precise vec3 clamped(vec3 contribution, uint segments) {
  if (!FEATURE_OPTIONS) return contribution;
  float bound = segments <= 2 ? render.clamp_direct : render.clamp_indirect;
  precise float largest = max_component(contribution);
  if (!(bound > 0.0 && largest > bound)) return contribution;
  return contribution * det_div(bound, largest);
}

#endif
