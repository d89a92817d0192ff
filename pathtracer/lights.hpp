#pragma once

#include <vector>

#include "pathtracer/scene.hpp"

namespace tandem::pathtracer {

/// Relative luminance of linear RGB with the primaries of sRGB (ITU-R BT.709).
double luminance(glm::vec3 rgb);

/// The alias table (Vose 1991) over the triangles that emit, each with a probability proportional to its area times the
/// luminance of its emission. Degenerate triangles are left out. `area_density` is that of the probability which the
/// 32-bit thresholds really give. Empty when nothing emits.
std::vector<GpuLight> build_lights(const Scene& scene);

/// The probability of each entry of the table, summed over the ways to choose it.
std::vector<double> light_probabilities(const std::vector<GpuLight>& lights);

}  // namespace tandem::pathtracer
