// How alike two pixels are by what they show first: the edge-stopping functions of Schied et al. 2017 (Spatiotemporal
// Variance-Guided Filtering, section 4.4) with one for albedo, as Dammertz et al. 2010 have.

#ifndef TANDEM_DENOISE_GUIDE
#define TANDEM_DENOISE_GUIDE

#include "denoise/pixel.glsl"

struct DenoiseGuide {
  vec3 normal;  // of length 1, or 0 where there is none
  float depth;
  vec3 albedo;
  float coverage;
  vec2 slope;  // of depth, by pixel in x and in y
  float reserved_0;
  float reserved_1;
};

/// The exponent of a weight exp(-exponent), but for normals.
precise float guide_distance(DenoiseGuide a, DenoiseGuide b, vec2 offset) {
  vec3 difference = a.albedo - b.albedo;
  float albedo = det_div(det_length(difference), denoise.sigma_albedo);
  float covered = 8.0 * abs(a.coverage - b.coverage);
  float explained = abs(a.slope.x * offset.x + a.slope.y * offset.y);
  // A thousandth of the distance is no edge: slopes are differences of noisy numbers.
  float depth = det_div(abs(a.depth - b.depth), denoise.sigma_depth * explained + 1e-3 * a.depth + 1e-20);
  return (albedo + covered) + depth;
}

/// The cosine between the normals to the power of 64; 1 between two pixels without any.
precise float normal_weight(DenoiseGuide a, DenoiseGuide b) {
  float cosine = det_dot(a.normal, b.normal);
  if (a.coverage == 0.0 && b.coverage == 0.0) cosine = 1.0;
  if (!(cosine > 0.3)) return 0.0;
  for (int i = 0; i < 6; ++i) cosine = cosine * cosine;
  return cosine;
}

#endif
