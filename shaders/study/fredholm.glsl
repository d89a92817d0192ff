// Fredholm equations of the second kind over [0, 1] whose solutions are known,
//   u(x) = f(x) + integral of k(x, t) u(t) dt,
// with the norm of the integral operator K at most 1/2, so that the Neumann series of K converges.
// compare/study/fredholm_equation.hpp says the same on the host, and what the solutions are.

#ifndef TANDEM_STUDY_FREDHOLM
#define TANDEM_STUDY_FREDHOLM

#include "math.glsl"

const uint FREDHOLM_PRODUCT = 0;      // k = x t, u = e^x
const uint FREDHOLM_EXPONENTIAL = 1;  // k = e^-|x - t| / 2, as of isotropic scattering in a slab; u = e^x
const uint FREDHOLM_DIFFERENCE = 2;   // k = x - t, which changes its sign; u = e^x

const float EULER = 2.71828175;

precise float fredholm_kernel(uint equation, float x, float t) {
  if (equation == FREDHOLM_PRODUCT) return x * t;
  if (equation == FREDHOLM_DIFFERENCE) return x - t;
  return 0.5 * det_exp(-abs(x - t));
}

/// f(x).
precise float fredholm_source(uint equation, float x) {
  float power = det_exp(x);
  if (equation == FREDHOLM_PRODUCT) return power - x;
  if (equation == FREDHOLM_DIFFERENCE) return power - (x * (EULER - 1.0) - 1.0);
  return power * (0.25 + 0.5 * x) + 0.25 * det_exp(-x);
}

/// The integral of k(x, t) f(t) dt: what the next step of a walk at x is expected to find.
precise float fredholm_scattered_source(uint equation, float x) {
  if (equation == FREDHOLM_PRODUCT) return x * 0.666666687;
  if (equation == FREDHOLM_DIFFERENCE) return x * (0.5 * (EULER + 1.0)) - (1.5 - (EULER - 1.0) * 0.333333343);
  float power = det_exp(x);
  float inverse = det_exp(-x);
  float below = 0.25 * x * (power + inverse);  // of t < x
  float above = 0.25 * power * ((1.0 - x) + (1.0 - x * x)) + 0.125 * (inverse - power * 0.135335281);
  return 0.5 * (below + above);
}

#endif
