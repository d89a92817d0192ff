// Gradient noise (Perlin, Improving Noise, SIGGRAPH 2002) with an integer hash in place of a table, and turbulence.

#ifndef TANDEM_TEXTURE_NOISE
#define TANDEM_TEXTURE_NOISE

#include "math.glsl"
#include "random.glsl"

const float NOISE_PERIOD = 65536.0;  // of the lattice, along each axis
const uint TURBULENCE_OCTAVES = 7;

/// The lattice point modulo its period.
precise uint noise_lattice(float whole) {
  float turns = whole * (1.0 / NOISE_PERIOD);
  return uint(NOISE_PERIOD * clamp_unit(turns - floor(turns))) & 0xffffu;
}

/// One of the twelve directions from the centre of a cube to its edges, each with equal probability.
vec3 noise_gradient(uvec3 lattice) {
  uint bits = pcg4d(uvec4(lattice, 0)).x;
  // From the upper bits: the lower ones of this hash are less random.
  float first = (bits & 0x80000000u) != 0 ? 1.0 : -1.0;
  float second = (bits & 0x40000000u) != 0 ? 1.0 : -1.0;
  uint axis = (((bits >> 14) & 0xffffu) * 3) >> 16;
  if (axis == 0) return vec3(0.0, first, second);
  return axis == 1 ? vec3(first, 0.0, second) : vec3(first, second, 0.0);
}

/// 6 t^5 - 15 t^4 + 10 t^3: from 0 to 1, with first and second derivatives of 0 at both.
precise float noise_fade(float t) { return t * t * t * (t * (t * 6.0 - 15.0) + 10.0); }

/// Smooth noise in [-1.04, 1.04] with mean 0 that is 0 at the points of the integer lattice.
precise float gradient_noise(vec3 point) {
  vec3 whole = floor(point);
  vec3 inside = point - whole;
  vec3 fade = vec3(noise_fade(inside.x), noise_fade(inside.y), noise_fade(inside.z));
  uvec3 lattice = uvec3(noise_lattice(whole.x), noise_lattice(whole.y), noise_lattice(whole.z));
  float sum = 0.0;
  for (uint corner = 0; corner < 8; ++corner) {
    uvec3 step = uvec3(corner & 1u, (corner >> 1) & 1u, corner >> 2);
    vec3 offset = inside - vec3(step);
    float weight = ((step.x == 0 ? 1.0 - fade.x : fade.x) * (step.y == 0 ? 1.0 - fade.y : fade.y)) *
                   (step.z == 0 ? 1.0 - fade.z : fade.z);
    sum += weight * det_dot(noise_gradient((lattice + step) & 0xffffu), offset);
  }
  return sum;
}

/// Sum of the magnitudes of seven octaves of noise, each with twice the frequency and half the amplitude of the one
/// before; in [0, 1].
precise float turbulence(vec3 point) {
  float sum = 0.0;
  float amplitude = 1.0;
  vec3 scaled = point;
  for (uint octave = 0; octave < TURBULENCE_OCTAVES; ++octave) {
    sum += amplitude * abs(gradient_noise(scaled));
    amplitude *= 0.5;
    scaled *= 2.0;
  }
  // What is less may be made of numbers that a device flushes to zero.
  return sum < 1e-12 ? 0.0 : clamp_unit(sum);
}

#endif
