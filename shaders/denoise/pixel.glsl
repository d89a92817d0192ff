// What the denoiser knows of a pixel, and its constants: the contract with pathtracer/denoise/denoiser.cpp.

#ifndef TANDEM_DENOISE_PIXEL
#define TANDEM_DENOISE_PIXEL

#include "math.glsl"

struct DenoisePixel {
  vec3 radiance;   // mean of the samples
  float depth;     // mean distance of the first hits
  vec3 variance;   // of that mean, by channel; below 0 where it is unknown
  float coverage;  // fraction of the samples that hit anything
  vec3 albedo;     // mean of the first hits, 0 for samples that hit nothing
  float reserved_0;
  vec3 normal;  // mean of the first hits
  float reserved_1;
};

// How alike pixels must be is in units of these.
struct DenoiseConstants {
  uvec2 resolution;
  uint step;              // pixels between two taps
  float sigma_luminance;  // standard errors of the pixel's luminance
  float sigma_depth;      // times what the slope of the surface explains
  float sigma_albedo;
  float firefly_deviations;  // of the neighbourhood, above which a pixel is pulled down; 0: none is
  uint reserved;
};

layout(push_constant) uniform DenoiseBlock { DenoiseConstants denoise; };

/// Where nothing is trusted beyond: squares are still floats.
const float LARGEST_RADIANCE = 1e15;

precise float denoise_luminance(vec3 color) { return (0.2126 * color.x + 0.7152 * color.y) + 0.0722 * color.z; }

/// Radiance is divided by this before it is filtered and multiplied with it afterwards, so that textures are not
/// filtered. What lies behind everything counts as white; the floor keeps noise on black surfaces small.
precise vec3 demodulator(DenoisePixel pixel) {
  vec3 white = vec3(1.0 - pixel.coverage);
  return max(pixel.albedo + white, vec3(0.02));
}

/// Whether the pixel holds numbers that a filter may use: no NaN, no infinity.
bool denoise_is_finite(DenoisePixel pixel) {
  vec3 size = abs(pixel.radiance);
  return size.x <= LARGEST_RADIANCE && size.y <= LARGEST_RADIANCE && size.z <= LARGEST_RADIANCE;
}

#endif
