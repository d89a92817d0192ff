// What the denoiser knows of a pixel, and its constants: the contract with pathtracer/denoise/denoiser.cpp.

#ifndef TANDEM_DENOISE_PIXEL
#define TANDEM_DENOISE_PIXEL

#include "math.glsl"

struct DenoisePixel {
  vec3 radiance;   // mean of the samples, less what their first hits emit
  float depth;     // mean distance of the first hits
  vec3 variance;   // of that mean, by channel; below 0 where it is unknown
  float coverage;  // fraction of the samples that hit anything
  vec3 sampled_albedo;  // mean of the first hits of these samples, 0 for those that hit nothing
  float reserved_0;
  vec3 albedo;  // the same of more first hits, and so all below
  float reserved_1;
  vec3 emission;
  float reserved_2;
  vec3 normal;
  float reserved_3;
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

/// Reflected radiance is divided by this before it is filtered, so that neither textures nor the share of a pixel that
/// an edge leaves are filtered. The floor keeps noise on black surfaces small.
vec3 demodulator(vec3 albedo) { return max(albedo, vec3(0.01)); }

/// Whether the pixel tells how bright its surface is: it holds no NaN and no infinity, and a sample at least has met what
/// more first hits say is there.
bool denoise_is_known(DenoisePixel pixel) {
  vec3 size = abs(pixel.radiance);
  bool is_finite = size.x <= LARGEST_RADIANCE && size.y <= LARGEST_RADIANCE && size.z <= LARGEST_RADIANCE;
  return is_finite && !(max_component(pixel.sampled_albedo) < 0.01 && max_component(pixel.albedo) > 0.02);
}

#endif
