// Pixels that outshine their neighbourhood because of a few samples.

#ifndef TANDEM_DENOISE_FIREFLY
#define TANDEM_DENOISE_FIREFLY

#include "denoise/pixel.glsl"

/// The luminance that a pixel keeps. It is pulled down to the mean of its neighbourhood plus a number of the
/// neighbourhood's standard deviations, but by no more than its own standard error: one sample that outshines all
/// others makes the error as large as the mean, whereas a highlight or a lamp that every sample sees has a small one,
/// and stays.
/// @param sum, sum_of_squares, count of the luminance of neighbours, without the pixel itself
precise float without_firefly(float luminance, float variance, float sum, float sum_of_squares, float count) {
  if (!(denoise.firefly_deviations > 0.0) || !(count >= 4.0)) return luminance;
  float mean = det_div(sum, count);
  float spread = det_div(sum_of_squares, count) - mean * mean;
  precise float bound = mean + denoise.firefly_deviations * det_sqrt(spread > 0.0 ? spread : 0.0);
  precise float lowest = luminance - det_sqrt(variance);
  float kept = bound > lowest ? bound : lowest;
  return luminance > kept ? kept : luminance;
}

#endif
