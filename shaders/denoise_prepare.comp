// The first pass of the denoiser: divides reflected radiance by albedo, pulls fireflies down and makes the guides.
#version 460
#extension GL_GOOGLE_include_directive : require

layout(local_size_x = 8, local_size_y = 8) in;

#include "denoise/firefly.glsl"
#include "denoise/guide.glsl"

layout(set = 0, binding = 0, std430) readonly buffer Pixels { DenoisePixel pixels[]; };
layout(set = 0, binding = 1, std430) writeonly buffer Guides { DenoiseGuide guides[]; };
// Radiance over albedo, and the variance of its luminance: below 0 for a pixel that tells nothing.
layout(set = 0, binding = 2, std430) writeonly buffer Signal { vec4 signal[]; };

const int FIREFLY_RADIUS = 3;

precise vec3 demodulated(DenoisePixel pixel) {
  vec3 white = demodulator(pixel.sampled_albedo);
  return vec3(det_div(pixel.radiance.x, white.x), det_div(pixel.radiance.y, white.y),
              det_div(pixel.radiance.z, white.z));
}

/// Of the luminance of the demodulated radiance, as if its channels were noisy together, which they mostly are.
precise float demodulated_variance(DenoisePixel pixel) {
  vec3 white = demodulator(pixel.sampled_albedo);
  vec3 variance = max(pixel.variance, vec3(0.0));
  vec3 error = vec3(det_div(det_sqrt(variance.x), white.x), det_div(det_sqrt(variance.y), white.y),
                    det_div(det_sqrt(variance.z), white.z));
  float luminance = denoise_luminance(error);
  float squared = luminance * luminance;
  // Comparisons are false for a NaN.
  return squared <= 1e30 ? squared : 1e30;
}

uint index_of(ivec2 position) { return uint(position.y) * denoise.resolution.x + uint(position.x); }

bool is_inside(ivec2 position) {
  return position.x >= 0 && position.y >= 0 && position.x < int(denoise.resolution.x) &&
         position.y < int(denoise.resolution.y);
}

/// Change of depth along an axis: the smaller of the two sides, since the other may be beyond an edge.
precise float slope_along(ivec2 position, ivec2 axis, float depth) {
  float smallest = LARGEST_FLOAT;
  for (int side = -1; side <= 1; side += 2) {
    ivec2 other = position + axis * side;
    if (!is_inside(other)) continue;
    uint index = index_of(other);
    if (!(pixels[index].coverage > 0.0)) continue;
    precise float change = (pixels[index].depth - depth) * float(side);
    if (abs(change) < abs(smallest)) smallest = change;
  }
  return smallest == LARGEST_FLOAT ? 0.0 : smallest;
}

void main() {
  uvec2 invocation = gl_GlobalInvocationID.xy;
  if (any(greaterThanEqual(invocation, denoise.resolution))) return;
  ivec2 position = ivec2(invocation);
  uint index = index_of(position);
  DenoisePixel pixel = pixels[index];

  precise DenoiseGuide guide;
  guide.normal = det_normalize(pixel.normal, vec3(0.0));
  guide.depth = pixel.depth;
  guide.albedo = pixel.albedo;
  guide.coverage = pixel.coverage;
  guide.slope = vec2(0.0);
  if (pixel.coverage > 0.0) {
    guide.slope.x = slope_along(position, ivec2(1, 0), pixel.depth);
    guide.slope.y = slope_along(position, ivec2(0, 1), pixel.depth);
  }
  guide.reserved_0 = 0.0;
  guide.reserved_1 = 0.0;
  guides[index] = guide;

  if (!denoise_is_known(pixel)) {
    signal[index] = vec4(0.0, 0.0, 0.0, -1.0);
    return;
  }
  precise float sum = 0.0;
  precise float squares = 0.0;
  precise float count = 0.0;
  bool is_unknown = pixel.variance.x < 0.0;
  if (is_unknown || denoise.firefly_deviations > 0.0) {
    for (int y = -FIREFLY_RADIUS; y <= FIREFLY_RADIUS; ++y) {
      for (int x = -FIREFLY_RADIUS; x <= FIREFLY_RADIUS; ++x) {
        ivec2 other = position + ivec2(x, y);
        if ((x == 0 && y == 0) || !is_inside(other)) continue;
        DenoisePixel neighbour = pixels[index_of(other)];
        if (!denoise_is_known(neighbour)) continue;
        precise float luminance = denoise_luminance(demodulated(neighbour));
        sum += luminance;
        squares += luminance * luminance;
        count += 1.0;
      }
    }
  }
  vec3 color = demodulated(pixel);
  precise float variance = demodulated_variance(pixel);
  if (is_unknown && count > 0.0) {
    // The neighbourhood tells how noisy one pixel is.
    precise float mean = det_div(sum, count);
    precise float spread = det_div(squares, count) - mean * mean;
    variance = spread > 0.0 ? spread : 0.0;
  }
  precise float luminance = denoise_luminance(color);
  precise float kept = without_firefly(luminance, variance, sum, squares, count);
  precise float factor = kept < luminance && luminance > 0.0 ? det_div(kept > 0.0 ? kept : 0.0, luminance) : 1.0;
  precise vec3 result = color * factor;
  precise float left = variance * factor * factor;
  signal[index] = vec4(result, left);
}
