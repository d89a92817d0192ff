#pragma once

#include <array>
#include <cmath>
#include <cstdint>

/// Fredholm equations of the second kind over [0, 1], u(x) = f(x) + integral of k(x, t) u(t) dt, with known solutions.
/// f and k are in shaders/study/fredholm.glsl. The equation of light transport is one of them, over more dimensions.
namespace tandem::study {

/// The kernel's form, numbered as in the shader.
enum class FredholmKernel : std::uint32_t {
  product = 0,      ///< x t
  exponential = 1,  ///< e^-|x - t| / 2
  difference = 2    ///< x - t
};

struct FredholmEquation {
  FredholmKernel kernel;
  const char* name;
  const char* formula;  ///< for people
  double norm;          ///< of the operator: the largest integral of |k(x, t)| dt, below 1
};

inline constexpr std::array<FredholmEquation, 3> fredholm_equations = {
    {{FredholmKernel::product, "product", "u(x) = e^x - x + int x t u(t) dt", 0.5},
     {FredholmKernel::exponential, "exponential", "u(x) = e^x (1/4 + x/2) + e^-x / 4 + int e^-|x-t| / 2 u(t) dt",
      0.39346934},
     {FredholmKernel::difference, "difference", "u(x) = e^x + 1 - (e - 1) x + int (x - t) u(t) dt", 0.5}}};

/// u(x) of all of them, x in [0, 1].
inline double fredholm_solution(double x) { return std::exp(x); }

}  // namespace tandem::study
