// One level of the edge-avoiding a-trous wavelet transform: Dammertz, Sewtz, Hanika and Lensch, Edge-Avoiding A-Trous
// Wavelet Transform for fast Global Illumination Filtering, 2010; weighed by variance as Schied et al. 2017.
#version 460
#extension GL_GOOGLE_include_directive : require

layout(local_size_x = 8, local_size_y = 8) in;

#include "denoise/guide.glsl"

layout(set = 0, binding = 0, std430) readonly buffer Guides { DenoiseGuide guides[]; };
layout(set = 0, binding = 1, std430) readonly buffer Signal { vec4 signal[]; };
layout(set = 0, binding = 2, std430) writeonly buffer Filtered { vec4 filtered[]; };

uint index_of(ivec2 position) { return uint(position.y) * denoise.resolution.x + uint(position.x); }

bool is_inside(ivec2 position) {
  return position.x >= 0 && position.y >= 0 && position.x < int(denoise.resolution.x) &&
         position.y < int(denoise.resolution.y);
}

/// Of the cubic B-spline: 3/8, 1/4, 1/16.
float kernel_weight(int offset) { return offset == 0 ? 0.375 : (offset == 1 || offset == -1 ? 0.25 : 0.0625); }

/// The variance around a pixel by a 3x3 Gaussian: that of a single pixel is too noisy itself.
precise float smooth_variance(ivec2 position) {
  float sum = 0.0;
  float weights = 0.0;
  for (int y = -1; y <= 1; ++y) {
    for (int x = -1; x <= 1; ++x) {
      ivec2 other = position + ivec2(x, y);
      if (!is_inside(other)) continue;
      float variance = signal[index_of(other)].w;
      if (!(variance >= 0.0)) continue;
      float weight = (x == 0 ? 0.5 : 0.25) * (y == 0 ? 0.5 : 0.25);
      sum += weight * variance;
      weights += weight;
    }
  }
  return weights > 0.0 ? det_div(sum, weights) : 0.0;
}

void main() {
  uvec2 invocation = gl_GlobalInvocationID.xy;
  if (any(greaterThanEqual(invocation, denoise.resolution))) return;
  ivec2 position = ivec2(invocation);
  uint index = index_of(position);
  DenoiseGuide guide = guides[index];
  vec4 center = signal[index];
  bool is_known = center.w >= 0.0;
  precise float luminance = denoise_luminance(center.xyz);
  precise float error = det_sqrt(smooth_variance(position));
  precise float scale = (denoise.sigma_luminance * error + 1e-4 * abs(luminance)) + 1e-15;

  // Differences from the pixel are summed, so that equal pixels stay as they are to the last bit.
  precise float weights = is_known ? 0.140625 : 0.0;
  precise vec3 sum = vec3(0.0);
  precise float variance = is_known ? center.w * 0.140625 * 0.140625 : 0.0;
  for (int y = -2; y <= 2; ++y) {
    for (int x = -2; x <= 2; ++x) {
      ivec2 other = position + ivec2(x, y) * int(denoise.step);
      if ((x == 0 && y == 0) || !is_inside(other)) continue;
      uint at = index_of(other);
      vec4 neighbour = signal[at];
      if (!(neighbour.w >= 0.0)) continue;
      DenoiseGuide other_guide = guides[at];
      precise float weight = kernel_weight(x) * kernel_weight(y) * normal_weight(guide, other_guide);
      if (!(weight > 0.0)) continue;
      precise vec2 offset = vec2(float(x), float(y)) * float(denoise.step);
      precise float distance = guide_distance(guide, other_guide, offset);
      if (is_known) distance += det_div(abs(denoise_luminance(neighbour.xyz) - luminance), scale);
      weight *= det_exp(-distance);
      if (!(weight > 1e-12)) continue;
      weights += weight;
      sum += (neighbour.xyz - center.xyz) * weight;
      variance += neighbour.w * weight * weight;
    }
  }
  if (!(weights > 0.0)) {
    filtered[index] = center;
    return;
  }
  precise float inverse = det_div(1.0, weights);
  precise vec3 color = center.xyz + sum * inverse;
  precise float left = variance * inverse * inverse;
  filtered[index] = vec4(color, left);
}
