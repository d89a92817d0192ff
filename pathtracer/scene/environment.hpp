#pragma once

#include <vector>

#include "pathtracer/scene/scene.hpp"

namespace tandem::pathtracer {

/// The luminance that arrives from all directions together (its integral over the sphere); 0 without an environment.
/// Throws Error for a map that is not a whole image.
double environment_luminance(const Scene& scene);

/// The alias table over the texels of the map, each with a probability proportional to its luminance, filtered as the
/// shader filters it, times its solid angle. One cell for a constant environment, none where nothing arrives. `density`
/// is that of the probability which the 32-bit thresholds really give, and is above 0 wherever the radiance is.
std::vector<GpuEnvironmentCell> environment_cells(const Scene& scene);

/// Sets the map's directions. Without a rotation its centre is at -z and its right half towards +x.
void set_environment_frame(RenderConstants& constants, const Environment& environment);

}  // namespace tandem::pathtracer
