#pragma once

#include <span>
#include <string>
#include <vector>

#include "pathtracer/scene/scene.hpp"

namespace tandem::pathtracer {

/// Relative luminance of linear RGB with the primaries of sRGB (ITU-R BT.709).
double luminance(glm::vec3 rgb);

/// A light before anything is known of the others.
struct Emitter {
  GpuLight light;
  double power = 0;  ///< luminous, estimated: by what a light is chosen
  double area = 0;   ///< of triangles and spheres
};

/// Half the diagonal of the scene's bounds, by which the power of lights without a place is estimated; 1 for a point.
double scene_radius(const Scene& scene);

/// The emissive triangles and spheres and the environment, in this order. What has no power is left out: degenerate
/// triangles, black textures. Throws Error for an environment that is no plain image.
std::vector<Emitter> scene_emitters(const Scene& scene);

/// Those among the lights without extent that have an intensity. Throws Error for numbers out of range.
/// @param scene_name for messages @param radius of the scene
std::vector<Emitter> punctual_emitters(std::span<const PunctualLight> lights, const std::string& scene_name,
                                       double radius);

/// The lights with their alias table (Vose 1991): each has a probability proportional to its power. Densities are those
/// of the probabilities that the 32-bit thresholds really give.
std::vector<GpuLight> light_table(std::span<const Emitter> emitters);

/// Of all lights of a scene. Empty when nothing emits.
std::vector<GpuLight> build_lights(const Scene& scene);

/// The probability of each entry of the table, summed over the ways to choose it.
std::vector<double> light_probabilities(const std::vector<GpuLight>& lights);

}  // namespace tandem::pathtracer
